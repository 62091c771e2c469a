// A step that fails, done again from where it began. What is tried, until one of it leads on:
//   other rows      once for where a step begins: what is kept may depend on one another where the step leads to
//   parts           the two halves, each a step of its own that may fail in turn, down to h/2^10
//   over a jump     the last of them, where a law of a spring jumps in it, by accelerations as they are (law_jumps.h):
//                   for that alone methods are divided, too, that otherwise are not
//   as it is        the step whose branch was in doubt, where parts did no better: it stands, and the doubt is told
//   the beginning   is made the limit of states beside it, where it is a singular position; then all of this once more
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/singular_position.h"

namespace poinsot {
namespace {

constexpr int kHalvings = 10;

// What the size of a step has a part in.
bool may_be_too_long(Failure failure) {
  return failure == Failure::not_converged || failure == Failure::not_finite || failure == Failure::singular_matrix ||
         failure == Failure::singular_position;
}

// Parts of a step creep up to a singular position, where a whole step goes over it: there rounding may choose the
// branch, and velocities jump. Those of a step worth its name change by a fraction, as accelerations beside such a
// position do not.
bool velocities_jump(std::span<const BodyState> before, std::span<const BodyState> after) {
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

Status FixedSteps::advance(double t, bool sampled) {
  const double began = x_.t;
  const Status status = reach_or_redo(t, sampled, kHalvings);
  if (!may_be_too_long(status.failure) || x_.t > began || !settles_beginning()) return status;
  return reach_or_redo(t, sampled, kHalvings);
}

Status FixedSteps::reach_or_redo(double t, bool sampled, int halvings) {
  if (divides_ || chooses_ || jumps_.steps_may_fail() || anew_) z_began_ = x_.z;
  const double began = x_.t;
  const auto failed = [&](const Status& status) { return may_be_too_long(status.failure) && x_.t == began; };
  on_branch_ = OnBranch::asked;
  Status status = reach(t, sampled);
  if (failed(status) && status.failure != Failure::not_finite && chooses_ && !std::exchange(rows_asked_, true)) {
    if (Status back = take_back(); !back.ok()) return back;
    const bool others = choose_rows();
    if (others) {
      rewrite();
      z_began_ = x_.z;
    }
    if (others || status.message.empty()) status = reach(t, sampled);
  }
  if (!failed(status)) return status;
  if (!divides_ && halvings == kHalvings && !goes_over_jump(status, t)) return status;
  if (halvings == 0) return reach_over_jump(t, sampled, std::move(status));
  const double half = began + 0.5 * (t - began);
  if (!(began < half && half < t) || !take_back().ok()) return status;
  return halvings == kHalvings ? redo_whole(t, half, sampled, std::move(status))
                               : reach_in_halves(t, half, sampled, halvings);
}

// A step of the grid, which as one ended as it did.
Status FixedSteps::redo_whole(double t, double half, bool sampled, Status as_one) {
  const bool doubted = on_branch_ == OnBranch::doubted, thrown = thrown_;
  const Beginning beginning{x_, start_, rows_asked_, shortest_, run_.statistics.steps};
  const std::vector<BodyState> before = bodies();
  const LawJumps::Sides sides = sides_of_jumps();
  over_jumps_ = false;
  Status status = reach_in_halves(t, half, sampled, kHalvings);
  const auto forced = [&] { return thrown || over_jumps_ || jumps_.crossed(sides, sides_of_jumps()); };
  if (status.ok() && velocities_jump(before, bodies()) && !forced()) {
    begin_from(beginning);
    status = std::move(as_one);
  }
  if (status.ok()) tell_parts_beside_singular(beginning.x, t);
  if (status.ok() || !doubted) return status;
  begin_from(beginning);
  shortest_ = beginning.shortest;
  run_.statistics.steps = beginning.steps;
  if (!take_back().ok()) return status;
  on_branch_ = OnBranch::granted;
  return reach(t, sampled);
}

// Parts creep up to a singular position, where branches cross: the way back onto one is not seen in any of them.
void FixedSteps::tell_parts_beside_singular(const State& from, double t) {
  constexpr std::size_t kMostBodies = 100;
  if (branch_told_ || problem_.model().bodies.size() > kMostBodies) return;
  const std::unique_ptr<Problem> own = last_seen().clone();
  Vector ahead = (t - from.t) * from.v, q(from.q.size());
  own->retract(span(from.q), span(ahead), span(q));
  const int rows = static_cast<int>(own->model_rows().size());
  if (near_singular_position(*own, rows, span(run_.state.q), t, span(q)).sentence.empty()) return;
  branch_told_ = true;
  run_.tell(
      fmt::format("the step to t = {:.6g} s, beside a singular position of the constraints, failed as a whole and was "
                  "done in parts: that it ends on the branch it came by is not certain; try another step or dop853",
                  t));
}

// Where an implicit step to t has no solution, because the force of either side of a jump leads to the other.
bool FixedSteps::goes_over_jump(const Status& failed, double t) {
  if (!settings_.retry || !jumps_.steps_may_fail() || !integrates() || failed.failure != Failure::not_converged)
    return false;
  return take_back().ok() && comes_to_jump(jumps_, last_seen(), settings_.linear(), x_, t);
}

Status FixedSteps::reach_over_jump(double t, bool sampled, Status failed) {
  if (!goes_over_jump(failed, t)) return failed;
  led_ = x_;
  Status status = lead_on(last_seen(), settings_.linear(), *led_, t);
  status = status.ok() ? reach(t, sampled) : std::move(failed);
  led_.reset();
  return status;
}

void FixedSteps::go_to(const State& led) {
  over_jumps_ = true;
  x_ = led;
  place(last_seen());
}

LawJumps::Sides FixedSteps::sides_of_jumps() {
  LawJumps::Sides sides = jumps_.sides();
  jumps_.look(stand(), x_, sides);
  return sides;
}

void FixedSteps::begin_from(const Beginning& beginning) {
  x_ = beginning.x;
  z_began_ = x_.z;
  start_ = beginning.start;
  rows_asked_ = beginning.rows_asked;
}

Status FixedSteps::reach_in_halves(double t, double half, bool sampled, int halvings) {
  const double h = h_;
  set_step(0.5 * h);
  Status status = reach_or_redo(half, false, halvings - 1);
  if (status.ok()) status = reach_or_redo(t, sampled, halvings - 1);
  shortest_ = shortest_ > 0 ? std::min(shortest_, 0.5 * h) : 0.5 * h;
  set_step(h);
  return status;
}

// Of the rows or coordinates of where the next step begins.
void FixedSteps::rewrite() {
  if (start_ == Start::usual) start_ = Start::rewritten;
  anew_ = true;
  rests_.forget();
  gaps_.rewritten();
}

// After a step that failed, which left position and velocity as they were: x_ and the method stand where it began.
Status FixedSteps::take_back() {
  x_.z = z_began_;
  if (start_ == Start::limit) return {};
  start_ = Start::usual;
  return forget();
}

// Where the step leads to the rows that are kept may depend on one another: looks whether others do not.
bool FixedSteps::choose_rows() {
  Vector ahead = h_ * x_.v, q(x_.q.size());
  Problem& problem = last_seen();
  problem.retract(span(x_.q), span(ahead), span(q));
  problem.set_position(x_.t + h_, span(q));
  return problem.choose_rows_here(x_.t, span(x_.q), span(x_.v), x_.lambda());
}

// The same for where a step begins that leads nowhere.
bool FixedSteps::settles_beginning() {
  if (!settles_ || start_ == Start::limit) return false;
  const std::unique_ptr<Problem> problem = last_seen().clone();  // which goes on showing where it stopped
  place(*problem);
  SingularEnds ends(problem_, settings_);
  if (!settle(ends, *problem, x_.v, x_)) return false;
  start_ = Start::limit;
  anew_ = true;
  return true;
}

std::vector<BodyState> FixedSteps::bodies() {
  std::vector<BodyState> states(index(problem_.bodies()));
  stand().to_bodies(x_.a(), states);
  return states;
}

void FixedSteps::set_step(double h) {
  const double before = std::exchange(h_, h);
  resize(before);
  anew_ = true;
}

}  // namespace poinsot
