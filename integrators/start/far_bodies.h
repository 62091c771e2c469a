// Mechanisms so far from the origin that the rounding of positions is of account beside their size.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot {

// How long a rod of a body's mass and inertia would be, m.
inline double rod_length(const Body& body) {
  return std::sqrt(6 * body.inertia.trace() / body.mass);
}

// A sentence where rounding of its position moves a constrained body by more than 1e-8 of its size: the longer one of
// its longest arm and of a rod of its mass and inertia. Of the body it moves most.
void tell_far_bodies(const Model& model, std::vector<std::string>& notices);

}  // namespace poinsot
