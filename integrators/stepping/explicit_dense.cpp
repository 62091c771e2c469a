// The motion within a completed step of an explicit pair.
#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

Status ExplicitStepper::prepare_dense() {
  for (std::size_t i = 0; i < pair_.dense_stages.size(); ++i) {
    const Stage& stage = pair_.dense_stages[i];
    advance(h_, stage.a, y_);
    sample_.t = t_n_ + stage.c * h_;
    if (Status status = evaluate(sample_, y_, last_ + 1 + static_cast<Eigen::Index>(i)); !status.ok()) return status;
  }
  const auto sum = [&](Terms terms, auto&& column) {
    column.setZero();
    for (const Term& term : terms) column += (h_ * term.weight) * k_.col(term.stage);
  };
  sum(pair_.b, r_.col(0));
  r_.col(1) = h_ * k_.col(0) - r_.col(0);
  r_.col(2) = 2 * r_.col(0) - h_ * (k_.col(0) + k_.col(last_));
  for (std::size_t i = 0; i < pair_.dense.size(); ++i) sum(pair_.dense[i], r_.col(3 + static_cast<Eigen::Index>(i)));
  dense_ = Dense::ready;
  return {};
}

Status ExplicitStepper::interpolate(double t) {
  elsewhere_ = true;
  if (dense_ != Dense::too_coarse) {
    if (Status status = by_polynomial(t); status.ok() || status.failure == Failure::singular_position) return status;
  }
  dense_ = Dense::too_coarse;
  return by_short_step(t);
}

Status ExplicitStepper::by_polynomial(double t) {
  if (dense_ == Dense::missing) {
    if (Status status = prepare_dense(); !status.ok()) return status;
  }
  const double s = (t - t_n_) / h_;
  combined_.setZero();
  for (Eigen::Index i = r_.cols(); i-- > 0;) combined_ = (i % 2 == 0 ? s : 1 - s) * (r_.col(i) + combined_);
  sample_.t = t;
  sample_.v = y_n_.tail(problem_.nv()) + combined_.tail(problem_.nv());
  problem_.retract(span(q_n_), std::span<const double>(span(combined_)).first(nv_), span(sample_.q));
  return passage_.complete_sample(sample_);
}

Status ExplicitStepper::by_short_step(double t) {
  if (Status status = run_through_stages(t, sample_); !status.ok()) return status;
  sample_.v = y_.tail(problem_.nv());
  problem_.retract(span(q_n_), span(y_).first(nv_), span(sample_.q));
  return passage_.complete_sample(sample_);
}

}  // namespace poinsot
