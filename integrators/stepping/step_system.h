// The linear system of a step: one pattern analysed once, then assemble, factor, solve, each counted and timed.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/phase_clock.h"
#include "integrators/integrator.h"

namespace poinsot {

// Any system about a problem.
class TimedSystem {
 public:
  TimedSystem(const Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock);
  // The other's linear system about another problem, whose pattern is the same.
  TimedSystem(const Problem& problem, const TimedSystem& other)
      : TimedSystem(problem, other.linear_, other.statistics_, other.clock_) {}

  // Analyses the pattern. Call once, before the clock starts. unknowns[k]: which of the problem's unknowns the system's
  // k-th belongs to, for messages; empty: they are the same.
  Status prepare(Pattern pattern, std::vector<int> unknowns = {});
  // write(slots, values) sets the matrix; then it is factored, for what is ahead where that is known.
  // The time up to the call belongs to Phase::other.
  template <class Write>
  Status refresh(double t, Write&& write, Ahead ahead = {}) {
    clock_.lap(Phase::other);
    write(linear_.slots(), linear_.values());
    return factor(t, ahead);
  }
  // b ← A⁻¹ b.
  Status solve(double t, std::span<double> b);
  bool ready() const { return linear_.factored(); }
  std::uint64_t orientation() { return linear_.orientation(); }
  std::uint64_t jacobian_orientation() { return linear_.jacobian_orientation(); }

 private:
  Status factor(double t, Ahead ahead);
  Status explained(double t, LinearStatus status) const;

  const Problem& problem_;
  LinearSystem& linear_;
  Statistics& statistics_;
  PhaseClock& clock_;
  std::vector<int> unknowns_;
};

// A system of the problem's own matrices.
class StepSystem : public TimedSystem {
 public:
  StepSystem(Problem& problem, LinearSystem& linear, MatrixKind kind, Statistics& statistics, PhaseClock& clock)
      : TimedSystem(problem, linear, statistics, clock), problem_(problem), kind_(kind) {}
  // For a clone of the other's problem: who is there first analyses the pattern of other rows for both.
  StepSystem(Problem& clone, const StepSystem& other)
      : TimedSystem(clone, other), problem_(clone), kind_(other.kind_), revision_(other.revision_) {}

  Status prepare() {
    *revision_ = problem_.revision();
    return TimedSystem::prepare(problem_.pattern(kind_));
  }
  bool ready() const { return TimedSystem::ready() && *revision_ == problem_.revision(); }
  // Assembles at the problem's point and factors, for what is ahead where that is known.
  Status refresh(double t, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                 std::span<const double> lambda, Ahead ahead = {}) {
    if (*revision_ != problem_.revision()) {
      if (Status status = prepare(); !status.ok()) return status;
    }
    const auto write = [&](std::span<const int> slots, std::span<double> values) {
      problem_.assemble(kind_, scale, dq, a, lambda, slots, values);
    };
    return TimedSystem::refresh(t, write, ahead);
  }

 private:
  Problem& problem_;
  MatrixKind kind_;
  std::shared_ptr<int> revision_ = std::make_shared<int>(0);  // of the rows the pattern was analysed for
};

// What a linear solver's failure means for the mechanism: which body or constraint, what to try.
Status explain(const Problem& problem, double t, const LinearStatus& status);

}  // namespace poinsot
