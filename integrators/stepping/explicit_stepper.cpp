#include "integrators/stepping/explicit_stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "integrators/stepping/accept.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr double kNoise =
    100 * std::numeric_limits<double>::epsilon();  // relative: what rounding makes of a difference

Eigen::Index columns(const RungeKuttaPair& pair) {
  return static_cast<Eigen::Index>(pair.stages.size() + 1 + pair.dense_stages.size());
}

// y = x + h Σ weight k, a few numbers at a time, which stay in registers for all terms.
void add_up(const Eigen::VectorXd& x, double h, Terms terms, const Eigen::MatrixXd& k, Eigen::VectorXd& y) {
  constexpr Eigen::Index kTogether = 8;
  Eigen::Index i = 0;
  for (; i + kTogether <= y.size(); i += kTogether) {
    Eigen::Array<double, kTogether, 1> sum = x.segment<kTogether>(i);
    for (const Term& term : terms) sum += (h * term.weight) * k.col(term.stage).segment<kTogether>(i).array();
    y.segment<kTogether>(i) = sum;
  }
  for (; i < y.size(); ++i) {
    y[i] = x[i];
    for (const Term& term : terms) y[i] += (h * term.weight) * k(i, term.stage);
  }
}

}  // namespace

ExplicitStepper::ExplicitStepper(const RungeKuttaPair& pair, Problem& problem, LinearSystems& systems, double rtol,
                                 double atol, Statistics& statistics, PhaseClock& clock)
    : pair_(pair),
      problem_(problem),
      consistent_(problem, systems.add(Workload::solves), statistics, clock),
      passage_(problem, consistent_),
      gap_(problem, consistent_),
      rtol_(rtol),
      atol_(atol),
      nv_(static_cast<std::size_t>(problem.nv())),
      last_(static_cast<Eigen::Index>(pair.stages.size())),
      error_needs_last_(std::ranges::any_of(pair.error, [&](const Term& term) { return term.stage == last_; })),
      revision_(problem.revision()),
      state_(problem),
      next_(problem),
      sample_(problem),
      norm_(problem),
      stiffness_(pair.rule.safety * pair.stability) {
  const Eigen::Index nv = problem.nv();
  q_n_.setZero(problem.nq());
  for (Vector* x : {&zeros_, &y_n_, &y_, &g_, &sizes_, &sizes_next_, &scale_, &combined_}) x->setZero(2 * nv);
  k_.setZero(2 * nv, columns(pair));
  r_.setZero(2 * nv, static_cast<Eigen::Index>(3 + pair.dense.size()));
}

Status ExplicitStepper::start(const State& state) {
  consistent_.forget_approach();
  state_ = state;
  elsewhere_ = true;
  stiffness_ = StiffnessTest(pair_.rule.safety * pair_.stability);
  return settle();
}

Status ExplicitStepper::settle() {
  if (elsewhere_ || !problem_.accepts_as_is(state_.t, state_.a())) {
    consistent_.stand(state_);
    bool rewritten = false;
    if (Status status = accept(problem_, state_, rewritten); !status.ok()) return status;
    if (rewritten) consistent_.forget_approach();
  }
  elsewhere_ = false;
  if (std::exchange(revision_, problem_.revision()) != problem_.revision()) passage_.stand_on_rows(state_);
  component_sizes(problem_, span(state_.q), span(state_.v), span(sizes_));
  return {};
}

bool ExplicitStepper::choose_rows() {
  consistent_.stand(state_);
  if (!problem_.choose_rows_here(state_.t, span(state_.q), span(state_.v), state_.lambda())) return false;
  consistent_.forget_approach();
  revision_ = problem_.revision();
  passage_.stand_on_rows(state_);
  return true;
}

Status ExplicitStepper::cross(double t) {
  elsewhere_ = true;
  sample_ = state_;
  if (Status status = consistent_.cross(state_, t); !status.ok()) {
    std::swap(state_, sample_);
    return status;
  }
  return settle();
}

bool ExplicitStepper::cross_singular(Before from, double t, double& singular_for) {
  const State& before = from == Before::step ? next_ : state_;
  singular_for = from == Before::step && !(before.t < state_.t)
                     ? 0
                     : cross_singular_switch(problem_, consistent_, before, t, rtol_, sample_);
  if (singular_for == 0) return false;
  elsewhere_ = true;
  std::swap(state_, sample_);
  if (settle().ok()) return true;
  std::swap(state_, sample_);
  return false;
}

void ExplicitStepper::advance(double h, Terms terms, Vector& y) const {
  add_up(y_n_, h, terms, k_, y);
}

