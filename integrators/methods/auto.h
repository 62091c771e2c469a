// Error control by the method that suits the motion: dop853 while it is not stiff, radau5 from where it is.
//
// Whether it is, is measured: by the steps of dop853 themselves, from the first on (stepping/stiffness.h), which costs
// no evaluation. radau5 goes on from the state reached, with the same tolerances and output times, and keeps on: a
// motion that is not stiff any more costs it steps, not accuracy. Any formulation. Settings: rtol, atol, every, end.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_auto_integrator();

}  // namespace poinsot
