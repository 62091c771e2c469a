// Error control by the method that suits the motion: dop853 while it is not stiff, radau5 from where it is.
//
// Whether it is, is measured. The steps of dop853 themselves tell, from the first on and for no evaluation, where they
// are held by stability (stepping/stiffness.h). At tight tolerances an explicit method's steps are short for the sake
// of accuracy long before that, as its error has terms of the fast part in it that is not there; so radau5 is also
// tried, for a few steps that count, as soon as the fast part is seen to have decayed (a spring with a damper: after
// some 15 steps), after 300 steps, and after four times as many whenever it did not prove better: it goes on where its
// steps are four times as long, which is more than one of them costs (0.6 to 4.7 times one of dop853 over models/).
// Below rtol 1e-12 there is no trial: steps are short for rounding's sake there. Both have the same tolerances and
// output times. A motion that is not stiff any more costs radau5 steps, not accuracy; where its steps fail, as beside a
// singular position, dop853 goes on. Any formulation. Settings: rtol, atol, every, end.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_auto_integrator();

}  // namespace poinsot
