// The pair of Dormand and Prince of order 8 with Hairer's error estimate of orders 5 and 3: twelve stages.
//
// E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", second edition, sec. II.5 (method,
// error estimate) and II.6 (dense output of seventh order with three more stages, computed only where a sample needs
// them).
#pragma once

#include <memory>

#include "integrators/integrator.h"
#include "integrators/stepping/runge_kutta_pair.h"

namespace poinsot {

const RungeKuttaPair& dop853_pair();
std::unique_ptr<Integrator> make_dop853();

}  // namespace poinsot
