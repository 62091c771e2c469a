// Reads back what `poinsot run --out` has written: a trajectory of a scene as CSV (bench/view/trajectory_columns.h).
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "core/body_state.h"
#include "core/scene.h"

namespace poinsot::view {

// Calls `row` for every row, in the order of the file. Throws InputError where the file is not a trajectory of this
// scene: another column than expected, a field that is no number, times that do not grow.
void read_trajectory(const std::filesystem::path& file, const Scene& scene,
                     const std::function<void(double t, std::span<const BodyState> bodies)>& row);

}  // namespace poinsot::view
