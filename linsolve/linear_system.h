// A linear system of a run as it is really solved: which matrix is factored, and by which linear solver.
//
//   whole   the matrix of the pattern;
//   G       its constraint Jacobian alone, where that is square and carries everything (linsolve/square_jacobian.h):
//           a mechanism without degrees of freedom.
//
// To a caller it looks like a LinearSolver for the whole matrix (linsolve/linear_solver.h): the same order of calls,
// the same slots, values and answers. What was factored, by whom and how often stands in work().
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "linsolve/linear_solver.h"
#include "linsolve/registry.h"
#include "linsolve/square_jacobian.h"

namespace poinsot {

// By the names of the registries.
struct LinearChoice {
  std::string solver = "auto", system = "auto";
};

// What one linear solver did for systems of one kind.
struct LinearWork {
  std::string_view solver;          // that factored, by its name: of auto its pick, of a hand-over who took it
  std::string_view system;          // "G" or "whole"
  std::string_view handed_over_by;  // the solver that was asked and passed this on; empty: none
  std::int64_t factorizations = 0, refactorizations = 0, solves = 0;  // refactorizations: with kept pivots
  std::int64_t refinements = 0;                                       // corrections of solutions by their residual
  double reciprocal_condition = 0;  // as last examined, the least of several systems; 0 where never
};

class LinearSystem {
 public:
  // Throws InputError where a name of the choice is not in its registry.
  explicit LinearSystem(const LinearChoice& choice, Workload workload = Workload::factorizations);

  // Where the pattern is that of before and the solver factored its last values by itself, what it found out stays:
  // pivots are examined anew only where the next values need others. Of small systems; others would keep their patterns
  // for nothing.
  LinearStatus analyze(Pattern pattern);
  LinearStatus factor(Ahead ahead = {});
  LinearStatus solve(std::span<double> b) {
    LinearStatus status = by_jacobian_ ? jacobian_->solve(b) : whole_->solve(b);
    factored_ = status.ok();
    return status;
  }

  std::span<const int> slots() const { return jacobian_ ? jacobian_->slots() : whole_->slots(); }
  std::span<double> values() { return jacobian_ ? jacobian_->values() : whole_->values(); }
  bool factored() const { return factored_; }  // solve() may be called
  void add_work(std::vector<LinearWork>& work) const;
  // Gives its memory back. It is to be analyzed anew before it is used again; what it did stays in its work.
  void let_go();
  // LinearSolver::orientation() of the whole matrix; 0 where another was factored.
  std::uint64_t orientation() { return by_jacobian_ || !whole_ ? 0 : whole_->orientation(); }
  // The same of the constraint Jacobian; 0 where that was not factored by itself.
  std::uint64_t jacobian_orientation() { return by_jacobian_ ? jacobian_->orientation() : 0; }
  // Of the solver of the last factorization.
  const LinearStatistics& statistics() const {
    return by_jacobian_ ? jacobian_->solver().statistics() : whole_->statistics();
  }

 private:
  LinearStatus analyze_anew(Pattern&& pattern);
  LinearStatus factor_at_hand(Ahead ahead);
  LinearStatus factor_whole_instead();

  const LinearSolverEntry* solver_;
  bool may_reduce_;
  Workload workload_;
  std::unique_ptr<SquareJacobian> jacobian_;  // where the structure has the form
  std::unique_ptr<LinearSolver> whole_;       // where it has not, or once the values have not
  Pattern pattern_;                           // of jacobian_, and of small systems
  bool by_jacobian_ = false;                  // the last factorization
  bool factored_ = false;
  std::vector<LinearWork> past_;  // of what was let go
};

// The linear systems of a run, all of one choice; they live as long as this does.
class LinearSystems {
 public:
  explicit LinearSystems(LinearChoice choice) : choice_(std::move(choice)) {}
  LinearSystem& add(Workload workload = Workload::factorizations);
  // Of all together, by solver and system; those that factored most come first.
  std::vector<LinearWork> work() const;
  // Of all, at the end of the run: what is still to be computed then has room.
  void let_go();

 private:
  LinearChoice choice_;
  std::vector<std::unique_ptr<LinearSystem>> systems_;
};

}  // namespace poinsot
