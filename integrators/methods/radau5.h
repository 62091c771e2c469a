// Radau IIA of order 5, three stages, with error control: for stiff scenes (springs and dampers); any formulation.
//
// Settings: rtol, atol, every, end; `step` plays no part. See radau_stepper.h for a step, step_control.h for how long
// it is.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_radau5();

}  // namespace poinsot
