// The two ends of a step, a problem each with the system [M Gᵀ; G 0] of its point, for methods that ask for both. They
// take turns: where one step ends the next begins, and the problem stands there already. Both systems are one linear
// solver's, which holds the factorization made last.
#pragma once

#include <memory>
#include <utility>

#include "integrators/stepping/step_system.h"

namespace poinsot {

class StepEnds {
 public:
  struct End {
    Problem& problem;
    StepSystem system;
  };

  // The first step begins at `problem`.
  StepEnds(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock)
      : second_(problem.clone()),
        ends_{{problem, {problem, linear, MatrixKind::consistent, statistics, clock}},
              {*second_, {*second_, ends_[0].system}}} {}
  StepEnds(const StepEnds&) = delete;
  StepEnds& operator=(const StepEnds&) = delete;

  Status prepare() { return ends_[0].system.prepare(); }
  End& begin() { return *begin_; }
  End& end() { return *end_; }
  // Before a step: where it begins, turns of bodies have been counted.
  void set_out() { end_->problem.count_turns_from(begin_->problem); }
  void take_turns() { std::swap(begin_, end_); }

 private:
  std::unique_ptr<Problem> second_;
  End ends_[2];
  End *begin_ = &ends_[0], *end_ = &ends_[1];
};

}  // namespace poinsot
