// Whether a motion starts where its drivers mean it to: their rows hold half a turn off as well.
//
// A driven angle f is the row u·v = 0, u = A_i (−sin f a + cos f b), v = A_j a_j: u′·v = (cos f a + sin f b)·v < 0
// is the turned solution. A driven length enters by its square and must not be negative.
#pragma once

#include <span>

#include "formulations/problem.h"

namespace poinsot {

// The problem stands at the consistent start, t = 0, with the accelerations a.
Status check_driven_pose(const Problem& problem, std::span<const double> a);

}  // namespace poinsot
