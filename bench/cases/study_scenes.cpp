#include "bench/cases/study_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <utility>

#include "bench/cases/random_mechanism.h"
#include "bench/study/cache.h"
#include "core/input_error.h"
#include "core/projected.h"
#include "core/scene_generator.h"
#include "core/scene_writer.h"

namespace poinsot::cases {
namespace fs = std::filesystem;
namespace {

void add_scene(Study& study, const JsonValue& item, std::string name, Scene scene) {
  for (const StudyScene& other : study.scenes)
    if (other.name == name) item.fail(fmt::format("there is a scene '{}' already, expected another name", name));
  const std::uint64_t hash = study::content_hash(scene.source.empty() ? to_json(scene) : scene.source);
  for (const std::string& notice : scene.notices) study.notices.push_back(fmt::format("scene '{}': {}", name, notice));
  study.scenes.push_back({std::move(name), std::move(scene), {}, hash});
}

// {"random_mechanisms": n, "bodies": [from, to]}: by turns open and closed, of evenly growing size.
void add_random_mechanisms(Study& study, const JsonValue& item, std::uint64_t seed) {
  item.keys("random mechanisms", {"random_mechanisms", "bodies"});
  constexpr std::int64_t kMost = 10'000;
  const JsonValue count = item.required("random_mechanisms"), bodies = item.required("bodies");
  const std::int64_t n = read_count(count, 1, kMost);
  constexpr std::string_view kEnds = "an array of 2 whole numbers, from and to, the first one not greater";
  if (bodies.size(kEnds) != 2) bodies.expected(kEnds);
  const JsonValue from = bodies.at(0), to = bodies.at(1);
  const std::int64_t a = read_count(from, 1, kMost), b = read_count(to, 1, kMost);
  if (a > b) bodies.expected(kEnds);
  for (std::int64_t k = 0; k < n; ++k) {
    const std::int64_t size = n > 1 ? a + (b - a) * k / (n - 1) : a;
    const bool closed = k % 2 == 1 && size > 1;
    add_scene(study, item, fmt::format("{}_{}", closed ? "closed" : "open", k + 1),
              random_mechanism(static_cast<int>(size), closed, seed + static_cast<std::uint64_t>(k)));
  }
}

void add_made(Study& study, const JsonValue& item) {
  item.keys("a made scene", {"make", "bodies"});
  const JsonValue structure = item.required("make"), bodies = item.required("bodies");
  const std::string allowed =
      fmt::format("one of {}", fmt::join(projected(scene_generators(), &SceneGenerator::name), ", "));
  const SceneGenerator* generator = find_scene_generator(structure.string(allowed));
  if (!generator) structure.expected(allowed);
  constexpr std::int64_t kMost = 10'000'000;
  const std::int64_t n = read_count(bodies, 1, kMost);
  add_scene(study, item, fmt::format("{}_{}", generator->name, n), generator->make(static_cast<int>(n)));
}

}  // namespace

void read_scenes(Study& study, const JsonValue& root, std::uint64_t seed, const SceneOf& scene_of) {
  const JsonValue list = root.required("scenes");
  for (const JsonValue& item : items(list, "an array of scenes, at least one", 1)) {
    if (item.is_string()) {
      const std::string& file = item.string();
      const auto scene = [&] {
        try {
          return scene_of(file);
        } catch (const InputError& error) {
          item.fail(error.what());
        }
      };
      add_scene(study, item, fs::path(file).stem().string(), scene());
    } else if (item.optional("random_mechanisms")) {
      add_random_mechanisms(study, item, seed);
    } else if (item.optional("make")) {
      add_made(study, item);
    } else {
      item.expected("the name of a scene file, {\"make\": ...} or {\"random_mechanisms\": ...}");
    }
  }
}

}  // namespace poinsot::cases
