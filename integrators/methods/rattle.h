// RATTLE: second order, symmetric, in rA and rp symplectic, constraints kept at position and velocity level; for long
// runs.
//
//   M (u − v_n) 2/h + c(q_n, u) + e + G(q_n)ᵀλ⁺ = Q(q_n, u, t_n),  q_{n+1} = q_n ⊞ h u,  Φ(q_{n+1}, t_{n+1}) = 0
//   M (v_{n+1} − u) 2/h + c(q_{n+1}, u) − e + G(q_{n+1})ᵀλ⁻ = Q(q_{n+1}, u, t_{n+1}),  G v_{n+1} = ν(t_{n+1})
//
// with c the velocity terms of the inertia. These are the discrete Euler–Lagrange equations of the trapezoidal
// Lagrangian ½ (L(q_n, u) + L(q_{n+1}, u)), with the momentum M v:
//   rA: the variational Lie-group integrator (RATTLie, Hante & Arnold 2021): momenta T(∓hu)⁻ᵀ M u, of which c is the
//       odd part of T⁻ᵀ and e = (2/h) (½ T(hu)⁻ᵀ + ½ T(−hu)⁻ᵀ − I) M u the even one. A free body keeps its angular
//       momentum exactly.
//   rp: exactly the general RATTLE for H(q, p), because ω̄ = 2 G(p_n) u = 2 G(p_{n+1}) u; e = 0.
//   reps: the same equations with e = 0 are symmetric and of second order, but symplectic only where the inertia does
//       not depend on the angles (planar motion); in spatial motion, with changes of chart, energy drifts.
// Applied forces, also velocity-dependent and dissipative ones, stand in both halves, so that the step is symmetric
// with them. Velocity rows: ½ (Ψ_n + Ψ_{n+1}) u = ½ (f_n + f_{n+1}).
//
// Orders: positions, velocities, accelerations and multipliers 2, from the first step on: a and λ given out solve
// M a + Gᵀλ = Q, G a = γ at the accepted (q, v).
//
// The first half is solved with the matrix [M Gᵀ; G 0] of its beginning, which the second half of the step before has
// factored: one factorization a step; Broyden's updates bring in what it lacks.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_rattle();

}  // namespace poinsot
