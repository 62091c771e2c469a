#include "integrators/stepping/fixed_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/switch_times.h"

namespace poinsot {
namespace {

constexpr int kHalvings = 10;  // of a step that fails

// What the size of a step has a part in.
bool may_be_too_long(Failure failure) {
  return failure == Failure::not_converged || failure == Failure::not_finite || failure == Failure::singular_matrix ||
         failure == Failure::singular_position;
}

// Parts of a step creep up to a singular position, where a whole step goes over it: there rounding may choose the
// branch, and velocities jump. Those of a step worth its name change by a fraction, as accelerations beside such a
// position do not.
bool jumps(std::span<const BodyState> before, std::span<const BodyState> after) {
  constexpr double kFraction = 0.5;
  double way = 0, turn = 0, speed = 0, rate = 0;
  for (std::size_t b = 0; b < before.size(); ++b) {
    way = std::max(way, (after[b].rd - before[b].rd).norm());
    turn = std::max(turn, (after[b].w - before[b].w).norm());
    speed = std::max(speed, before[b].rd.norm());
    rate = std::max(rate, before[b].w.norm());
  }
  return way > kFraction * speed || turn > kFraction * rate;
}

}  // namespace

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
      discrete_(run.problem.has_discrete_state()),
      chooses_(run.problem.model_rows().size() < run.problem.model().rows.size()),
      singular_ends_(run.settings),
      output_(run.settings) {}

Status FixedSteps::march() {
  if (Status status = prepare(); !status.ok()) return status;
  Status status = begin();
  if (status.ok()) status = measure_rotation(problem_, 0);
  settles_ = settings_.retry && integrates();
  branch_.begin(problem_, x_.a());
  if (run_.singular_for > 0) settled_at_ = 0;
  divides_ = settings_.retry && divides();
  repeats_ = divides_ && !remembers();
  const int halvings = divides_ ? kHalvings : 0;
  for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
    if (interruption_requested) {
      status = interrupted(x_.t);
      break;
    }
    if (grid_.time(n) > run_.jumps_after) {
      status = jump_of_positions(run_.jumps_after);
      break;
    }
    const bool sampled = grid_.sampled(n);
    const std::int64_t before = run_.statistics.steps;
    status = reach_in_halves(grid_.time(n), sampled, halvings);
    if (may_be_too_long(status.failure) && x_.t == grid_.time(n - 1) && settles_beginning())
      status = reach_in_halves(grid_.time(n), sampled, halvings);
    if (run_.statistics.steps > before + 1) ++run_.statistics.divided_steps;
    if (status.ok() && sampled) status = give_out(*standing_);
  }
  finish(clock_, run_.statistics);
  if (!status.ok()) x_.z = run_.state.z;  // not what Newton's method left
  run_.state = x_;
  if (const std::int64_t divided = run_.statistics.divided_steps; divided > 0)
    run_.tell(fmt::format("steps that failed as a whole and were done in parts: {} of {}, parts of {:.2g} s and more",
                          divided, grid_.steps, shortest_));
  return status;
}

// The step from x_ to t, brought up to date where coordinates have to be, or a sample is taken there.
Status FixedSteps::reach(double t, bool sampled) {
  const double began = x_.t;
  const bool leaves = began == settled_at_, resumes = std::exchange(rewritten_, false);
  if (leaves || resumes) {
    if (Status status = leaves ? leave_singular() : resume(); !status.ok()) return status;
  }
  q_n_.swap(x_.q);
  v_n_.swap(x_.v);
  x_.multipliers_open = false;
  Status status = step(t);
  x_.t = t;
  bool settled = false;
  if (status.ok()) status = examine_end(began, settled);
  if (!status.ok()) {
    x_.t = began;
    x_.q.swap(q_n_);
    x_.v.swap(v_n_);
    return status;
  }
  branch_.follow();
  if (settled) settled_at_ = t;
  ++run_.statistics.steps;
  if (!discrete_ && !sampled) return {};
  standing_ = &stand();
  return discrete_ ? accept(*standing_) : Status{};
}

