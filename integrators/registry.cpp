#include "formulations/registry.h"

#include <numbers>

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

// Rotation about an axis that stays is exact in rA and reps, whatever its angle: only half a turn makes no sense there.
constexpr double kHalfTurn = std::numbers::pi;
constexpr Rotations kOfImplicitEuler{{0.075, kHalfTurn}, {0.01, 0.56}, {0.042, kHalfTurn}};
constexpr Rotations kOfHalfImplicit{{0.075, kHalfTurn}, {0.024, 1.0}, {0.0075, kHalfTurn}};
constexpr Rotations kOfRattle{{1.8, kHalfTurn}, {1.0, 1.0}, {0.24, kHalfTurn}};
constexpr Rotations kOfAlpha{{1.0, kHalfTurn}, {1.0, 2.4}, {0.1, kHalfTurn}};
constexpr Rotations kOfAlphaI2{{1.0, kHalfTurn}, {1.3, 1.8}, {0.1, kHalfTurn}};

constexpr IntegratorEntry kIntegrators[] = {
    {"auto",
     "error control: dop853 while the motion is not stiff, radau5 from where it is, as measured; says which",
     Analysis::dynamics,
     0,
     make_auto_integrator,
     true,
     false,
     {},
     {},
     true},
    {"implicit_euler",
     "the paper's: index 3, first order, fixed step; any formulation, any linear solver",
     Analysis::dynamics,
     1,
     make_implicit_euler,
     false,
     false,
     {},
     kOfImplicitEuler},
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
     Analysis::dynamics,
     1,
     make_half_implicit,
     false,
     false,
     {},
     kOfHalfImplicit},
    {"rattle",
     "second order, fixed step, constraints kept in positions and velocities; symplectic in rA and rp: for long runs",
     Analysis::dynamics,
     2,
     make_rattle,
     false,
     false,
     {},
     kOfRattle},
    {"generalized_alpha",
     "on the Lie group, index 3: second order, fixed step, damping by spectral_radius; any formulation",
     Analysis::dynamics, 2, make_generalized_alpha, false, false, kOfGeneralizedAlpha, kOfAlpha},
    {"generalized_alpha_i2",
     "the same in stabilized index 2: velocities are kept on the constraints, too; any formulation", Analysis::dynamics,
     2, make_generalized_alpha_i2, false, false, kOfGeneralizedAlpha, kOfAlphaI2},
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
