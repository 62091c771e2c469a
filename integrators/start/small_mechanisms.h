// Mechanisms so small that the absolute tolerance of error control, a length in metres, is of account beside them.
//
// Positions that follow from turns keep their accuracy at any size, since turns are measured in radians: told are
// mechanisms whose bodies can move without turning, as points on springs or on rods.
#pragma once

#include <functional>
#include <string>

#include "core/model.h"

namespace poinsot {

// A sentence about the one that is the smallest beside atol, with the atol that serves it; nothing where none is. Those
// that springs without a law or distances give no length are let be, and those of more than 200 bodies.
void tell_small_mechanisms(const Model& model, double rtol, double atol,
                           const std::function<void(const std::string&)>& tell);

}  // namespace poinsot