// Once where a step begins.
bool FixedSteps::asks_for_other_rows(double began) {
  return chooses_ && std::exchange(chose_at_, began) != began;
}

// Where the step leads to the rows that are kept may depend on one another: looks whether others do not.
bool FixedSteps::choose_rows() {
  Vector ahead = h_ * x_.v, q(x_.q.size());
  Problem& problem = last_seen();
  problem.retract(span(x_.q), span(ahead), span(q));
  problem.set_position(x_.t + h_, span(q));
  return problem.choose_rows_here(x_.t, span(x_.q), span(x_.v), x_.lambda());
}

Status FixedSteps::reach_in_halves(double t, bool sampled, int halvings) {
  if (halvings > 0 || chooses_) z_began_ = x_.z;
  const double began = x_.t;
  departs_ = false;
  Status as_one = reach(t, sampled);
  if (may_be_too_long(as_one.failure) && as_one.failure != Failure::not_finite && x_.t == began &&
      asks_for_other_rows(began)) {
    x_.z = z_began_;
    if (Status status = began == settled_at_ ? Status{} : forget(); !status.ok()) return status;
    rewritten_ = choose_rows();
    if (rewritten_) z_began_ = x_.z;
    if (rewritten_ || as_one.message.empty()) as_one = reach(t, sampled);
  }
  const bool departs = departs_;
  if (as_one.ok() || halvings == 0 || !may_be_too_long(as_one.failure) || x_.t > began) return as_one;
  const double h = h_, half = began + 0.5 * (t - began);
  if (!(began < half && half < t)) return as_one;
  x_.z = z_began_;
  if (began != settled_at_ && !forget().ok()) return as_one;
  const bool outermost = halvings == kHalvings;
  const std::vector<BodyState> before = outermost ? bodies() : std::vector<BodyState>{};
  const State state = x_;
  const double shortest = shortest_;
  const std::int64_t steps = run_.statistics.steps;
  set_step(0.5 * h);
  Status status = reach_in_halves(half, false, halvings - 1);
  if (status.ok()) status = reach_in_halves(t, sampled, halvings - 1);
  shortest_ = shortest_ > 0 ? std::min(shortest_, 0.5 * h) : 0.5 * h;
  set_step(h);
  if (status.ok() && outermost && jumps(before, bodies())) {
    x_ = state;
    status = as_one;
  }
  if (status.ok() || !outermost || !departs) return status;
  x_ = state;
  shortest_ = shortest;
  run_.statistics.steps = steps;
  if (began != settled_at_ && !forget().ok()) return status;
  as_it_is_ = true;
  status = reach(t, sampled);
  as_it_is_ = false;
  return status;
}

std::vector<BodyState> FixedSteps::bodies() {
  std::vector<BodyState> states(index(problem_.bodies()));
  stand().to_bodies(x_.a(), states);
  return states;
}

void FixedSteps::set_step(double h) {
  const double before = std::exchange(h_, h);
  resize(before);
}

Status FixedSteps::begin() {
  place(problem_);
  if (run_.singular_for == 0) (void)singular_ends_.grow(x_.lambda());
  sample(run_.observe, problem_, x_, run_.statistics);
  clock_.start();
  return {};
}

Status FixedSteps::give_out(Problem& problem) {
  const bool settled = x_.t == settled_at_;
  if (Status status = settled ? Status{} : complete(); !status.ok()) return status;
  const bool last = x_.t >= settings_.end;
  const double scale = index3_scale();
  clock_.pause();  // what is computed for the output alone is no part of a step
  if (last) run_.systems.let_go();
  const State* given = &x_;
  if (!settled && scale > 0) given = &output_.choose(problem, x_, scale, last, run_.statistics);
  if (!settled && settles_ && singular_ends_.doubts(problem, *given, v_n_, h_)) {
    given_ = *given;
    if (settle(singular_ends_, problem, v_n_, *given_)) given = &*given_;
  }
  open_multipliers_.look(*given, run_.tell);
  sample(run_.observe, problem, *given, run_.statistics);
  if (given_ && given == &*given_) place(problem);
  clock_.resume();
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
