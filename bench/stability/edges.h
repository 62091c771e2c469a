// The families, by what they are about. Adding one: a function here, and its line in families.cpp.
#pragma once

#include "bench/stability/family.h"

namespace poinsot::stability {

// Rotation.
Family euler_angles();
Family spin();
Family top();
// Drivers and loops.
Family dp1_driver();
Family flat_redundant();
Family flat_planar();
Family misalignment();
// Numbers of very different size.
Family far_away();
Family mass_ratio();
Family skew_chain();
Family stiffness();
Family rounding_positions();
Family rounding_accelerations();
Family rounding_reactions();
// Starts, forces, long runs.
Family inconsistent();
Family pulse();
Family smooth_pulse();
Family kinks();
Family drift();

}  // namespace poinsot::stability
