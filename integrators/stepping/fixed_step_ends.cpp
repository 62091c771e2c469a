// What the end of a fixed step is asked: how far bodies turned, whether it is on its branch, and whether it lies in a
// singular position.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "formulations/registry.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/turning.h"

namespace poinsot {
namespace {

// The step to offer where one of h is too long for bodies that turn at `rate`, rad/s: up to where free rotation is
// right, which is where a method goes on with it. What a step makes of a rotation far beyond the one before it says
// nothing of the motion, and `rate` is that of the one before; a tenth of the step it is in any case.
double step_that_serves(const Settings& settings, const Problem& problem, double h, double most, double rate) {
  constexpr double kWithin = 0.9, kPart = 0.1;
  const Rotations& rotations = integrators().require(settings.integrator).rotations;
  const double wrong = rotations.in(formulations().require(problem.formulation()).space).wrong;
  const double turn = std::min(kWithin * wrong, kPart * std::min(most, std::numbers::pi));
  return std::min(kPart * h, turn / rate);
}

}  // namespace

Status FixedSteps::examine_end(bool& settled) {
  // Part of its velocities that a step changes unusually: from there on it is asked whether its end is a singular
  // position, and whether it is on its branch.
  constexpr double kSingular = 0.02, kLeft = 0.2;
  double jump = integrates() ? branch_.jump(v_n_, x_.v, h_) : 0;
  if (settles_ && (singular_ends_.grow(last_seen(), x_.lambda()) || jump > kSingular)) {
    // It may be that of the rows kept alone, where others are set aside.
    if (chooses_ && !rows_asked_) return {Failure::singular_position, x_.t, {}};
    if (Status status = settle_end(settled); !status.ok()) return status;
    if (settled) jump = branch_.jump(v_n_, x_.v, h_);
  }
  if (Status status = measure_rotation(last_seen(), x_.t); !status.ok()) return status;
  return jump > kLeft ? check_branch(last_seen()) : Status{};
}

void FixedSteps::look_for_jumps() {
  constexpr int kApart = 8;  // steps
  if (jump_told_ || run_.statistics.steps % kApart != 0) return;
  std::swap(sides_, sides_before_);
  jumps_.look(last_seen(), x_, sides_);
  const SpringLaw* const law = jumps_.crossed(sides_before_, sides_);
  if (!law) return;
  jump_told_ = true;
  run_.tell(fmt::format(
      "shortly before t = {:.6g} s the force of {} jumps: steps of fixed length go over it, which costs {} its order "
      "there; an integrator with error control steps onto it",
      x_.t, law->called(problem_.model()), settings_.integrator));
}

Status FixedSteps::measure_rotation(Problem& problem, double t) {
  constexpr double kSudden = 10;
  const double before = std::exchange(rotation_, h_ * problem.fastest_turn());
  if (t == 0) rotation_began_ = rotation_;
  if (rotation_ > run_.most_rotation) {
    const double led_to = t > 0 && rotation_ > kSudden * before ? before : rotation_;
    return rotated_too_far(problem, x_.a(), t, h_, run_.most_rotation, rotation_began_,
                           step_that_serves(settings_, problem, h_, run_.most_rotation, led_to / h_));
  }
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
  return check_moved(problem, change_, t);
}

Status FixedSteps::check_moved(Problem& problem, const Vector& by, double t) {
  problem.set_velocity(span(by));
  const double unexpected = h_ * problem.fastest_turn();
  if (unexpected < kMostUnexpected) {
    problem.set_velocity(span(x_.v));
    return {};
  }
  problem.set_velocity(span(v_n_));
  const double serves = step_that_serves(settings_, problem, h_, run_.most_rotation, problem.fastest_turn());
  problem.set_velocity(span(x_.v));
  return turned_unexpectedly(problem, x_.a(), t, h_, unexpected, serves);
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
  if (left || (fine && share > kComparable + kTurns * rotation_ && repeats_ && on_branch_ != OnBranch::granted)) {
    on_branch_ = left ? OnBranch::asked : OnBranch::doubted;
    return with_settings(
        {Failure::singular_position, t,
         fmt::format("at t = {:.9g} s, beside a singular position of the constraints, the step ends on another "
                     "branch than its velocities lead to, by {} most of all",
                     t, problem.describe_unknown(row))},
        "try another step or dop853");
  }
  if (share > kComparable && !std::exchange(doubted_, true)) {
    run_.tell(
        fmt::format("at t = {:.6g} s the velocities that {} allows change by more than the step of {:g} s "
                    "follows: that it ends on the branch they lead to is not certain; try a tenth of it or dop853",
                    t, problem.describe_unknown(row), h_));
  }
  return {};
}

// Positions have gone with the velocities of the end. Where these are made of rounding because velocity rows (pfaffian)
// depend on one another, no constraint has held them: they go with those of the limit.
bool FixedSteps::settle_step(State& at) {
  Problem& problem = last_seen();
  if (!settle(singular_ends_, problem, v_n_, at)) return false;
  if (!has_velocity_rows_) return true;
  State again = at;
  change_ = 0.5 * h_ * (v_n_ + at.v);
  problem.retract(span(q_n_), span(change_), span(again.q));
  problem.set_position(again.t, span(again.q));
  problem.set_velocity(span(again.v));
  if (settle(singular_ends_, problem, v_n_, again)) std::swap(at, again);
  problem.set_position(at.t, span(at.q));
  problem.set_velocity(span(at.v));
  return true;
}

// The step that was done, where it ends in a singular position: done again, and then the limit of the states beside.
Status FixedSteps::settle_end(bool& settled) {
  given_ = x_;
  settled = settle_step(*given_);
  if (!settled) return {};
  if (Status status = repeat_singular(x_.t); status.failure == Failure::singular_matrix) {
    x_ = *given_;  // the limit of what was done
    return {};
  } else if (!status.ok()) {
    return status;
  }
  settled = settle_step(x_);
  return {};
}

bool FixedSteps::settle(SingularEnds& ends, Problem& problem, const Vector& v_n, State& at) {
  if (!ends.settle(problem, v_n, at)) return false;
  if (!std::exchange(told_, true)) {
    run_.tell(fmt::format(
        "at t = {:.6g} s a step ends in a singular position{}, or so near that rounding decides about velocities or "
        "accelerations: they are the limit of those beside it{}",
        at.t, chooses_ ? " of the rows that are kept" : "",
        has_velocity_rows_ ? "; those of the steps just before and after can be off by more than elsewhere" : ""));
  }
  return true;
}

}  // namespace poinsot
