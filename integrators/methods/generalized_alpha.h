// The generalized-α method on the Lie group, index 3 and stabilized index 2 (Brüls, Cardona & Arnold 2012; Arnold,
// Brüls & Cardona 2015), fixed step.
//
//   q_{n+1} = q_n ⊞ h Δq,   h Δq = h v_n + h² (½ − β) a_n + h² β a_{n+1} (+ y)
//   v_{n+1} = v_n + h (1 − γ) a_n + h γ a_{n+1}
//   (1 − α_m) a_{n+1} + α_m a_n = (1 − α_f) v̇_{n+1} + α_f v̇_n
//   M v̇_{n+1} + Gᵀλ_{n+1} = Q,  Φ = 0,  Ψv = f  at (q_{n+1}, v_{n+1}, t_{n+1})
//
// a is the algorithmic acceleration, v̇ the one that satisfies the equations of motion and is given out. Stabilized
// index 2 asks for G v_{n+1} = ν as well; the displacement y that keeps the positions on their constraints is mass-
// orthogonal to them. Coefficients from the spectral radius ρ at infinity (Chung & Hulbert 1993):
//   α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), γ = ½ + α_f − α_m, β = ¼ (γ + ½)²
//
// Orders: positions, velocities, accelerations v̇ and multipliers 2, from the first step on. That takes the right start
// (derived from the local errors; v̈ is found by a difference quotient):
//   a(t) = v̇(t + (α_m − α_f) h), so a_0 = v̇_0 + (α_m − α_f) h v̈_0 + O(h²): both forms.
//   In index 3, positions on the constraints make the recursion of the positions an equation for velocities: normal to
//   the constraints the scheme's v is v(t) + l/h, where l = h³ ((1/6 − β − (α_m − α_f)/2) v̈ + (1/12) v̂ v̇) is the local
//   error of the positions and v̂ v̇ the group's bracket (rA: ω̄ × ω̄̇; rp, reps: none). A start from v(t) would jump
//   there by an acceleration of order h, which the multipliers show; so v_0 gets the normal part of l/h.
//
// Index 3 magnifies the rounding of Φ by 1/h²: below h of some 1e-5 of the motion's time scale its accelerations and
// multipliers get no better. Stabilized index 2 magnifies that of G v, by 1/h only.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

inline constexpr MethodParameter kSpectralRadius{
    "spectral_radius", "spectral radius at infinity: 0 damps high frequencies most, 1 not at all", 0.8, 0, 1};

std::unique_ptr<Integrator> make_generalized_alpha();     // index 3
std::unique_ptr<Integrator> make_generalized_alpha_i2();  // stabilized index 2

}  // namespace poinsot
