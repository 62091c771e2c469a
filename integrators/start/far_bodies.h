// Bodies and joints that lie too far away: mechanisms so far from the origin that the rounding of positions is of
// account beside their size, and joints given by a global point far from the bodies they join, as where "7.0" was
// written for "0.70".
#pragma once

#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot {

// A sentence where rounding of its position moves a constrained body by more of its size than rank allows for
// (row_space.h): the longer one of its longest arm and of a rod of its mass and inertia. Of the body it moves most.
void tell_far_bodies(const Model& model, std::vector<std::string>& notices);

// A sentence for every joint whose point is further from its bodies' centres of mass than twice the extent of the
// mechanism without it: of the bodies' centres, and of the arms of other joints. Where there is nothing else, of the
// body itself: of its distance from the origin, and of a rod of its inertia.
void tell_far_joints(const Model& model, std::vector<std::string>& notices);

}  // namespace poinsot
