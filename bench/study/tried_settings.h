// Other settings for a run that stopped, tried on its scene: what does not help is not offered.
//
// One after the other, until the run gets on with one: from its start to a tenth beyond where it stopped and, with
// error control, as it was asked for to the end. Of those that stop later on, the one that leads farthest.
//   fixed steps    the exact Jacobian; the step that is known to serve, or a quarter of the step; of a method that did
//                  not converge five times the iterations; of a row that was lost a thousandth of the tolerance;
//                  integrator auto; formulation rA
//   kinematics     the same but for the last two; in a singular position dop853
//   error control  a hundredth of the tolerances, a hundred times them, other integrators, formulation rA
//   linear solver  auto, where the one that was chosen refuses the system
// What would take more than some seconds is not tried, and the stop says so.
#pragma once

#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::study {

// Puts what came of it in the place of what the status says of other settings; does nothing where it says nothing of
// them.
void try_settings(const Scene& scene, const Settings& settings, Outcome& outcome);

}  // namespace poinsot::study
