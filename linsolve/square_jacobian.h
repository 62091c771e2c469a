// A mechanism without degrees of freedom: as many constraints as velocities, so that G is square and
//
//   [ K  Gᵀ ] [ v ]   [ f ]
//   [ G  0  ] [ λ ] = [ γ ]      is solved by   v = G⁻¹ γ,   λ = G⁻ᵀ (f − K v).
//
// One factorization of G, half the size, instead of the whole matrix; K is only multiplied with. The block above G is
// compared with Gᵀ number by number at every factorization; where it differs (velocity rows, some force laws) the whole
// matrix has to be factored.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "linsolve/csc_layout.h"
#include "linsolve/linear_solver.h"

namespace poinsot {

class SquareJacobian {
 public:
  // Factors G with `solver`, which takes matrices of any structure and solves with their transpose.
  explicit SquareJacobian(std::unique_ptr<LinearSolver> solver) : solver_(std::move(solver)) {}

  // Whether there are as many unknowns with a diagonal entry (velocities) as without (multipliers). Needs little; most
  // patterns end here.
  static bool fits(const Pattern& pattern);
  // Whether the pattern has the form, and the solver takes G. Keeps a reference to nothing.
  bool analyze(const Pattern& pattern);

  std::span<const int> slots() const { return layout_.slots; }
  std::span<double> values() { return values_; }
  // Hands G to the solver; whether the block above it is Gᵀ.
  bool take_values();
  // After take_values() that said so. The unknown of a failure is one of the whole system.
  LinearStatus factor();
  LinearStatus solve(std::span<double> b);
  const LinearSolver& solver() const { return *solver_; }
  std::uint64_t orientation() { return solver_->orientation(); }  // of G

 private:
  struct Entry {               // of G
    int whole, above, solver;  // its places in the whole, in the block above, in the solver's values
  };

  CscLayout layout_;  // of the whole
  std::vector<double> values_;
  std::vector<int> velocities_, multipliers_;  // their places in the whole system, ascending
  std::vector<Entry> g_;
  std::vector<int> k_start_;            // K by columns: of column c from k_start_[c] on,
  std::vector<std::pair<int, int>> k_;  // place in the whole, row
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> v_, f_;
};

}  // namespace poinsot
