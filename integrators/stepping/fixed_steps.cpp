#include "integrators/stepping/fixed_steps.h"

#include <algorithm>
#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/turning.h"

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
      output_(run.settings) {}

Status FixedSteps::march() {
  if (Status status = prepare(); !status.ok()) return status;
  const bool discrete = problem_.has_discrete_state();
  Status status = begin();
  if (status.ok()) status = measure_rotation(problem_, 0);
  for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
    if (interruption_requested) {
      status = interrupted(x_.t);
      break;
    }
    if (rewritten_) {
      rewritten_ = false;
      if (status = resume(); !status.ok()) break;
    }
    q_n_.swap(x_.q);
    v_n_.swap(x_.v);
    status = step(grid_.time(n));
    if (status.ok()) status = measure_rotation(last_seen(), grid_.time(n));
    if (!status.ok()) {
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

Status FixedSteps::measure_rotation(Problem& problem, double t) {
  const double before = std::exchange(rotation_, h_ * problem.fastest_turn());
  if (rotation_ > run_.most_rotation) return rotated_too_far(problem, x_.a(), t, h_, run_.most_rotation);
  if (Status status = check_turns(problem, t); !status.ok()) return status;
  run_.statistics.largest_rotation = std::max(run_.statistics.largest_rotation, rotation_);
  if (std::max(before, rotation_) < 0.5 * kMostUnexpected || t == 0) return {};
  return check_velocity(problem, t);
}

Status FixedSteps::check_turns(Problem& problem, double t) {
  return turns_too_far(problem, h_) ? turned_too_far(problem, t, h_) : Status{};
}

// The rotation in a step is h ω; that of the one before is what the motion leads to.
Status FixedSteps::check_velocity(Problem& problem, double t) {
  change_ = x_.v - v_n_;
  problem.set_velocity(span(change_));
  const double unexpected = h_ * problem.fastest_turn();
  problem.set_velocity(span(x_.v));
  if (unexpected < kMostUnexpected) return {};
  return turned_unexpectedly(problem, x_.a(), t, h_, unexpected);
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
  const double scale = index3_scale();
  const State& given = scale > 0 ? output_.choose(problem, x_, scale, last, run_.statistics) : x_;
  clock_.lap(Phase::other);
  sample(run_.observe, problem, given, run_.statistics);
  clock_.skip();
  return {};
}

Problem& FixedSteps::stand() {
  place(problem_);
  return problem_;
}

void FixedSteps::place_beside(Problem& problem) {
  Vector half = 0.5 * h_ * x_.v, q(x_.q.size());
  problem.retract(span(x_.q), span(half), span(q));
  problem.set_position(x_.t + 0.5 * h_, span(q));
  problem.set_velocity(span(x_.v));
}

Status FixedSteps::accept(Problem& problem) {
  return poinsot::accept(problem, x_, rewritten_);
}

}  // namespace poinsot
