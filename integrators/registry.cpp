#include <algorithm>
#include <iterator>

#include "integrators/dop853.h"
#include "integrators/dopri5.h"
#include "integrators/implicit_euler.h"
#include "integrators/integrator.h"
#include "integrators/kinematics.h"

namespace poinsot {
namespace {

constexpr IntegratorEntry kIntegrators[] = {
    {"implicit_euler", "the paper's: index 3, first order, fixed step; any formulation, any linear solver",
     Analysis::dynamics, make_implicit_euler},
    {"dopri5", "explicit Runge-Kutta pair of order 5(4) with error control and projection; non-stiff; any formulation",
     Analysis::dynamics, make_dopri5},
    {"dop853",
     "explicit Runge-Kutta pair of order 8(5,3) with error control and projection; non-stiff; any formulation",
     Analysis::dynamics, make_dop853},
    {"kinematics", "of a mechanism without degrees of freedom: Newton for the position, linear solves for the rates",
     Analysis::kinematics, make_kinematics},
};

}  // namespace

std::span<const IntegratorEntry> integrators() {
  return kIntegrators;
}

const IntegratorEntry* find_integrator(std::string_view name) {
  const auto at = std::find_if(std::begin(kIntegrators), std::end(kIntegrators),
                               [&](const IntegratorEntry& entry) { return entry.name == name; });
  return at == std::end(kIntegrators) ? nullptr : at;
}

}  // namespace poinsot
