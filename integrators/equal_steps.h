// A stepper of a method with error control driven with steps of equal length, whatever their error: what shows its
// order.
#pragma once

#include <cmath>
#include <memory>

#include "core/check.h"
#include "formulations/registry.h"
#include "integrators/start/first_state.h"
#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/radau_stepper.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/linear_system.h"

namespace poinsot {

inline Status try_step(ExplicitStepper& stepper, double to) {
  double error = 0;
  return stepper.attempt(to, ExplicitStepper::Stages::as_they_come, error);
}
inline Status try_step(RadauStepper& stepper, double to) {
  double error = 0;
  return stepper.attempt(to, error);
}

// A stepper at the start of a scene, and what it needs to live.
template <class Stepper>
struct EqualSteps {
  // make(problem, systems, statistics, clock) makes the stepper.
  template <class Make>
  EqualSteps(const Scene& scene, const Settings& settings, Make&& make)
      : model(std::make_shared<const Model>(compile(scene))),
        start(find_initial_state(model, Settings{})),
        systems(settings.linear()) {
    problem = formulations().require(settings.formulation).make(model, start.rank.aside);
    stepper = make(*problem, systems, statistics, clock);
    State first(*problem);
    check(find_first_state(start, settings, *problem, first, [](const std::string&) {}).ok(), "the start is regular");
    check(stepper->prepare().ok(), "the pattern can be analysed");
    check(stepper->start(first).ok(), "the start is regular");
  }

  // `steps` steps to time `end`; a sample after every `every` of them.
  Status march(double end, int steps, int every, const Observer& observe) {
    for (int n = 1; n <= steps; ++n) {
      if (Status status = try_step(*stepper, end * n / steps); !status.ok()) return status;
      double error = 0;
      if (Status status = stepper->complete(error, HUGE_VAL); !status.ok()) return status;
      if (Status status = stepper->settle(); !status.ok()) return status;
      if (n % every != 0) continue;
      const State& at = stepper->state();
      problem->set_position(at.t, span(at.q));
      problem->set_velocity(span(at.v));
      observe({at.t, at.t, *problem, span(at.q), span(at.v), at.a(), at.lambda()});
    }
    return {};
  }

  std::shared_ptr<const Model> model;
  InitialState start;
  std::unique_ptr<Problem> problem;
  LinearSystems systems;
  Statistics statistics;
  PhaseClock clock;
  std::unique_ptr<Stepper> stepper;
};

}  // namespace poinsot
