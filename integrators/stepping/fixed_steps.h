// The frame of methods of fixed step whose state is (q, v) with the (a, λ) of the last step: steps on the time grid,
// the discrete state brought up to date after each, samples, and what is left behind at the end or after a failure.
#pragma once

#include <Eigen/Core>

#include "integrators/stepping/accept.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/time_grid.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

struct SteppedState : State {
  using Vector = Eigen::VectorXd;

  explicit SteppedState(const State& state) : State(state), q_n(q), v_n(v), nv(v.size()), nc(z.size() - nv) {}

  void stand(Problem& problem, double at) const {
    problem.set_position(at, span(q));
    problem.set_velocity(span(v));
  }

  Vector q_n, v_n;  // where the step began
  Eigen::Index nv, nc;
};

// `x` is consistent at 0 and ends in `state`.
//   step(t)   from x.q_n and x.v_n to x.q, x.v and x.z at t: Status; after a failure the last state stays
//   stand(t)  returns the problem, which stands at x at time t then
template <class Step, class Stand>
Status fixed_steps(SteppedState& x, const TimeGrid& grid, State& state, const Observer& observe, Statistics& statistics,
                   PhaseClock& clock, Step&& step, Stand&& stand) {
  const Problem& start = stand(0);
  const bool discrete = start.has_discrete_state();
  sample(observe, start, x, statistics);
  clock.start();
  Status status;
  for (std::int64_t n = 1; n <= grid.steps; ++n) {
    const double t = grid.time(n);
    x.q_n.swap(x.q);
    x.v_n.swap(x.v);
    if (status = step(t); !status.ok()) {
      x.q.swap(x.q_n);
      x.v.swap(x.v_n);
      break;
    }
    x.t = t;
    ++statistics.steps;
    if (!discrete && !grid.sampled(n)) continue;
    Problem& problem = stand(t);
    bool rewritten = false;
    if (status = accept(problem, x, rewritten); !status.ok()) break;
    if (grid.sampled(n)) {
      clock.lap(Phase::other);
      sample(observe, problem, x, statistics);
      clock.skip();
    }
  }
  finish(clock, statistics);
  if (!status.ok()) x.z = state.z;  // not what Newton's method left
  state = x;
  return status;
}

}  // namespace poinsot
