// The trajectory as CSV: t, then for each body in scene order r, Euler parameters (e0 ≥ 0), ṙ, ω̄, r̈, ω̄̇.
//
// r, ṙ and r̈ are those of the centre of mass, global; ω̄ and its derivative are in the scene's body frame. 17
// significant digits: what is read back is what was computed.
#pragma once

#include <span>
#include <vector>

#include "bench/study/output_file.h"
#include "core/scene.h"
#include "integrators/integrator.h"

namespace poinsot::app {

class TrajectoryWriter {
 public:
  TrajectoryWriter(const std::filesystem::path& file, const Scene& scene);  // throws InputError

  void write(const Sample& sample);
  void write(double t, std::span<const BodyState> bodies);
  study::OutputFile& file() { return file_; }

 private:
  void write(const Vector3& x);

  study::OutputFile file_;
  std::vector<BodyState> states_;
};

}  // namespace poinsot::app
