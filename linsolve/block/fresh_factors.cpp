#include "linsolve/block/fresh_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linsolve/block/cancellation.h"
#include "linsolve/condition.h"

namespace poinsot::block {
namespace {

// Part of its size that is left of a pivot. Of 16 digits 10 remain at the first, which refinement makes good, though
// another order may do without; at the second no more than 6, of which refinement may converge to anything.
constexpr double kCancelled = 1e-6, kRounding = 1e-10;
constexpr double kSingularPivot = 1 / kSingularCondition;

}  // namespace

Pivots FreshFactors::factor(const Schedule& schedule) {
  const auto cancelled = [&](std::span<const double> weight, double part) {
    return cancelled_pivots(schedule, values_, weight, part);
  };
  Cancelled found = cancelled(first_, kRounding);
  // Solutions need not tell what is nothing but rounding, and looking at them takes as long as all else.
  const bool trusted = found.least > kSingularPivot && trustworthy(schedule);
  if (!trusted)
    found = cancelled(first_, kCancelled);
  else if (!std::ranges::equal(weight_, first_))
    found = cancelled(weight_, kRounding);  // above, they may pass for pivots, as of very different masses
  bad_ = std::move(found.pivots);
  if (!trusted) return Pivots::bad;
  if (found.least > kCancelled) return Pivots::good;
  look_at_ = std::max(look_at_, LookAt::some);
  if (bad_.empty()) return Pivots::good;
  look_at_ = LookAt::all;
  return cancelled(weight_, kSingularPivot).pivots.empty() ? Pivots::doubtful : Pivots::bad;
}

bool FreshFactors::trustworthy(const Schedule& schedule) {
  const std::span<const double> rows = refinement_.rows();
  Condition condition;
  condition.resize(layout_.n);
  std::vector<double> x(rows.size());  // sizes of the unknowns, then a solution
  double size = 0;
  std::int64_t corrections = 0;
  const auto solve = [&](std::span<double> b) { factor_.solve(schedule, b); };
  const auto looking = [&](std::span<double> b) {
    refinement_.begin(b);
    solve(b);
    size = std::max(size, refinement_.residual(b));
  };
  const auto serves = [&](bool last) {
    factor_.weigh_rows(schedule, weight_);
    (void)factor_.factor(schedule, values_, false);
    size = 0;
    const double estimate = condition.estimate(layout_, values_, looking, x);
    reciprocal_condition_ = 1 / estimate;
    if (!std::isfinite(estimate)) return false;
    std::ranges::transform(rows, x.begin(), [](double row) { return 1 / row; });
    looking(x);
    look_at_ = size <= kSmallResidual ? LookAt::none : size <= kLargeResidual ? LookAt::some : LookAt::all;
    return estimate < kSingularCondition &&
           (size <= kFairResidual || (last && refinement_.refine(x, good_, corrections, solve) <= kLargeResidual));
  };
  const auto begin_with = [&](std::span<const double> weight) {
    weight_.assign(weight.begin(), weight.end());
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = refinement_.column(j);
  };
  begin_with(first_);
  if (serves(false)) return true;
  if (first_.data() != rows.data()) {
    begin_with(rows);
    if (serves(false)) return true;
  }
  if (!(reciprocal_condition_ > 0)) return false;
  std::ranges::transform(condition.rows(), weight_.begin(), [](double w) { return 1 / w; });
  std::ranges::copy(condition.columns(), x.begin());
  return serves(true);
}

}  // namespace poinsot::block
