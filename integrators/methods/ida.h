// SUNDIALS IDA on the stabilized index-2 form in Euler parameters: the reference for speed and accuracy.
//
// Backward differentiation formulas of variable order 1 to 5 and variable step (Hindmarsh et al., "SUNDIALS", ACM TOMS
// 31 (2005)); system and matrix in stabilized_index2.h, linear systems by the run's own linear solver. The error of
// positions and velocities is controlled, in the norm of step_control.h; multipliers follow from them and take no part
// in the norm. Samples come from IDA's dense output, are moved onto the constraints and given their own accelerations
// and multipliers (consistent_point.h). Settings: rtol, atol, every, end; `step` plays no part.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_ida();

}  // namespace poinsot
