#include "bench/records/trajectory_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "bench/study/name_list.h"
#include "core/so3.h"

namespace poinsot::records {
namespace {

struct Quantity {
  const char* name;  // as --columns takes it
  std::vector<const char*> columns;
};
const std::array<Quantity, 6> kQuantities{{{"position", {"x", "y", "z"}},
                                           {"orientation", {"e0", "e1", "e2", "e3"}},
                                           {"velocity", {"vx", "vy", "vz"}},
                                           {"angular_velocity", {"wx", "wy", "wz"}},
                                           {"acceleration", {"ax", "ay", "az"}},
                                           {"angular_acceleration", {"alx", "aly", "alz"}}}};

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const Quantity& quantity : kQuantities) names.emplace_back(quantity.name);
  return names;
}

// Bodies are written in scene order, columns in that of the contract, however they are asked for.
std::vector<std::string> names_of(const Scene& scene, const std::vector<bool>& chosen,
                                  const std::vector<std::size_t>& bodies) {
  std::vector<std::string> names{"t"};
  for (const std::size_t b : bodies)
    for (std::size_t k = 0; k < kQuantities.size(); ++k)
      if (chosen[k])
        for (const char* column : kQuantities[k].columns)
          names.push_back(fmt::format("{}.{}", scene.bodies[b].name, column));
  return names;
}

}  // namespace

TrajectoryContent::TrajectoryContent(const Scene& scene) : columns_(kQuantities.size(), true) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) bodies_.push_back(b);
}

TrajectoryContent::TrajectoryContent(const Scene& scene, const std::string& columns, const std::string& bodies)
    : TrajectoryContent(scene) {
  if (!columns.empty()) {
    const std::vector<std::string> all = quantity_names(), chosen = study::names_in("--columns", columns, all);
    for (std::size_t k = 0; k < all.size(); ++k) columns_[k] = std::ranges::find(chosen, all[k]) != chosen.end();
  }
  if (bodies.empty()) return;
  std::vector<std::string> all;
  for (const Body& body : scene.bodies) all.push_back(body.name);
  const std::vector<std::string> chosen = study::names_in("--bodies", bodies, all);
  std::erase_if(bodies_, [&](std::size_t b) { return std::ranges::find(chosen, all[b]) == chosen.end(); });
}

std::string TrajectoryContent::column_names() {
  return fmt::format("{}", fmt::join(quantity_names(), ", "));
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& file, const Scene& scene, TrajectoryContent content)
    : content_(std::move(content)),
      table_(file, names_of(scene, content_.columns_, content_.bodies_)),
      states_(content_.bodies_.back() + 1) {}

void TrajectoryWriter::write(const Sample& sample) {
  sample.problem.to_bodies(sample.a, states_);
  write(sample.t, states_);
}

void TrajectoryWriter::write(double t, std::span<const BodyState> bodies) {
  const std::vector<bool>& chosen = content_.columns_;
  table_.write(t);
  for (const std::size_t b : content_.bodies_) {
    const BodyState& body = bodies[b];
    if (chosen[0]) write(body.r);
    if (chosen[1])
      for (const double e : parameters_from_rotation<double>(body.A)) table_.write(e);
    if (chosen[2]) write(body.rd);
    if (chosen[3]) write(body.w);
    if (chosen[4]) write(body.rdd);
    if (chosen[5]) write(body.wd);
  }
}

void TrajectoryWriter::write(const Vector3& x) {
  for (const double component : x) table_.write(component);
}

}  // namespace poinsot::records
