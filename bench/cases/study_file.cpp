#include "bench/cases/study_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/cases/study_scenes.h"
#include "bench/cases/study_settings.h"
#include "bench/study/cache.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/places.h"
#include "core/projected.h"
#include "integrators/settings_reader.h"

namespace poinsot::cases {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMostCases = 1'000'000'000;

void require_parameter(const Study& study, const JsonValue& place, const std::string& name) {
  for (const StudyScene& one : study.scenes) {
    const auto known = projected(one.scene.parameters, &Parameter::name);
    if (std::ranges::find(known, name) == known.end())
      place.fail(fmt::format("scene '{}' has no parameter '{}'; it has {}", one.name, name,
                             known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
  }
  const std::vector<std::string> varied = parameter_names(study);
  if (std::ranges::find(varied, name) != varied.end())
    place.fail(fmt::format("'{}' varies already, expected another parameter", name));
}

void vary_parameter(Study& study, const JsonValue& item) {
  item.keys("a parameter that varies", {"parameter", "values", "from", "to", "count", "spacing"});
  const JsonValue name = item.required("parameter");
  require_parameter(study, name, name.string("the name of a parameter"));
  ParameterAxis axis;
  axis.names = {name.string()};
  if (const auto list = item.optional("values")) {
    for (const JsonValue& value : items(*list, "an array of numbers, at least one", 1))
      axis.values.push_back(value.number());
  } else {
    axis.values = read_range(item);
  }
  study.axes.push_back(std::move(axis));
}

void read_variation(Study& study, const JsonValue& root, std::uint64_t seed) {
  const auto list = root.optional("vary");
  if (!list) return;
  std::uint32_t stream = 1;  // 0 is that of random mechanisms
  for (const JsonValue& item : items(*list, "an array of what varies")) {
    if (item.optional("setting")) {
      vary_setting(study, item);
    } else if (const auto samples = item.optional("samples")) {
      if (!root.optional("seed")) samples->fail("the study has no \"seed\", expected one where samples are drawn");
      ParameterAxis axis = read_samples(item, seed, stream);
      stream += static_cast<std::uint32_t>(axis.names.size());
      const JsonValue parameters = item.required("parameters");
      for (const std::string& name : axis.names) {
        const JsonValue place = parameters.required(name);
        require_parameter(study, place, name);
      }
      study.axes.push_back(std::move(axis));
    } else if (item.optional("parameter")) {
      vary_parameter(study, item);
    } else {
      item.expected("an object with \"parameter\", \"setting\" or \"samples\"");
    }
  }
}

std::vector<std::string> varied_columns(const Study& study) {
  std::vector<std::string> names = parameter_names(study);
  names.insert(names.end(), study.settings_varied.begin(), study.settings_varied.end());
  return names;
}

void require_distinct_columns(const Study& study, const JsonValue& root) {
  std::set<std::string> seen{"case", "scene", "bodies", "status", "message"};
  for (const std::vector<std::string>& names : {varied_columns(study), study.kept.columns()})
    for (const std::string& name : names)
      if (!seen.insert(name).second)
        root.fail(fmt::format("the table would have two columns '{}'; expected other names", name));
}

// Columns of the quantities kept, in each scene.
void find_columns(Study& study, const JsonValue& root) {
  for (StudyScene& one : study.scenes) {
    Model model;
    try {
      model = compile(one.scene);
    } catch (const InputError& error) {
      root.fail(fmt::format("scene '{}': {}", one.name, error.what()));
    }
    for (const Quantity& quantity : study.kept.quantities)
      one.columns.push_back(require_column(root, quantity, model, one.name));
  }
}

Study parse_document(const JsonDocument& document, std::string_view file, const SceneOf& scene_of) {
  const JsonValue root = document.root();
  root.keys("a study", {"$schema", "study", "name", "about", "seed", "scenes", "settings", "vary", "repetitions",
                        "keep", "pictures"});
  const JsonValue version = root.required("study");
  constexpr std::string_view kVersion = "1, the version of the format";
  if (version.is_string() || version.number(kVersion) != 1) version.expected(kVersion);
  if (const auto schema = root.optional("$schema")) (void)schema->string();  // for editors

  Study study;
  if (const auto name = root.optional("name")) study.name = name->string();
  if (const auto about = root.optional("about")) study.about = about->string();
  std::uint64_t seed = 0;
  constexpr std::int64_t kMostSeed = 1'000'000'000'000'000;
  if (const auto given = root.optional("seed")) seed = static_cast<std::uint64_t>(read_count(*given, 0, kMostSeed));
  read_scenes(study, root, seed, scene_of);
  study.settings.emplace_back();
  if (const auto settings = root.optional("settings")) read_settings(*settings, study.settings.front().settings);
  read_variation(study, root, seed);
  constexpr std::int64_t kMostRepetitions = 1000;
  if (const auto repetitions = root.optional("repetitions"))
    study.repetitions = static_cast<int>(read_count(*repetitions, 1, kMostRepetitions));
  if (study.size() > kMostCases) root.fail(fmt::format("found more than {} cases", kMostCases));
  study.kept = read_kept(root, study.timed());
  find_columns(study, root);
  settle_settings(study, root);
  for (const std::string& sentence : ignored_settings(study, root))
    study.notices.push_back(fmt::format("{}: {}", file, sentence));
  for (const SettingsChoice& choice : study.settings) require_output_times(root, study.kept, choice.settings);
  require_distinct_columns(study, root);
  const std::vector<std::string> varied = varied_columns(study);
  std::vector<std::string> columns = study.kept.columns();
  study.columns_hash =
      study::content_hash(fmt::format("{} {} {}", fmt::join(varied, ","), study.kept.text(), fmt::join(columns, ",")));
  columns.insert(columns.end(), varied.begin(), varied.end());
  columns.insert(columns.end(), {"case", "scene", "bodies"});
  study.pictures = read_pictures(root, columns, study.kept);
  return study;
}

Study parse(std::string_view text, std::string_view file, const SceneOf& scene_of) {
  Study study;
  with_lines_of_errors(text, [&] { study = parse_document(JsonDocument(text, file), file, scene_of); });
  return study;
}

}  // namespace

Study read_study(const fs::path& file) {
  const std::string text = read_text(file.string());
  nlohmann::json scenes = nlohmann::json::object();
  Study study = parse(text, shown_input(file.string()), [&](const std::string& name) {
    Scene scene = read_scene(file.parent_path() / name);
    scenes[name] = scene.source;
    return scene;
  });
  study.content = nlohmann::json{{"file", shown_input(file.string())}, {"study", text}, {"scenes", scenes}}.dump(2);
  return study;
}

Study parse_content(std::string_view content) {
  const nlohmann::json json = nlohmann::json::parse(content);
  Study study = parse(json["study"].get<std::string>(), json["file"].get<std::string>(), [&](const std::string& name) {
    return parse_scene(json["scenes"][name].get<std::string>(), name);
  });
  study.content = content;
  return study;
}

}  // namespace poinsot::cases
