// What becomes of the energy, kinetic and potential, of a scene's mechanisms (core/mechanisms.h).
//
// Where rows do not change with time and all that acts is gravity, forces that stay as they are in space, whose
// potential is counted, and springs whose force follows from their length or angle alone, it is kept. Linear dampers
// and drags beside these take of it, and never give.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

enum class EnergyFate { kept, taken, unknown };

// By number of the mechanism; `mechanism` by body, as mechanisms() gives it.
std::vector<EnergyFate> energy_fates(const Model& model, std::span<const int> mechanism);

// Of all of them, without a potential of forces.
bool conserves_energy(const Model& model);

}  // namespace poinsot
