// The trajectory as a table: t, then for each body in scene order r, Euler parameters (e0 ≥ 0), ṙ, ω̄, r̈, ω̄̇, or those
// of them that are chosen.
//
// r, ṙ and r̈ are those of the centre of mass, global; ω̄ and its derivative are in the scene's body frame.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/records/number_table.h"
#include "core/scene.h"
#include "integrators/integrator.h"

namespace poinsot::records {

// What a trajectory holds.
class TrajectoryContent {
 public:
  explicit TrajectoryContent(const Scene& scene);  // all there is
  // As --columns and --bodies give it, names with commas between; empty: all. Throws InputError.
  TrajectoryContent(const Scene& scene, const std::string& columns, const std::string& bodies);

  static std::string column_names();  // what --columns may hold

 private:
  friend class TrajectoryWriter;
  std::vector<bool> columns_;
  std::vector<std::size_t> bodies_;
};

class TrajectoryWriter {
 public:
  TrajectoryWriter(const std::filesystem::path& file, const Scene& scene, TrajectoryContent content);  // InputError

  const std::vector<std::string>& columns() const { return table_.columns(); }
  void write(const Sample& sample);
  void write(double t, std::span<const BodyState> bodies);
  study::OutputFile& file() { return table_.file(); }

 private:
  void write(const Vector3& x);

  TrajectoryContent content_;
  NumberTable table_;
  std::vector<BodyState> states_;
};

}  // namespace poinsot::records
