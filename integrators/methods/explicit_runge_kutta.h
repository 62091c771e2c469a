// Integrator on an embedded explicit Runge–Kutta pair: error control, samples by dense output, an exact end.
//
// Non-stiff scenes; any formulation. Settings: rtol, atol, every, end; `step` plays no part. See explicit_stepper.h for
// a step, step_control.h for how long it is.
#pragma once

#include <memory>

#include "integrators/integrator.h"
#include "integrators/stepping/runge_kutta_pair.h"

namespace poinsot {

std::unique_ptr<Integrator> make_explicit_runge_kutta(const RungeKuttaPair& pair);

}  // namespace poinsot
