// Which of a scene's mechanisms (core/mechanisms.h) keep their energy, kinetic and potential: nothing moves them from
// outside and nothing dissipates. Their rows do not change with time, and all that acts on them is gravity, and springs
// whose force follows from their length or angle alone.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

// By number of the mechanism; `mechanism` by body, as mechanisms() gives it.
std::vector<bool> conserving_mechanisms(const Model& model, std::span<const int> mechanism);

// All of them.
bool conserves_energy(const Model& model);

}  // namespace poinsot
