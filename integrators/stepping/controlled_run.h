// A run of a one-step method under error control: steps tried, refused and accepted, samples between them, an exact
// end.
//
// A Method is a stepper with: Status attempt(to, rejections, error), Status complete(), Status interpolate(t),
// interpolated(), settle(), state(); double first_step(end); double retry(h, rejections, usual), the step to
// try after so many rejections in a row; double adopt(h, wanted), the step after a completed one of length h.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/interruption.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/sample_times.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

template <class Method, class GiveOut>
Status controlled_steps(Method& method, const StepRule& rule, const Settings& settings, const GiveOut& give_out,
                        const Problem& problem, Statistics& statistics) {
  constexpr double kForgotten = 0.8;
  const double end = settings.end, smallest = 16 * std::numeric_limits<double>::epsilon() * end;
  SampleTimes times(settings.every, end);
  StepController controller(rule);
  Creeping creeping(end);
  double h = method.first_step(end);
  double usual = 0;    // length of the steps so far, those long ago forgotten
  int rejections = 0;  // in a row
  while (method.state().t < end) {
    const double t = method.state().t;
    if (interruption_requested) return interrupted(t);
    const double to = t + 1.01 * h >= end ? end : t + h;
    h = to - t;
    if (creeping.tries(t, h)) return step_too_small(t, h, {});
    double error = 0;
    Status status = method.attempt(to, rejections, error);
    if (status.ok() && error <= 1) status = method.complete();
    if (!status.ok() || !(error <= 1)) {
      if (status.failure == Failure::refused) return status;
      ++statistics.rejected_steps;
      h = status.ok() && std::isfinite(error) ? controller.rejected(h, error) : controller.failed(h);
      if (h < smallest) return step_too_small(t, h, status);
      h = method.retry(h, ++rejections, usual);
      continue;
    }
    ++statistics.steps;
    statistics.largest_rotation = std::max(statistics.largest_rotation, h * problem.fastest_turn());
    rejections = 0;
    usual = std::max(h, kForgotten * usual);
    creeping.completed(h);
    h = method.adopt(h, controller.accepted(h, error));
    for (; settings.every > 0 && times.next() < to; times.pass()) {
      if (status = method.interpolate(times.next()); !status.ok()) return status;
      give_out(method.interpolated());
    }
    if (status = method.settle(); !status.ok()) return status;
    if (settings.every == 0 || times.next() == to) {
      times.pass();
      give_out(method.state());
    }
  }
  return {};
}

// The method stands at the run's state.
template <class Method>
Status controlled_run(Method& method, const StepRule& rule, const Run& run, PhaseClock& clock) {
  const auto give_out = [&](const State& at) {
    clock.lap(Phase::other);
    sample(run.observe, run.problem, at, run.statistics);
    clock.skip();
  };
  clock.start();
  give_out(method.state());
  const Status status = controlled_steps(method, rule, run.settings, give_out, run.problem, run.statistics);
  finish(clock, run.statistics);
  run.state = method.state();
  return status;
}

}  // namespace poinsot