// Of projected stages, without what the projection at the end of the step takes out.
Status ExplicitStepper::norm(Terms terms, double& size) {
  add_up(zeros_, 1, terms, k_, combined_);
  if (project_stages_) {
    for (const std::span<double> part : {span(combined_).first(nv_), span(combined_).subspan(nv_)})
      if (Status status = consistent_.along_constraints(next_, part); !status.ok()) return status;
  }
  size = norm_(span(combined_), span(scale_));
  return {};
}

// Stands at y, or at the point of the constraints beside it; writes position, velocity and (a, λ) there into `at`, f
// into column k.
Status ExplicitStepper::evaluate(State& at, const Vector& y, Eigen::Index k) {
  const Eigen::Index nv = problem_.nv();
  at.v = y.tail(nv);
  problem_.retract(span(q_n_), span(y).first(nv_), span(at.q));
  const Status accelerated = consistent_.accelerations(at);
  if (!accelerated.ok() && !project_stages_) return accelerated;
  if (turns_too_far(problem_, h_)) return {Failure::rotation_too_large, at.t, {}};
  settled_ = at.multipliers_open = false;
  if (project_stages_) {
    if (Status status = passage_.settle(at, accelerated.ok(), settled_); !status.ok()) return status;
    if (!settled_) {
      bool moved = false;
      if (Status status = consistent_.project(at, moved); !status.ok()) return status;
      if (Status status = consistent_.accelerations(at); !status.ok()) return status;
    }
  }
  k_.col(k).head(nv) = at.v;
  problem_.lower(span(y).first(nv_), {k_.col(k).data(), nv_});
  k_.col(k).tail(nv) = at.z.head(nv);
  return {};
}

Status ExplicitStepper::first_step(double end, double& h) {
  const double t = state_.t;
  scale_.array() = atol_ + rtol_ * sizes_.array();
  combined_ << state_.v, state_.z.head(problem_.nv());
  const double y = norm_(span(sizes_), span(scale_)), f = norm_(span(combined_), span(scale_));
  const double h0 = first_trial(y, f, end - t);

  q_n_ = state_.q;
  y_n_ << Vector::Zero(problem_.nv()), state_.v;
  y_.noalias() = y_n_ + h0 * combined_;
  next_.t = t + h0;
  Status status = evaluate(next_, y_, 1);
  if (status.ok()) {
    combined_ = (k_.col(1) - combined_) / h0;
    const double second = norm_(span(combined_), span(scale_));
    h = std::isfinite(second) ? poinsot::first_step(h0, f, second, pair_.order, end - t) : h0;
  }
  elsewhere_ = true;
  return status;
}

// y_{n+1} of a step from the point (t_n, q_n, y_n) with f in column 0.
Status ExplicitStepper::run_through_stages(double to, State& at) {
  const double h = to - t_n_;
  for (std::size_t i = 1; i < pair_.stages.size(); ++i) {
    const Stage& stage = pair_.stages[i];
    advance(h, stage.a, y_);
    at.t = stage.c == 1 ? to : t_n_ + stage.c * h;
    if (Status status = evaluate(at, y_, static_cast<Eigen::Index>(i)); !status.ok()) return status;
  }
  g_ = y_;
  advance(h, pair_.b, y_);
  at.t = to;
  return {};
}

// After f(y_{n+1}). A difference that is rounding, or was projected, says nothing; nor does one of a step that turns a
// body by so much that no method's could be much longer: next to nothing swings fast about a steady rotation.
void ExplicitStepper::test_stiffness() {
  constexpr double kTurned = 1;  // rad
  if (project_stages_ || h_ * problem_.fastest_turn() > kTurned) return;
  combined_ = y_ - g_;
  const double apart = norm_(span(combined_), span(scale_));
  if (!(apart * rtol_ > kNoise)) return;
  const auto nv = static_cast<Eigen::Index>(nv_);
  const auto scaled = [&](auto&& x) { return x.tail(nv).array() / scale_.tail(nv).array(); };
  const double size = scaled(combined_).square().sum();
  const double along = (scaled(k_.col(last_) - k_.col(last_ - 1)) * scaled(combined_)).sum();
  combined_ = k_.col(last_) - k_.col(last_ - 1);
  stiffness_.accepted(h_ * norm_(span(combined_), span(scale_)) / apart, size > 0 ? -h_ * along / size : 0);
}

