// What is known of each mechanism of a scene (core/mechanisms.h) before a run.
#pragma once

#include <span>
#include <vector>

#include "formulations/problem.h"

namespace poinsot {

// Degrees of freedom, by what the problem's rows leave.
std::vector<int> freedoms(const Problem& problem, std::span<const int> mechanism);

// J: kinetic energy that rounding of positions can make from step to step of length h.
std::vector<double> kinetic_noise(const Model& model, std::span<const int> mechanism, double h);

}  // namespace poinsot
