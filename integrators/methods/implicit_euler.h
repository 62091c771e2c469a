// Index-3 implicit Euler, the paper's method: integration formulas (32), discretized equations of motion (33) and (34),
// Newton's method (35) to (38), stopping test (46). What is printed wrong there: formulations/README.md.
//
// Velocity rows (Ψ v − f)/h = 0 take the place of theirs of Φ/h². First order in positions, velocities, accelerations
// and multipliers; strongly dissipative.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_implicit_euler();

}  // namespace poinsot
