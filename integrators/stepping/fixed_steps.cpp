#include "integrators/stepping/fixed_steps.h"

#include <fmt/format.h>

#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/energy_balance.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

constexpr int kStillSteps = 4;  // from one look at whether the motion rests to the next: a rest is many steps long

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
      has_alternates_(has_alternates(run.problem.model())),
      has_velocity_rows_(!velocity_rows(run.problem).empty()),
      chooses_(run.problem.model_rows().size() < run.problem.model().rows.size()),
      branch_(run.problem),
      jump_(first_jump(run.problem.model(), run.settings.end)),
      driver_jumps_(run.problem.model(), run.settings.end),
      rests_(run.problem),
      gaps_(run.problem, run.settings, run.tell),
      still_(run.problem, run.tell),
      damping_(run),
      singular_ends_(run.problem, run.settings),
      passed_(run.problem.model(), run.settings.end, run.tell),
      turned_(run.problem.model(), run.tell),
      struck_(run.problem.model(), run.tell),
      jumps_(run.problem.model()),
      sides_(jumps_.sides()),
      sides_before_(sides_),
      output_(run.settings) {}

Status FixedSteps::march() {
  if (Status status = prepare(); !status.ok()) return status;
  Status status = begin();
  if (integrates()) place(problem_);  // a beginning may have looked ahead
  if (status.ok()) status = measure_rotation(problem_, 0);
  settles_ = settings_.retry && integrates();
  if (integrates()) gaps_.begin(problem_, x_);
  branch_.begin(x_.a());
  if (integrates() && passed_.due(h_)) passed_.look(problem_, x_, h_);
  if (status.ok() && integrates() && turned_.due(h_)) status = turned_.look(problem_, x_, h_);
  jumps_.look(problem_, x_, sides_);
  if (run_.singular_for > 0) start_ = Start::limit;
  if (phase_error().vibration != 0) coarse_.emplace(run_, phase_error());
  if (coarse_ && coarse_->none()) coarse_.reset();
  divides_ = settings_.retry && divides();
  repeats_ = divides_ && !remembers();
  for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
    if (interruption_requested) {
      status = interrupted(x_.t);
      break;
    }
    if (grid_.time(n) > jump_.after) {
      status = jump_of_positions(jump_.after, describe_row(problem_.model(), jump_.row));
      break;
    }
    if (!driver_jumps_.none()) status = driver_jumps_.look(grid_.time(n));
    if (!status.ok()) break;
    const bool sampled = grid_.sampled(n);
    const std::int64_t before = run_.statistics.steps;
    status = advance(grid_.time(n), sampled);
    if (run_.statistics.steps > before + 1) ++run_.statistics.divided_steps;
    if (status.ok() && damps()) damping_.look(last_seen(), x_);
    if (status.ok() && coarse_) coarse_->look(last_seen(), x_);
    if (status.ok() && run_.energy && run_.energy->due()) run_.energy->look(last_seen(), x_.t, x_.v);
    if (n % kStillSteps == 0 && status.ok() && integrates()) still_.look(problem_, x_);
    if (status.ok() && integrates() && rests_.due()) status = rests_.look(problem_, settings_.linear(), x_);
    if (status.ok() && integrates() && gaps_.due(rotation_, x_.v, h_)) status = gaps_.look(last_seen(), x_);
    if (status.ok() && sampled) status = give_out(*standing_);
  }
  if (status.ok() && integrates()) status = gaps_.end(last_seen(), x_);
  finish(clock_, run_.statistics);
  if (status.ok() && damps()) damping_.say(run_, h_);
  if (status.ok() && coarse_) coarse_->say(run_, h_);
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
  if (start_ != Start::usual) {
    if (Status status = start_ == Start::limit ? leave_singular() : resume(); !status.ok()) return status;
  }
  q_n_.swap(x_.q);
  v_n_.swap(x_.v);
  x_.multipliers_open = false;
  Status status;
  if (led_)
    go_to(*led_);
  else
    status = step(t);
  x_.t = t;
  bool settled = false;
  if (status.ok()) status = examine_end(settled);
  thrown_ = false;
  if (status.ok() && integrates() && turned_.due(h_)) {
    status = turned_.look(last_seen(), x_, h_);
    thrown_ = !status.ok();
  }
  if (!status.ok()) {
    x_.t = began;
    x_.q.swap(q_n_);
    x_.v.swap(v_n_);
    return status;
  }
  branch_.follow();
  if (integrates() && passed_.due(h_)) passed_.look(last_seen(), x_, h_);
  if (!struck_.none() && integrates() && struck_.due(x_.v, v_n_)) struck_.look(last_seen(), x_, q_n_, v_n_, h_);
  if (integrates() && !jumps_.none()) look_for_jumps();
  start_ = settled ? Start::limit : led_ ? Start::rewritten : Start::usual;
  began_anew_ = std::exchange(anew_, start_ != Start::usual);
  rows_asked_ = false;
  ++run_.statistics.steps;
  const bool due = discrete_ || (has_alternates_ && last_seen().exchanges_rows());
  if (!sampled && (!due || last_seen().accepts_as_is(t, x_.a()))) return {};
  standing_ = &stand();
  return due ? accept(*standing_) : Status{};
}

Status FixedSteps::begin() {
  place(problem_);
  if (run_.singular_for == 0) (void)singular_ends_.grow(problem_, x_.lambda());
  sample(run_.observe, problem_, x_, run_.statistics);
  clock_.start();
  return {};
}

Status FixedSteps::give_out(Problem& problem) {
  const bool settled = start_ == Start::limit;
  if (Status status = settled ? Status{} : complete(); !status.ok()) return status;
  const bool last = x_.t >= settings_.end;
  const double scale = index3_scale();
  clock_.pause();  // what is computed for the output alone is no part of a step
  if (last) run_.systems.let_go();
  const State* given = &x_;
  if (!settled && scale > 0)
    given = &output_.choose(problem, x_, scale, last, began_anew_ && backward_velocities() ? &z_began_ : nullptr,
                            run_.statistics);
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
  bool rewritten = false;
  Status status = poinsot::accept(problem, x_, rewritten);
  if (rewritten) rewrite();
  return status;
}

}  // namespace poinsot
