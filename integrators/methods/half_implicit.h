// Half-implicit Euler with the constraints at the new position: the scheme of the follow-up study (Fang, Kissel, Zhang
// & Negrut 2022, "On the use of half-implicit numerical integration in multibody dynamics").
//
//   M(q_n) a + G(q_n)ᵀλ = Q(q_n, v_n, t_n),  v_{n+1} = v_n + h a,  q_{n+1} = q_n ⊞ h v_{n+1}
//   Φ(q_{n+1}, t_{n+1})/h² = 0,  velocity rows (Ψ v_{n+1} − f)/h = 0 at q_{n+1}
//
// Only the constraints are nonlinear in (a, λ): the matrix [M Gᵀ; G 0] of the old position is factored once a step.
// First order in positions, velocities, accelerations and multipliers; no damping, so steps are bounded by the stiffest
// spring and damper. It is symplectic Euler where M is constant and Q does not depend on v: in plane motion in rA and
// reps. In rp, whose M depends on p, and in space, where Q holds the gyroscopic terms, energy drifts. In the first step
// a and λ carry an error of order 1, as in every index-3 Euler scheme: there (v_1 − v_0)/h compares a velocity of the
// scheme, h/2 off normal to the constraints, with one that is right. Given out are others (stepping/index1_output.h).
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_half_implicit();

}  // namespace poinsot
