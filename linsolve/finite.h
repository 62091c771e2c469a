// Whether all of many numbers are finite.
#pragma once

#include <cstddef>
#include <span>

namespace poinsot {

inline bool all_finite(std::span<const double> x) {
  // x · 0 is NaN for an infinity and for NaN, and a sum keeps it: no branch in the loop, and sums that do not wait for
  // one another.
  constexpr std::size_t kWide = 8;
  double sum = 0;
  std::size_t i = 0;
  if (x.size() >= kWide) {
    double sums[kWide] = {};
    for (; i + kWide <= x.size(); i += kWide)
      for (std::size_t lane = 0; lane < kWide; ++lane) sums[lane] += x[i + lane] * 0;
    for (const double lane : sums) sum += lane;
  }
  for (; i < x.size(); ++i) sum += x[i] * 0;
  return sum == 0;
}

}  // namespace poinsot
