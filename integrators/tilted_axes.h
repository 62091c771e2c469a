// Angles about axes that tilt, of drivers and torsion springs whose directions the scene does not name.
#pragma once

#include <span>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/integrator.h"

namespace poinsot {

// A sentence for the first of them whose axis, as body j carried it at the initial pose, is no longer that of body i.
void tell_tilted_axes(const Model& model, std::span<const BodyState> bodies, const Tell& tell);

}  // namespace poinsot
