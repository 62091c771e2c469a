// The consistent linear system [M Gᵀ; G 0] of a state: accelerations and multipliers, and mass-orthogonal projections.
//
//   accelerations: M a + Gᵀλ = Q, G a = γ          positions: M δq + Gᵀμ = 0, G δq = −Φ (repeated)
//   velocities:    M δv + Gᵀμ = 0, G δv = ν − G v
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "formulations/problem.h"
#include "linsolve/linear_solver.h"

namespace poinsot {

class Consistent {
 public:
  Consistent(const Problem& problem, std::string_view linear_solver);

  // The problem stands at (t, q, v); a and lambda are written.
  Status accelerations(Problem& problem, double t, std::span<double> a, std::span<double> lambda);
  // b ← [M Gᵀ; G 0]⁻¹ b at the problem's point.
  Status solve(Problem& problem, double t, std::span<double> b);
  // Moves q onto Φ = 0 to rounding; the problem stands at the result. Fails with inconsistent_state where it cannot.
  Status project_position(Problem& problem, double t, std::vector<double>& q);
  // The problem stands at (t, q) and (·, v); v and the problem are moved onto G v = ν.
  Status project_velocity(Problem& problem, double t, std::vector<double>& v);

 private:
  Status factor(Problem& problem, double t);

  std::unique_ptr<LinearSolver> solver_;
  LinearStatus analyzed_;
  std::vector<double> rhs_, zeros_;
};

}  // namespace poinsot
