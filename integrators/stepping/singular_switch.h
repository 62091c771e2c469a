// Over a switch of a law that lies at a singular position, as of a stop that engages where a parallelogram is flat.
//
// The constraints leave the state there to rounding, and accelerations are others on either side, so that it is no
// limit of those beside (passage.h). On one side they are smooth: with c(s) what puts q ⊞ s v back onto Φ = 0, v(s) and
// a(s) velocity and acceleration there,
//
//   x(s) = Σ w_k(s) x(±kτ) + O(τ⁶),  k = 1, ... 6, by Lagrange's polynomial.
//
// Position and velocity are those of the near side, to which accelerations lead that vary linearly from where the
// motion stands to a(0−); accelerations are those of the far side.
#pragma once

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {

// From where the motion stands, or where its last step began.
enum class Before { now, step };

// From `before`, so near that accelerations vary linearly, to `at`, just past the switch at t. For how long the
// singular position is near, s, as Run has it; 0: there are no such limits. λ has one, or is left open.
double cross_singular_switch(Problem& problem, Consistent& consistent, const State& before, double t, double rtol,
                             State& at);

}  // namespace poinsot
