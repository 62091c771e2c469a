#include "linsolve/condition.h"

#include <algorithm>
#include <cmath>

namespace poinsot {

void Condition::resize(int n) {
  for (auto* v : {&d_, &w_, &x_, &next_}) v->assign(static_cast<std::size_t>(n), 0.0);
}

void Condition::start(std::span<const double> scale) {
  std::ranges::fill(d_, 1.0);
  std::ranges::copy(scale, d_.begin());
  random_ = 1;  // the same matrix gets the same estimate every time
}

void Condition::multiply(const CscLayout& layout, std::span<const double> values) {
  std::ranges::fill(w_, 0.0);
  for (std::size_t j = 0; j < d_.size(); ++j)
    for (auto k = static_cast<std::size_t>(layout.start[j]); k < static_cast<std::size_t>(layout.start[j + 1]); ++k)
      w_[static_cast<std::size_t>(layout.row[k])] += std::abs(values[k]) * d_[j];
}

// Sizes differ too, by up to two: two equal rows with equal signs would cancel their own redundancy.
void Condition::randomize() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    random_ = random_ * 6364136223846793005u + 1442695040888963407u;
    const double size = 1 + static_cast<double>(random_ >> 12) * 0x1p-52;
    x_[i] = (random_ >> 11 & 1 ? size : -size) * w_[i];
  }
}

void Condition::collect(bool first) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double size = std::abs(x_[i]);
    next_[i] = first || !(size <= next_[i]) ? size : next_[i];
  }
}

void Condition::find_residual(const CscLayout& layout, std::span<const double> values) {
  std::vector<long double> r(b_.begin(), b_.end());
  for (std::size_t j = 0; j < next_.size(); ++j)
    for (auto k = static_cast<std::size_t>(layout.start[j]); k < static_cast<std::size_t>(layout.start[j + 1]); ++k)
      r[static_cast<std::size_t>(layout.row[k])] -= static_cast<long double>(values[k]) * next_[j];
  std::ranges::transform(r, x_.begin(), [](long double e) { return static_cast<double>(e); });
}

double Condition::size(const std::vector<double>& x) const {
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::abs(x[i]) / d_[i]);
  return most;
}

void Condition::advance(int round) {
  growth_ = 0;
  for (std::size_t i = 0; i < d_.size(); ++i) {
    if (next_[i] == 0) next_[i] = d_[i];  // rounding took it, beside far larger ones
    const double ratio = next_[i] / d_[i];
    if (ratio <= growth_) continue;
    growth_ = std::isfinite(ratio) ? ratio : HUGE_VAL;
    if (round == 0) suspect_ = static_cast<int>(i);
  }
  d_.swap(next_);
}

}  // namespace poinsot
