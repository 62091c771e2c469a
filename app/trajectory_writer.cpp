#include "app/trajectory_writer.h"

#include <fmt/format.h>

#include <array>

#include "core/so3.h"

namespace poinsot::app {
using namespace study;
namespace {

constexpr std::array kColumns{"x",  "y",  "z",  "e0", "e1", "e2", "e3",  "vx",  "vy", "vz",
                              "wx", "wy", "wz", "ax", "ay", "az", "alx", "aly", "alz"};

}  // namespace

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& file, const Scene& scene)
    : file_(file), states_(scene.bodies.size()) {
  file_.write("t");
  for (const Body& body : scene.bodies)
    for (const char* column : kColumns) file_.write_field(fmt::format("{}.{}", body.name, column));
  file_.write("\n");
}

void TrajectoryWriter::write(const Sample& sample) {
  sample.problem.to_bodies(sample.a, states_);
  write(sample.t, states_);
}

void TrajectoryWriter::write(double t, std::span<const BodyState> bodies) {
  file_.write(t);
  for (const BodyState& body : bodies) {
    write(body.r);
    for (const double e : parameters_from_rotation<double>(body.A)) {
      file_.write(",");
      file_.write(e);
    }
    write(body.rd);
    write(body.w);
    write(body.rdd);
    write(body.wd);
  }
  file_.write("\n");
}

void TrajectoryWriter::write(const Vector3& x) {
  for (const double component : x) {
    file_.write(",");
    file_.write(component);
  }
}

}  // namespace poinsot::app
