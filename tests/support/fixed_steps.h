// Steppers of error-controlled methods driven with steps of equal length, and the orders that then show.
#pragma once

#include <array>
#include <memory>

#include "integrators/consistent.h"
#include "integrators/explicit_stepper.h"
#include "integrators/initial_state.h"
#include "integrators/radau_stepper.h"
#include "integrators/vectors.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

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
struct Bench {
  // make(problem, solver, statistics, clock) makes the stepper.
  template <class Make>
  Bench(const Scene& scene, const Settings& settings, Make&& make)
      : model(std::make_shared<const Model>(compile(scene))), start(find_initial_state(model, settings)) {
    problem = find_formulation(settings.formulation)->make(model, start.dropped);
    solver = find_linear_solver("dense")->make();  // fresh pivots: orders are measured down to 1e-13
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

  // `steps` steps of equal length, a multiple of four, whatever their error; the motion after every quarter.
  std::vector<Snapshot> march(double end, int steps) {
    std::vector<Snapshot> quarters;
    for (int n = 1; n <= steps; ++n) {
      check(try_step(*stepper, end * n / steps).ok(), "the stages exist");
      check(stepper->complete().ok(), "the step can be projected");
      stepper->settle();
      if (4 * n % steps != 0) continue;
      const poinsot::Point& at = stepper->state();
      problem->set_position(at.t, span(at.q));
      problem->set_velocity(span(at.v));
      quarters.push_back(
          snapshot({at.t, *problem, span(at.q), span(at.v), stepper->points().a(at), stepper->points().lambda(at)}));
    }
    return quarters;
  }

  std::shared_ptr<const Model> model;
  InitialState start;
  std::unique_ptr<Problem> problem;
  std::unique_ptr<LinearSolver> solver;
  Statistics statistics;
  PhaseClock clock;
  std::unique_ptr<Stepper> stepper;
};

// Root mean squares over instants, bodies and components, relative to those of the motion.
inline std::array<double, 4> mean_errors(const std::vector<Snapshot>& x, const std::vector<Snapshot>& exact) {
  std::array<double, 4> apart{}, size{};
  const auto add = [&](std::size_t k, const auto& u, const auto& v) {
    apart[k] += (u - v).squaredNorm();
    size[k] += v.squaredNorm();
  };
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (std::size_t b = 0; b < x[n].bodies.size(); ++b) {
      const BodyState &u = x[n].bodies[b], &v = exact[n].bodies[b];
      add(0, u.r, v.r), add(0, u.A, v.A);
      add(1, u.rd, v.rd), add(1, u.w, v.w);
      add(2, u.rdd, v.rdd), add(2, u.wd, v.wd);
    }
    const auto rows = [](const std::vector<double>& l) {
      return Eigen::Map<const Eigen::VectorXd>(l.data(), static_cast<Eigen::Index>(l.size()));
    };
    add(3, rows(x[n].lambda), rows(exact[n].lambda));
  }
  std::array<double, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) result[k] = size[k] > 0 ? std::sqrt(apart[k] / size[k]) : 0;
  return result;
}

}  // namespace poinsot::test
