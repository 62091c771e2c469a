// LDLᵀ of the Schur complement over the bodies:
//
//   [ K  Gᵀ ] [ a ]   [ f ]
//   [ G  0  ] [ λ ] = [ γ ]      S = G K⁻¹ Gᵀ,   S λ = G K⁻¹ f − γ,   a = K⁻¹ (f − Gᵀ λ)
//
// K is one small block for each body, in rp with its normalization row; S is symmetric positive definite where K is
// (rp: on the velocities the normalization allows). That holds for the matrices `consistent` and `simplified`, though
// not for rA's in a step, where the tangent of the retraction makes K unsymmetric, and not for `exact` ones. They are
// refused: what the structure shows at analyze(), what takes numbers at factor(). Every solution is checked by its
// residual and refined. Measured (linear_solver_bench, consistent matrices in rp and reps): 0.5 to 0.6 of klu's speed
// on chains, 0.9 to 1.1 on ladders, a third on one body; it is here to compare with, auto never picks it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "linsolve/back_ends.h"
#include "linsolve/condition.h"
#include "linsolve/equilibration.h"
#include "linsolve/finite.h"
#include "linsolve/residual.h"
#include "linsolve/schur_bodies.h"

namespace poinsot {
namespace {

constexpr double kDrift = 10;  // change of pivots after which the condition is examined again
constexpr double kSmallResidual = 2e-15, kLargeResidual = 1e-13;  // relative: refined above, not accepted above
constexpr double kRounding = 2e-14;  // part of a diagonal entry of S: a pivot that is no more is nothing but rounding
constexpr int kRefinements = 10;

class Schur final : public LinearSolver {
 private:
  LinearStatus do_analyze(const Pattern& pattern) override {
    examined_ = false;
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    slots_ = std::exchange(layout_.slots, {});
    values_.assign(static_cast<std::size_t>(layout_.nonzeros()), 0);
    if (LinearStatus status = bodies_.analyze(layout_, pattern.node, complement_); !status.ok()) return status;
    now_.assign(bodies_.determinants().size() + complement_.pivots().size(), 0);
    then_ = now_;
    statistics_.nonzeros = layout_.nonzeros();
    statistics_.factor_nonzeros = bodies_.nonzeros() + complement_.nonzeros();
    return {};
  }

  LinearStatus do_factor() override {
    if (!all_finite(values_)) return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    if (LinearStatus status = bodies_.eliminate(values_, complement_); !status.ok()) return status;
    complement_.factor();
    const auto rest = std::ranges::copy(bodies_.determinants(), now_.begin()).out;
    std::ranges::copy(complement_.pivots(), rest);
    bool kept = examined_;
    for (std::size_t k = 0; k < now_.size(); ++k) {
      const double now = std::abs(now_[k]), then = std::abs(then_[k]);
      kept = kept && now * kDrift >= then && now <= then * kDrift;
    }
    if (!kept) return examine();
    ++statistics_.refactorizations;
    return {};
  }

  LinearStatus examine() {
    ++statistics_.factorizations;
    examined_ = false;
    Equilibration equilibration;
    equilibration.resize(layout_.n);
    (void)equilibration.find(layout_, values_);
    residual_.measure_by(equilibration.row(), equilibration.col());
    Condition condition;
    condition.resize(layout_.n);
    const double estimate = condition.estimate(
        layout_, values_, [&](std::span<double> b) { bodies_.substitute(complement_, b); }, equilibration.col());
    statistics_.reciprocal_condition = 1 / estimate;
    const int cancelled = complement_.cancelled(kRounding);
    if (cancelled >= 0 || !(estimate < kSingularCondition))
      return {LinearFailure::singular, cancelled >= 0 ? bodies_.unknown_of(cancelled) : condition.suspect(),
              "the matrix is singular to working precision"};
    std::swap(then_, now_);
    examined_ = true;
    return {};
  }

  LinearStatus do_solve(std::span<double> b) override {
    b_.assign(b.begin(), b.end());
    bodies_.substitute(complement_, b);
    double size = residual_.size(layout_, values_, b_, b);
    for (int k = 0; k < kRefinements && size > kSmallResidual; ++k) {
      const std::span<double> r = residual_.vector();
      bodies_.substitute(complement_, r);
      for (std::size_t i = 0; i < b.size(); ++i) b[i] += r[i];
      size = residual_.size(layout_, values_, b_, b);
    }
    if (size <= kLargeResidual) return {};
    if (!std::isfinite(size)) return {LinearFailure::not_finite, -1, "the solution of the linear system is not finite"};
    return {LinearFailure::refused, -1, "linear solver schur does not reach a small residual; klu takes this matrix"};
  }

  CscLayout layout_;
  SchurBodies bodies_;
  SparseLdlt complement_;
  Residual residual_;
  std::vector<double> then_, now_;  // determinants of bodies and pivots of S: when last examined, and now
  std::vector<double> b_;
  bool examined_ = false;
};

}  // namespace

std::unique_ptr<LinearSolver> make_schur() {
  return std::make_unique<Schur>();
}

}  // namespace poinsot
