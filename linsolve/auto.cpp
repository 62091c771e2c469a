// auto: picks a linear solver when the structure is known, and leaves everything to it.
//
//   structure                                 pick    measured: klu's time for factor + solve over the pick's
//   unsymmetric: kinematics; G alone          klu     (block hands the first over to klu, and does not take the second)
//   the same, of one body                     dense   in whole steps 1.17 to 1.35, of instructions
//   saddle point of bodies and constraints    block   1.1 to 1.8 the paper's mechanisms, 1.3 to 1.5 one hinged body,
//                                                     2.3 to 3.1 chains of 10, 2.7 to 3.2 of 100 and more,
//                                                     3.7 to 4.5 trees, 2.8 to 4.2 ladders, 1.5 to 2.3 many
//                                                     four-bars
//
// Measured: bench/linear_solver_bench, exact Newton matrices in rA, rp and reps, all in one run in turn, on an AMD EPYC
// with AVX-512 (before commit 71b95ac; where it says "the paper's mechanisms", block had G alone of those without
// degrees of freedom and klu the whole matrix).
//
// Where solves outnumber factorizations (jacobian "kept") the pick is the same: linsolve/README.md has the figures.
#include <utility>

#include "linsolve/back_ends.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

// Whether rows and columns have equally many entries one by one, as they have in a saddle point. Cheaper than to look
// for mirrored entries; a chance hit only costs time.
bool saddle_point(const Pattern& pattern) {
  constexpr double kSymmetric = 0.9;  // share of the unknowns
  // Differences from each unknown to the one before of: entries in its row − entries in its column.
  std::vector<int> change(static_cast<std::size_t>(pattern.n) + 1, 0);
  const auto at = [&](int k) -> int& { return change[static_cast<std::size_t>(k)]; };
  for (const Block& b : pattern.blocks) {
    at(b.row) += b.cols, at(b.row + b.rows) -= b.cols;
    at(b.col) -= b.rows, at(b.col + b.cols) += b.rows;
  }
  int excess = 0, equal = 0;
  for (int k = 0; k < pattern.n; ++k) {
    excess += at(k);
    if (excess == 0) ++equal;
  }
  return equal >= kSymmetric * pattern.n;
}

class Auto final : public LinearSolver {
 public:
  std::span<const int> slots() const override { return solver_ ? solver_->slots() : LinearSolver::slots(); }
  std::span<double> values() override { return solver_ ? solver_->values() : LinearSolver::values(); }
  const LinearStatistics& statistics() const override {
    return solver_ ? solver_->statistics() : LinearSolver::statistics();
  }
  std::string_view picked() const override { return picked_; }
  std::uint64_t orientation() override { return solver_ ? solver_->orientation() : 0; }
  Helper helper() const override { return solver_ ? solver_->helper() : Helper(); }

 private:
  LinearStatus do_analyze(Pattern&& pattern) override {
    constexpr int kOneBody = 7;  // coordinates, at most
    picked_ = workload() != Workload::transposed && saddle_point(pattern) ? "block"
              : pattern.n <= kOneBody                                     ? "dense"
                                                                          : "klu";
    solver_ = linear_solvers().require(picked_).make();
    return solver_->analyze(std::move(pattern), workload());
  }
  LinearStatus do_factor() override { return solver_->factor(); }
  LinearStatus do_factor_for(Ahead ahead) override { return solver_->factor(ahead); }
  LinearStatus do_solve(std::span<double> b) override { return solver_->solve(b); }
  LinearStatus do_solve_transposed(std::span<double> b) override { return solver_->solve_transposed(b); }

  std::string_view picked_;
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_auto() {
  return std::make_unique<Auto>();
}

}  // namespace poinsot
