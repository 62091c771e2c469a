#include "app/trajectory_writer.h"

#include <fmt/format.h>

#include "bench/study/trajectory_columns.h"
#include "core/so3.h"

namespace poinsot::app {
using namespace study;

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& file, const Scene& scene)
    : file_(file), states_(scene.bodies.size()) {
  file_.write("t");
  for (const Body& body : scene.bodies)
    for (const std::string_view column : kTrajectoryColumns) file_.write_field(fmt::format("{}.{}", body.name, column));
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
