// Kinematics of a mechanism without degrees of freedom (the paper's sec. "Kinematics Analysis").
//
// At every t_n: Φ(q, t) = 0 by Newton's method from q_{n−1} ⊞ (h v + ½h² a + d) (11), where d is extrapolated from what
// the steps before found beyond these terms, with corrections (14), until their 2-norm is below the tolerance; then
// G v = ν (15b) and G a = γ (16) with the matrix at the solution, which is corrected further where velocities depend
// on it by more than the tolerance, as beside singular positions. (The original study's codes, and `simplified`, start
// from q_{n−1} and keep the matrix they find there, with the rows of t_n.) Multipliers, where asked for, by inverse
// dynamics.
#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace poinsot {

std::unique_ptr<Integrator> make_kinematics();

}  // namespace poinsot
