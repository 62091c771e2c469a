// The linear system of a step: one pattern analysed once, then assemble, factor, solve, each counted and timed.
#pragma once

#include <span>
#include <string>

#include "core/phase_clock.h"
#include "integrators/integrator.h"

namespace poinsot {

class StepSystem {
 public:
  StepSystem(Problem& problem, LinearSolver& solver, MatrixKind kind, Statistics& statistics, PhaseClock& clock);

  // Analyses the pattern. Call once, before the clock starts.
  Status prepare();
  // Assembles at the problem's point and factors. The time up to the call belongs to Phase::other.
  Status refresh(double t, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                 std::span<const double> lambda);
  // b ← A⁻¹ b.
  Status solve(double t, std::span<double> b);
  bool ready() const { return solver_.state() == LinearSolver::State::factored; }

 private:
  Problem& problem_;
  LinearSolver& solver_;
  MatrixKind kind_;
  Statistics& statistics_;
  PhaseClock& clock_;
};

// What a linear solver's failure means for the mechanism: which body or constraint, what to try.
Status explain(const Problem& problem, double t, const LinearStatus& status);

}  // namespace poinsot
