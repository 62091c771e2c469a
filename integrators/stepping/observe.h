// What every integrator does at a sample and at its end: measure the constraint violation, hand out, add up times.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/phase_clock.h"
#include "integrators/integrator.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

// The problem stands at `at`; t: the output time it is given out for, where that is not at.t to the last digit.
inline void sample(const Observer& observe, const Problem& problem, const State& at, Statistics& statistics, double t) {
  const LargestResidual here = problem.largest_residual();
  statistics.violation.position = std::max(statistics.violation.position, here.position);
  statistics.violation.velocity = std::max(statistics.violation.velocity, here.velocity);
  if (observe) observe({t, at.t, problem, span(at.q), span(at.v), at.a(), at.lambda()});
}

inline void sample(const Observer& observe, const Problem& problem, const State& at, Statistics& statistics) {
  sample(observe, problem, at, statistics, at.t);
}

// Says once that multipliers given out are open.
class OpenMultipliers {
 public:
  void look(const State& at, const Tell& tell) {
    if (!at.multipliers_open || std::exchange(told_, true)) return;
    tell(
        fmt::format("at t = {:.6g} s the position leaves multipliers open: they are those of a state beside it", at.t));
  }

 private:
  bool told_ = false;
};

inline void finish(PhaseClock& clock, Statistics& statistics) {
  clock.stop();
  auto& s = statistics.seconds;
  s.total += clock.total();
  s.assembly += clock.seconds(Phase::assembly);
  s.factor += clock.seconds(Phase::factor);
  s.solve += clock.seconds(Phase::solve);
  s.other += clock.seconds(Phase::other);
}

}  // namespace poinsot
