// The pair of Dormand and Prince of order 5(4), seven stages of which the last is the next step's first.
//
// J. R. Dormand, P. J. Prince, "A family of embedded Runge–Kutta formulae", J. Comp. Appl. Math. 6 (1980); dense output
// of fourth order by Shampine, as in Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", sec. II.5
// and II.6.
#pragma once

#include <memory>

#include "integrators/integrator.h"
#include "integrators/stepping/runge_kutta_pair.h"

namespace poinsot {

const RungeKuttaPair& dopri5_pair();
std::unique_ptr<Integrator> make_dopri5();

}  // namespace poinsot
