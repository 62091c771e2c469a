#include "integrators/stepping/fixed_steps.h"

#include "integrators/stepping/accept.h"

namespace poinsot {

FixedSteps::FixedSteps(const Run& run)
    : run_(run),
      problem_(run.problem),
      settings_(run.settings),
      grid_(run.settings),
      h_(grid_.step()),
      nv_(run.problem.nv()),
      nc_(run.problem.nc()),
      x_(run.state),
      q_n_(run.state.q),
      v_n_(run.state.v),
      output_(run.settings, h_) {}

Status FixedSteps::march() {
  if (Status status = prepare(); !status.ok()) return status;
  const bool discrete = problem_.has_discrete_state();
  Status status = begin();
  for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
    if (rewritten_) {
      rewritten_ = false;
      if (status = resume(); !status.ok()) break;
    }
    q_n_.swap(x_.q);
    v_n_.swap(x_.v);
    if (status = step(grid_.time(n)); !status.ok()) {
      x_.q.swap(q_n_);
      x_.v.swap(v_n_);
      break;
    }
    x_.t = grid_.time(n);
    ++run_.statistics.steps;
    if (!discrete && !grid_.sampled(n)) continue;
    Problem& problem = stand();
    if (discrete) status = accept(problem);
    if (status.ok() && grid_.sampled(n)) status = give_out(problem);
  }
  finish(clock_, run_.statistics);
  if (!status.ok()) x_.z = run_.state.z;  // not what Newton's method left
  run_.state = x_;
  return status;
}

Status FixedSteps::begin() {
  place(problem_);
  sample(run_.observe, problem_, x_, run_.statistics);
  clock_.start();
  return {};
}

Status FixedSteps::give_out(Problem& problem) {
  if (Status status = complete(); !status.ok()) return status;
  const bool last = x_.t >= settings_.end;
  const State& given = solves_index3() ? output_.choose(problem, x_, last, run_.statistics) : x_;
  clock_.lap(Phase::other);
  sample(run_.observe, problem, given, run_.statistics);
  clock_.skip();
  return {};
}

Problem& FixedSteps::stand() {
  place(problem_);
  return problem_;
}

Status FixedSteps::accept(Problem& problem) {
  return poinsot::accept(problem, x_, rewritten_);
}

}  // namespace poinsot
