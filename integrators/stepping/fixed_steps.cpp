#include "integrators/stepping/fixed_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/turning.h"

namespace poinsot {
namespace {

constexpr int kHalvings = 10;  // of a step that fails

// Part of its velocities that a step changes unusually: from there on its end is looked at, and whether it is on its
// branch.
constexpr double kLooked = 0.02, kSuspect = 0.2;

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
  Status status = step(t);
  x_.t = t;
  double jump = status.ok() && integrates() ? branch_.jump(problem_, v_n_, x_.v, h_) : 0;
  bool settled = false;
  if (settles_ && jump > kLooked) {
    status = settle_end(settled);
    if (settled) jump = branch_.jump(problem_, v_n_, x_.v, h_);
  }
  if (status.ok()) status = measure_rotation(last_seen(), t);
  if (status.ok() && jump > kSuspect) status = check_branch(last_seen());
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

Status FixedSteps::reach_in_halves(double t, bool sampled, int halvings) {
  if (halvings > 0) z_began_ = x_.z;
  const double began = x_.t;
  departs_ = false;
  const Status as_one = reach(t, sampled);
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

// Beyond kTurns turns of a step a branch may be left; within, bodies that whip round are as likely. So they are beyond
// it beside a dead centre, and in steps that turn by more than kFine: such a step is done in parts where that is
// better, and what then is not certain is told. Motions that turn round, or have no velocities where they come to, have
// left it.
Status FixedSteps::check_branch(Problem& problem) {
  constexpr double kComparable = 0.2, kTurns = 2, kFine = 0.1, kReversed = 1.5;
  const double t = x_.t;
  const auto [share, row] = departure(problem, settings_.linear(), {t - h_, q_n_, v_n_}, {t, x_.q, x_.v});
  const bool fine = rotation_ <= kFine, left = fine && share > kReversed;
  if (left || (fine && share > kComparable + kTurns * rotation_ && repeats_ && !as_it_is_)) {
    departs_ = !left;
    return {Failure::singular_position, t,
            fmt::format("at t = {:.9g} s, beside a singular position of the constraints, the step ends on another "
                        "branch than its velocities lead to, by {} most of all; try another step or dop853",
                        t, problem.describe_unknown(row))};
  }
  if (share > kComparable && !std::exchange(doubted_, true)) {
    run_.tell(
        fmt::format("at t = {:.6g} s the velocities that {} allows change by more than the step of {:g} s "
                    "follows: that it ends on the branch they lead to is not certain; try a tenth of it or dop853",
                    t, problem.describe_unknown(row), h_));
  }
  return {};
}

Status FixedSteps::begin() {
  place(problem_);
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
  if (!settled && settles_ && singular_ends_.doubts(*given, v_n_, h_)) {
    given_ = *given;
    if (settle(singular_ends_, problem, v_n_, *given_)) given = &*given_;
  }
  sample(run_.observe, problem, *given, run_.statistics);
  if (given_ && given == &*given_) place(problem);
  clock_.resume();
  return {};
}

// The step that was done, where it ends in a singular position: done again, and then the limit of the states beside.
Status FixedSteps::settle_end(bool& settled) {
  given_ = x_;
  settled = settle(singular_ends_, last_seen(), v_n_, *given_);
  if (!settled) return {};
  if (Status status = repeat_singular(x_.t); !status.ok()) return status;
  settled = settle(singular_ends_, last_seen(), v_n_, x_);
  return {};
}

// The same for where a step begins that leads nowhere.
bool FixedSteps::settles_beginning() {
  if (!settles_ || settled_at_ == x_.t) return false;
  const std::unique_ptr<Problem> problem = last_seen().clone();  // which goes on showing where it stopped
  place(*problem);
  SingularEnds ends(settings_);
  if (!settle(ends, *problem, x_.v, x_)) return false;
  settled_at_ = x_.t;
  return true;
}

bool FixedSteps::settle(SingularEnds& ends, Problem& problem, const Vector& v_n, State& at) {
  if (!ends.settle(problem, v_n, at)) return false;
  if (!std::exchange(told_, true)) {
    run_.tell(fmt::format(
        "at t = {:.6g} s a step ends in a singular position, or so near that rounding decides about velocities or "
        "accelerations: they are the limit of those beside it",
        at.t));
  }
  if (ends.leaves_multipliers_open() && !std::exchange(told_of_multipliers_, true)) {
    run_.tell(
        fmt::format("at t = {:.6g} s the position leaves multipliers open: they are those of a state beside it", at.t));
  }
  return true;
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
