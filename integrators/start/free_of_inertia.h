// A motion without inertia that the constraints leave free in the pose where a run begins: M x = 0 and G x = 0. Masses
// are positive, so that x turns bodies about axes about which they have no moment; one by itself where no constraint
// holds it in this pose, though some do in others (core/open_spins.h has those that none ever does), or several
// together, as point masses that are fixed to one another on the axis of a hinge. Accelerations along x are not
// determined there. To a linear solver it may look held by the rounding of an orientation.
#pragma once

#include <memory>
#include <span>

#include "core/body_state.h"
#include "core/model.h"
#include "core/status.h"

namespace poinsot {

Status refuse_motion_free_of_inertia(const std::shared_ptr<const Model>& model, std::span<const BodyState> states);

}  // namespace poinsot
