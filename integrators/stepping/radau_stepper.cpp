#include "integrators/stepping/radau_stepper.h"

#include <algorithm>
#include <cmath>

#include "integrators/stepping/accept.h"
#include "integrators/stepping/radau_tableau.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
using radau::tableau;
using radau::Tableau;

// The error estimate has order 3, the method 5: with the same tolerance for both, errors would be far smaller than
// asked for. Hairer's code asks the estimate for 0.1 rtol^(2/3).
RadauStepper::RadauStepper(Problem& problem, LinearSystems& systems, double rtol, double atol, Statistics& statistics,
                           PhaseClock& clock)
    : problem_(problem),
      system_(problem, systems.add(Workload::solves), statistics, clock),
      filter_(problem, systems.add(), statistics, clock),
      consistent_(problem, systems.add(Workload::solves), statistics, clock),
      passage_(problem, consistent_),
      gap_(problem, consistent_),
      step_(problem),
      within_(problem),
      rtol_(0.1 * std::pow(rtol, 2.0 / 3)),
      atol_(atol / rtol * rtol_),
      nv_(problem.nv()),
      n_(problem.nv() + problem.nc()),
      statistics_(statistics),
      revision_(problem.revision()),
      state_(problem),
      next_(problem),
      sample_(problem),
      before_(problem),
      stage_(problem),
      norm_(problem) {
  for (Columns* x : {&Z_, &Z_before_, &R_}) x->setZero(n_, 3);
  for (Columns* x : {&V_, &dQ_, &V_old_, &dQ_old_, &rates_}) x->setZero(nv_, 3);
  for (Vector* x : {&sizes_, &sizes_next_, &scale_, &change_, &e_}) x->setZero(2 * nv_);
  filtered_.setZero(n_);
}

Status RadauStepper::start(const State& state) {
  state_ = state;
  h_before_ = step_.h = 0;
  return settle();
}

Status RadauStepper::settle() {
  consistent_.stand(state_);
  bool rewritten = false;
  if (Status status = accept(problem_, state_, rewritten); !status.ok()) return status;
  if (rewritten) forget();
  if (problem_.revision() != revision_) {  // also by others that step with the same problem
    forget();
    if (Status status = take_rows(); !status.ok()) return status;
  }
  if (!fast_) step_.h = 0;
  counted_ = problem_.counted_turn().rate;
  component_sizes(problem_, span(state_.q), span(state_.v), span(sizes_));
  return {};
}

bool RadauStepper::choose_rows() {
  consistent_.stand(state_);
  if (!problem_.choose_rows_here(state_.t, span(state_.q), span(state_.v), state_.lambda())) return false;
  forget();
  return take_rows().ok();
}

// The stages, which are those of other coordinates or rows.
void RadauStepper::forget() {
  h_before_ = step_.h = 0;
  convergence_ = 1;
  consistent_.forget_approach();
}

Status RadauStepper::take_rows() {
  revision_ = problem_.revision();
  step_ = Linearized(problem_), within_ = Linearized(problem_);
  in_solver_ = nullptr;
  if (Status status = prepare(); !status.ok()) return status;
  passage_.stand_on_rows(state_);
  return {};
}

Status RadauStepper::cross(double t) {
  sample_ = state_;
  if (Status status = consistent_.cross(state_, t); !status.ok()) {
    std::swap(state_, sample_);
    return status;
  }
  h_before_ = step_.h = 0;  // the stages are those of other forces
  return settle();
}

bool RadauStepper::cross_singular(Before from, double t, double& singular_for) {
  const State& before = from == Before::step ? before_ : state_;
  singular_for = from == Before::step && !(before.t < state_.t)
                     ? 0
                     : cross_singular_switch(problem_, consistent_, before, t, rtol_, sample_);
  if (singular_for == 0) return false;
  std::swap(state_, sample_);
  h_before_ = step_.h = 0;  // the stages are those of other forces
  if (settle().ok()) return true;
  std::swap(state_, sample_);
  return false;
}

