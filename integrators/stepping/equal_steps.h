// A stepper of a method with error control driven with steps of equal length, whatever their error: what shows its
// order.
#pragma once

#include <memory>

#include "core/check.h"
#include "formulations/registry.h"
#include "integrators/start/initial_state.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/radau_stepper.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/registry.h"

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
  // make(problem, solver, statistics, clock) makes the stepper.
  template <class Make>
  EqualSteps(const Scene& scene, const Settings& settings, Make&& make)
      : model(std::make_shared<const Model>(compile(scene))), start(find_initial_state(model, settings)) {
    problem = formulations().require(settings.formulation).make(model, start.dropped);
    solver = linear_solvers().require("dense").make();  // fresh pivots: orders are measured down to 1e-13
    stepper = make(*problem, *solver, statistics, clock);
    State state;
    state.q.resize(static_cast<std::size_t>(problem->nq()));
    state.v.resize(static_cast<std::size_t>(problem->nv()));
    state.a.resize(state.v.size());
    state.lambda.resize(static_cast<std::size_t>(problem->nc()));
    check(problem->from_bodies(start.bodies, state.q, state.v).ok(), "the formulation represents the start");
    problem->set_position(0, state.q);
    problem->set_velocity(state.v);
    check(Consistent(*problem, "dense").accelerations(*problem, 0, state.a, state.lambda).ok(), "the start is regular");
    check(stepper->prepare().ok(), "the pattern can be analysed");
    stepper->start(0, state);
  }

  // `steps` steps to time `end`; a sample after every `every` of them.
  Status march(double end, int steps, int every, const Observer& observe) {
    for (int n = 1; n <= steps; ++n) {
      if (Status status = try_step(*stepper, end * n / steps); !status.ok()) return status;
      if (Status status = stepper->complete(); !status.ok()) return status;
      stepper->settle();
      if (n % every != 0) continue;
      const Point& at = stepper->state();
      problem->set_position(at.t, span(at.q));
      problem->set_velocity(span(at.v));
      observe({at.t, *problem, span(at.q), span(at.v), stepper->points().a(at), stepper->points().lambda(at)});
    }
    return {};
  }

  std::shared_ptr<const Model> model;
  InitialState start;
  std::unique_ptr<Problem> problem;
  std::unique_ptr<LinearSolver> solver;
  Statistics statistics;
  PhaseClock clock;
  std::unique_ptr<Stepper> stepper;
};

}  // namespace poinsot
