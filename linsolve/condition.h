// Estimates ‖A⁻¹‖₁ from a few solves: Hager's method as improved by Higham.
//
// Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., Algorithm 15.1 and (15.13). The
// estimate is a lower bound, seldom more than a factor of three below.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "linsolve/csc_layout.h"

namespace poinsot {

class InverseNorm {
 public:
  void resize(int n) {
    x_.resize(static_cast<std::size_t>(n));
    sign_.resize(x_.size());
  }

  // `solve` and `solve_transposed` replace their argument, a span of n numbers, by A⁻¹ and A⁻ᵀ times it. Infinite where
  // the solves overflow.
  template <class Solve, class SolveTransposed>
  double estimate(Solve&& solve, SolveTransposed&& solve_transposed) {
    const std::size_t n = x_.size();
    std::ranges::fill(x_, 1.0 / static_cast<double>(n));
    std::ranges::fill(sign_, 0.0);
    std::size_t last = n;
    double norm = 0;
    for (int iteration = 0; iteration < 5; ++iteration) {
      solve(std::span<double>(x_));
      const double now = sum_of_magnitudes();
      if (!std::isfinite(now)) return HUGE_VAL;
      if (iteration > 0 && now <= norm) break;
      norm = now;
      bool repeated = true;
      for (std::size_t i = 0; i < n; ++i) {
        const double s = std::signbit(x_[i]) ? -1 : 1;
        repeated = repeated && s == sign_[i];
        sign_[i] = x_[i] = s;
      }
      if (repeated) break;
      solve_transposed(std::span<double>(x_));
      std::size_t largest = 0;
      for (std::size_t i = 1; i < n; ++i)
        if (std::abs(x_[i]) > std::abs(x_[largest])) largest = i;
      if (largest == last) break;
      last = largest;
      std::ranges::fill(x_, 0.0);
      x_[largest] = 1;
    }
    // A vector that catches what the iteration may miss.
    for (std::size_t i = 0; i < n; ++i)
      x_[i] = (i % 2 ? -1 : 1) * (1 + static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(n - 1, 1)));
    solve(std::span<double>(x_));
    const double other = 2 * sum_of_magnitudes() / (3 * static_cast<double>(n));
    return std::isfinite(other) ? std::max(norm, other) : HUGE_VAL;
  }

 private:
  double sum_of_magnitudes() const {
    double sum = 0;
    for (const double xi : x_) sum += std::abs(xi);
    return sum;
  }

  std::vector<double> x_, sign_;
};

// Largest column sum of magnitudes.
inline double one_norm(const CscLayout& layout, std::span<const double> values) {
  double largest = 0;
  for (std::size_t j = 0; j + 1 < layout.start.size(); ++j) {
    double sum = 0;
    for (int k = layout.start[j]; k < layout.start[j + 1]; ++k) sum += std::abs(values[static_cast<std::size_t>(k)]);
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace poinsot
