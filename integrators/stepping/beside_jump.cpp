#include "integrators/stepping/beside_jump.h"

#include <cmath>

#include "core/index.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

BesideJump::BesideJump(const Problem& problem, const LinearChoice& choice, const State& state, const SpringLaw& law)
    : own_(problem.clone()),
      consistent_(*own_, choice),
      state_(state),
      law_(law),
      z_(state.z),
      bodies_(index(problem.bodies())) {
  own_->set_position(state.t, span(state.q));
  here_ = arguments(state.v);
  direction_ = direction();
}

double BesideJump::change_beside_v(double by) {
  return change(state_.v + by * direction_);
}

double BesideJump::change_beside_x(double by) {
  Eigen::VectorXd way = by * direction_, q(state_.q.size());
  own_->retract(span(state_.q), span(way), span(q));
  own_->set_position(state_.t, span(q));
  const double changes = change(state_.v);
  own_->set_position(state_.t, span(state_.q));
  return changes;
}

Arguments<double> BesideJump::arguments(const Eigen::VectorXd& v) {
  own_->set_velocity(span(v));
  own_->to_bodies(span(z_).first(index(v.size())), bodies_);
  return law_.arguments(place(), state_.t);
}

double BesideJump::change(const Eigen::VectorXd& v) {
  own_->set_velocity(span(v));
  if (!consistent_.accelerations(state_.t, span(z_)).ok()) return NAN;
  own_->to_bodies(span(z_).first(index(v.size())), bodies_);
  return law_.change(place());
}

Eigen::VectorXd BesideJump::direction() {
  const Eigen::Index nv = state_.v.size();
  Eigen::VectorXd v = state_.v, gradient = Eigen::VectorXd::Zero(state_.z.size());
  for (Eigen::Index k = 0; k < nv; ++k) {
    v[k] += 1;
    gradient[k] = arguments(v).v - here_.v;
    v[k] = state_.v[k];
  }
  Eigen::VectorXd u = gradient;
  own_->set_velocity(span(v));
  if (!consistent_.factor(state_.t).ok() || !consistent_.solve(state_.t, span(u)).ok()) return {};
  const double moved = gradient.head(nv).dot(u.head(nv));
  if (!(moved > 0)) return {};
  return u.head(nv) / moved;
}

}  // namespace poinsot