Status ExplicitStepper::attempt(double to, Stages stages, double& error) {
  const Eigen::Index nv = problem_.nv();
  project_stages_ = stages == Stages::projected;
  dense_ = Dense::missing;
  elsewhere_ = true;
  t_n_ = state_.t;
  h_ = to - t_n_;
  q_n_ = state_.q;
  y_n_.head(nv).setZero();
  y_n_.tail(nv) = state_.v;
  k_.col(0) << state_.v, state_.z.head(nv);
  if (Status status = run_through_stages(to, next_); !status.ok()) return status;
  if (end_is_evaluated()) {
    if (Status status = evaluate(next_, y_, last_); !status.ok()) return status;
  } else {
    stand_at_end();
  }
  component_sizes(problem_, span(next_.q), span(next_.v), span(sizes_next_));
  scale_.array() = atol_ + rtol_ * sizes_.array().max(sizes_next_.array());
  if (Status status = norm(pair_.error, error); !status.ok()) return status;
  error *= h_;
  if (pair_.third_order_error.empty() || !(error > 0)) return {};
  double third = 0;
  if (Status status = norm(pair_.third_order_error, third); !status.ok()) return status;
  error *= error / std::hypot(error, 0.1 * h_ * third);
  return {};
}

// y_{n+1} as position and velocity.
void ExplicitStepper::stand_at_end() {
  next_.v = y_.tail(problem_.nv());
  problem_.retract(span(q_n_), span(y_).first(nv_), span(next_.q));
}

// Beside a singular position, where the projection moves the end by too much, it is the limit of states beside or does
// not count what rounding moves; and where the limit moves it by too much though it is not that near, it is projected.
Status ExplicitStepper::project_end(double& error, double most) {
  constexpr double kCreeps = 1e-5;  // rad
  const auto count = [&](double shift) {
    error = std::max(error, shift);
    if (settled_ || !(error <= most)) return Status{};
    return consistent_.amplification() > 1 ? consistent_.accelerations(next_) : consistent_.refine(next_);
  };
  const auto shift = [&](std::span<const double> by) { return norm_(by, span(scale_)); };
  bool moved = false;
  if (settled_) {
    const double part = consistent_.error_in(next_, passage_.moved_by(), shift(passage_.moved_by()), true);
    const bool creeps = h_ * problem_.fastest_turn() < kCreeps;
    if (part <= most || creeps || consistent_.amplification() > 1) return count(part);
    settled_ = false;
    stand_at_end();
    if (Status status = consistent_.accelerations(next_); !status.ok()) return status;
  }
  Status status = consistent_.project(next_, moved);
  if (status.ok() && !moved) return {};
  if (status.ok()) {
    const double by = shift(consistent_.moved_by());
    if (by > std::max(error, kOfAccount)) consistent_.look(consistent_.steepness(next_.t));
    if (const double part = consistent_.error_in(next_, consistent_.moved_by(), by); part <= most) return count(part);
  }
  stand_at_end();
  if (status = passage_.settle(next_, consistent_.accelerations(next_).ok(), settled_); !status.ok()) return status;
  if (!settled_) {
    if (status = consistent_.project(next_, moved); !status.ok()) return status;
  }
  return count(consistent_.error_in(next_, passage_.moved_by(), shift(passage_.moved_by()), settled_));
}

// Whether f at the end is what the stage at the same time has, but for less than the velocities. An error estimate
// that does not see f at the end says nothing where a stiff stop lies between the two.
bool ExplicitStepper::ends_agree() {
  if (project_stages_) return true;
  combined_ = k_.col(last_) - k_.col(last_ - 1);
  return !(h_ * norm_(span(combined_), span(scale_)) * rtol_ > 1);
}

Status ExplicitStepper::examine(double& error, double most) {
  constexpr double kTooLarge = 2;
  if (!end_is_evaluated()) {
    if (Status status = evaluate(next_, y_, last_); !status.ok()) return status;
  }
  if (!ends_agree()) {
    error = kTooLarge * most;
    return {};
  }
  if (Status status = project_end(error, most); !status.ok() || !(error <= most)) return status;
  if (consistent_.leaves_branch(next_) || gap_.goes_over(state_, next_, settled_))
    return {Failure::singular_position, next_.t, {}};
  return {};
}

void ExplicitStepper::keep() {
  consistent_.follow(next_);
  gap_.follow(next_, settled_);
  test_stiffness();
  std::swap(state_, next_);
  elsewhere_ = false;
}

bool ExplicitStepper::comes_by_singular() {
  consistent_.look(consistent_.steepness(next_.t));
  return beside_singular();
}

Status ExplicitStepper::complete(double& error, double most) {
  const Status status = examine(error, most);
  if (status.ok() && error <= most) keep();
  return status;
}

Status ExplicitStepper::lead(double t) {
  elsewhere_ = true;
  sample_ = state_;
  consistent_.lead(sample_, t);
  return passage_.complete_sample(sample_);
}

const State& ExplicitStepper::trial_end() {
  stand_at_end();
  consistent_.stand(next_);
  return next_;
}

void ExplicitStepper::take_back() {
  std::swap(state_, next_);
  consistent_.forget_approach();  // and with it what NarrowGap has of the end that was taken back
  elsewhere_ = true;
}

}  // namespace poinsot
