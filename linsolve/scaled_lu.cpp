#include "linsolve/scaled_lu.h"

#include <algorithm>
#include <cmath>

namespace poinsot {
namespace {

constexpr double kDoubtfulPivot = 1e-7;
constexpr double kPivotOfRounding = 1e-11;  // above what rounding leaves of a pivot that should be zero
constexpr double kOutgrown = 1e3;  // a scaled entry beyond this: the scaling of earlier values does not fit any more

}  // namespace

LinearStatus ScaledLu::singular(int unknown) {
  return {LinearFailure::singular, unknown, "the matrix is singular to working precision"};
}

LinearStatus ScaledLu::do_analyze(Pattern&& pattern) {
  scaling_known_ = pivots_known_ = examined_ = false;
  if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
  if (LinearStatus status = layout_.matching(); !status.ok()) return status;
  slots_ = layout_.slots;
  values_.assign(static_cast<std::size_t>(layout_.nonzeros()), 0);
  scaled_.assign(values_.size(), 0);
  equilibration_.resize(layout_.n);
  scaling_before_ = equilibration_;
  condition_.resize(layout_.n);
  statistics_.nonzeros = layout_.nonzeros();
  return do_symbolic();
}

LinearStatus ScaledLu::do_factor() {
  if (scaling_known_) {
    const double largest = equilibration_.scale(layout_, values_, scaled_);
    if (!(largest <= kOutgrown)) scaling_known_ = false;
    if (scaling_known_ && pivots_known_ && do_refactor()) {
      ++statistics_.refactorizations;
      return {};
    }
  }
  pivots_known_ = false;
  LinearStatus status = factor_fresh();
  pivots_known_ = status.ok();
  scaling_known_ = status.ok();
  return status;
}

LinearStatus ScaledLu::factor_fresh() {
  if (!scaling_known_) {
    if (!equilibration_.find(layout_, values_))
      return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    equilibration_.scale(layout_, values_, scaled_);
  }
  if (LinearStatus status = factor_scaled(); !status.ok()) return status;
  if (examined_ && smallest_ >= doubtful_) return {};
  if (scaling_known_) {  // of earlier values
    scaling_known_ = false;
    return factor_fresh();
  }

  int open = suspect();
  double condition = estimate();
  if (!std::isfinite(condition)) {
    // Rounding swallows what is 1e-17 of its neighbours; in another scaling it may not.
    equilibration_.find_by_means(layout_, values_);
    equilibration_.scale(layout_, values_, scaled_);
    if (LinearStatus status = factor_scaled(); !status.ok()) return status;
    condition = estimate();
  }
  if (open < 0) open = condition_.suspect();
  if (std::isfinite(condition) && (smallest_ < kDoubtfulPivot || condition >= kSingularCondition)) {
    // The pivots may have been chosen in a bad scaling; now a better one is known, mostly.
    const double before = condition;
    scaling_before_ = equilibration_;
    equilibration_.improve(condition_.rows(), condition_.columns());
    equilibration_.scale(layout_, values_, scaled_);
    if (LinearStatus status = factor_scaled(); !status.ok()) return status;
    condition = estimate();
    if (before < kSingularCondition && !(condition < kSingularCondition)) {
      equilibration_ = scaling_before_;
      equilibration_.scale(layout_, values_, scaled_);
      if (LinearStatus status = factor_scaled(); !status.ok()) return status;
      condition = before;
    }
  }
  statistics_.reciprocal_condition = 1 / condition;
  if (!(condition < kSingularCondition)) return singular(open);
  examined_ = true;
  doubtful_ = std::clamp(smallest_ / 10, kPivotOfRounding, kDoubtfulPivot);
  return {};
}

LinearStatus ScaledLu::factor_scaled() {
  ++statistics_.factorizations;
  if (LinearStatus status = do_fresh(); !status.ok()) return status;
  smallest_ = HUGE_VAL;
  for (int k = 0; k < layout_.n; ++k) {
    const double size = std::abs(pivot(k));
    if (!(size >= smallest_)) smallest_ = std::isnan(size) ? 0 : size;  // not a number: an earlier pivot was zero
  }
  return {};
}

double ScaledLu::estimate() {
  if (smallest_ == 0) return HUGE_VAL;
  return condition_.estimate(layout_, scaled_, [this](std::span<double> x) { do_substitute(x); });
}

// The column of the first pivot that is nothing but rounding; those after it were made with its inverse.
int ScaledLu::suspect() {
  for (int k = 0; k < layout_.n; ++k)
    if (!(std::abs(pivot(k)) >= kPivotOfRounding)) return pivot_column(k);
  return -1;
}

LinearStatus ScaledLu::do_solve(std::span<double> b) {
  equilibration_.scale_right_hand_side(b);
  do_substitute(b);
  equilibration_.scale_solution(b);
  return {};
}

// With S = D_r A D_c: A⁻¹ = D_c S⁻¹ D_r, A⁻ᵀ = D_r S⁻ᵀ D_c.
LinearStatus ScaledLu::do_solve_transposed(std::span<double> b) {
  equilibration_.scale_solution(b);
  do_substitute_transposed(b);
  equilibration_.scale_right_hand_side(b);
  return {};
}

}  // namespace poinsot
