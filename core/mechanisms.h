// The mechanisms of a scene: bodies that constraints, joints, drivers, or forces between them hold together. The ground
// holds nothing together: what stands on it in two places moves as if it stood alone.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot {

// By body, the number of its mechanism, from 0 in the order of their first bodies.
std::vector<int> mechanisms(const Model& model);

std::size_t mechanism_count(std::span<const int> mechanism);

// " of the mechanism of body 'crank'": how messages speak of one of several by its first body; empty where there is
// one.
std::string of_mechanism(const Model& model, std::span<const int> mechanism, int number);

}  // namespace poinsot
