#include "formulations/registry.h"

#include "integrators/integrator.h"
#include "integrators/methods/auto.h"
#include "integrators/methods/dop853.h"
#include "integrators/methods/dopri5.h"
#include "integrators/methods/generalized_alpha.h"
#include "integrators/methods/half_implicit.h"
#include "integrators/methods/ida.h"
#include "integrators/methods/implicit_euler.h"
#include "integrators/methods/kinematics.h"
#include "integrators/methods/radau5.h"
#include "integrators/methods/rattle.h"

namespace poinsot {
namespace {

constexpr std::span<const MethodParameter> kOfGeneralizedAlpha(&kSpectralRadius, 1);

constexpr IntegratorEntry kIntegrators[] = {
    {"auto",
     "error control: dop853 while the motion is not stiff, radau5 from where it is, as measured; says which",
     Analysis::dynamics,
     0,
     make_auto_integrator,
     true,
     false,
     {},
     true},
    {"implicit_euler", "the paper's: index 3, first order, fixed step; any formulation, any linear solver",
     Analysis::dynamics, 1, make_implicit_euler},
    {"dopri5", "explicit Runge-Kutta pair of order 5(4) with error control and projection; non-stiff; any formulation",
     Analysis::dynamics, 5, make_dopri5, true},
    {"dop853",
     "explicit Runge-Kutta pair of order 8(5,3) with error control and projection; non-stiff; any formulation",
     Analysis::dynamics, 8, make_dop853, true},
    {"radau5", "three-stage Radau IIA of order 5 with error control and projection; for stiff scenes; any formulation",
     Analysis::dynamics, 5, make_radau5, true},
    {"ida", "SUNDIALS IDA: formulas of order 1 to 5 on the stabilized index-2 form, with error control; a reference",
     Analysis::dynamics, 0, make_ida, true, true},
    {"half_implicit",
     "half-implicit Euler with the constraints at the new position: first order, fixed step; symplectic in plane "
     "motion",
     Analysis::dynamics, 1, make_half_implicit},
    {"rattle",
     "second order, fixed step, constraints kept in positions and velocities; symplectic in rA and rp: for long runs",
     Analysis::dynamics, 2, make_rattle},
    {"generalized_alpha",
     "on the Lie group, index 3: second order, fixed step, damping by spectral_radius; any formulation",
     Analysis::dynamics, 2, make_generalized_alpha, false, false, kOfGeneralizedAlpha},
    {"generalized_alpha_i2",
     "the same in stabilized index 2: velocities are kept on the constraints, too; any formulation", Analysis::dynamics,
     2, make_generalized_alpha_i2, false, false, kOfGeneralizedAlpha},
    {"kinematics", "of a mechanism without degrees of freedom: Newton for the position, linear solves for the rates",
     Analysis::kinematics, 0, make_kinematics},
};

}  // namespace

Registry<IntegratorEntry>& integrators() {
  static Registry<IntegratorEntry> table("integrator", kIntegrators);
  return table;
}

std::optional<Refusal> refusal_of(const IntegratorEntry& integrator, std::string_view formulation) {
  const FormulationEntry& entry = formulations().require(formulation);
  if (!integrator.needs_vector_space || entry.space == CoordinateSpace::vector_space) return {};
  std::string others;
  for (const FormulationEntry& other : formulations())
    if (other.space == CoordinateSpace::vector_space) others += (others.empty() ? "" : ", ") + std::string(other.name);
  return Refusal{entry.name,
                 "it needs a vector space of coordinates with their rates as velocities, which is " + others};
}

}  // namespace poinsot
