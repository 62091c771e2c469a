// A body without moment of inertia about an axis about which no constraint holds it in the pose where a run begins,
// though some do in others (core/open_spins.h has those that none ever does): its angular acceleration is not
// determined there. To a linear solver it may look held by the rounding of an orientation.
#pragma once

#include <memory>
#include <span>

#include "core/body_state.h"
#include "core/model.h"
#include "core/status.h"

namespace poinsot {

Status refuse_momentary_spin(const std::shared_ptr<const Model>& model, std::span<const BodyState> states);

}  // namespace poinsot
