// Reads back what `poinsot run --out` has written: a trajectory of a scene as CSV (bench/view/trajectory_columns.h).
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "core/body_state.h"
#include "core/scene.h"

namespace poinsot::view {

// Calls `row` for every row, in the order of the file. Throws InputError where the file is not a trajectory of this
// scene: another column than expected, a field that is no number, times that do not grow.
void read_trajectory(const std::filesystem::path& file, const Scene& scene,
                     const std::function<void(double t, std::span<const BodyState> bodies)>& row);

// What the run record beside a trajectory, where there is one, says of how it was computed. Both are empty where that
// is as one would think.
struct RecordedRun {
  std::string incomplete;  // why it ends before its time
  std::string otherwise;   // "computed with l = 2, not 1": what was another one than in this scene
};
RecordedRun recorded_run(const std::filesystem::path& file, const Scene& scene);

}  // namespace poinsot::view
