// Index-3 implicit Euler, the paper's method (sec. "Dynamics Analysis", eqs. discretizedEOM*, corrections, errata 13,
// 14).
//
//   v = v_n + h a,  q = q_n ⊞ h v   (rA: A = A_n exp(h ω̃̄);  rp, reps: x = x_n + h ẋ)
//   M a + Gᵀλ − Q(q, v, t) = 0,   Φ(q, t)/h² = 0,   velocity rows (Ψv − f)/h = 0
//
// solved by Newton's method for (a, λ); it stops when the 2-norm of the correction is below the tolerance. First order
// in positions, velocities, accelerations and multipliers; strongly dissipative.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_implicit_euler();

}  // namespace poinsot