double RadauStepper::first_step(double end) const {
  double y = 0, f = 0;
  for (Eigen::Index k = 0; k < nv_; ++k) {
    const double q = atol_ + rtol_ * sizes_[k], v = atol_ + rtol_ * sizes_[nv_ + k];
    y += std::pow(sizes_[k] / q, 2) + std::pow(sizes_[nv_ + k] / v, 2);
    f += std::pow(state_.v[k] / q, 2) + std::pow(state_.z[k] / v, 2);
  }
  return first_trial(std::sqrt(y), std::sqrt(f), end - state_.t);
}

Status RadauStepper::attempt(double to, double& error) {
  h_ = to - state_.t;
  if (Status status = stages(state_, to, step_); !status.ok()) return status;
  if (h_ * counted_ >= kMostCounted || turns_too_far(problem_, h_)) {  // it stands at the last stage
    return {Failure::rotation_too_large, to, {}};
  }
  end_of_step(state_, to, next_);
  set_scale(state_, next_.q, next_.v);
  return error_of(state_, h_, error);
}

void RadauStepper::end_of_step(const State& from, double to, State& at) {
  at.t = to;
  at.v = V_.col(2);
  at.z = Z_.col(2);
  problem_.retract(span(from.q), column(dQ_, 2), span(at.q));
}

// x = (1 − hμ J)⁻¹ e, e = hμ f(y_n) + μ Σ e_i (y_i − y_n), J linearized at the first stage.
Status RadauStepper::error_of(const State& from, double h, double& error) {
  const Tableau& m = tableau();
  const double hmu = h * m.mu;
  e_.head(nv_) = hmu * from.v + m.mu * dQ_.lazyProduct(m.e);
  e_.tail(nv_) = hmu * from.z.head(nv_) + m.mu * (V_.lazyProduct(m.e) - m.e.sum() * from.v);
  change_.head(nv_) = e_.head(nv_) + hmu * e_.tail(nv_);
  filtered_.setZero();
  step_.at[0].add_forces(span(e_, nv_, nv_), span(change_, 0, nv_), span(filtered_, 0, nv_));
  if (Status status = filter_.solve(from.t, span(filtered_)); !status.ok()) return status;
  e_.tail(nv_) -= hmu * filtered_.head(nv_);
  e_.head(nv_) += hmu * e_.tail(nv_);
  error = norm_(span(e_), span(scale_));
  return {};
}

Status RadauStepper::complete(double& error, double most) {
  if (Status status = passage_.complete(next_); !status.ok()) return status;
  const double shift = norm_(passage_.moved_by(), span(scale_));
  if (shift > std::max(error, kOfAccount)) consistent_.look(consistent_.steepness(next_.t));
  error = std::max(error, consistent_.error_in(next_, passage_.moved_by(), shift, passage_.settled()));
  if (!(error <= most)) return {};
  if (consistent_.leaves_branch(next_) || gap_.goes_over(state_, next_, passage_.settled()))
    return {Failure::singular_position, next_.t, {}};
  consistent_.follow(next_);
  gap_.follow(next_, passage_.settled());
  before_ = state_;
  std::swap(state_, next_);
  Z_before_ = Z_;
  h_before_ = h_;
  return {};
}

Status RadauStepper::lead(double t) {
  sample_ = state_;
  consistent_.lead(sample_, t);
  return passage_.complete_sample(sample_);
}

const State& RadauStepper::trial_end() {
  consistent_.stand(next_);
  return next_;
}

void RadauStepper::take_back() {
  state_ = before_;
  consistent_.forget_approach();  // and with it what NarrowGap has of the end that was taken back
  h_before_ = 0;
}

Status RadauStepper::interpolate(double t) {
  within_.h = 0;
  const bool fast = fast_;
  const double convergence = convergence_;
  if (!stages(before_, t, within_).ok()) predict(before_, t - before_.t);  // the polynomial of the completed step
  fast_ = fast;
  convergence_ = convergence;
  end_of_step(before_, t, sample_);
  return passage_.complete_sample(sample_);
}

}  // namespace poinsot
