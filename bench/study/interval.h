// The median of repeated measurements, and how well they determine it.
//
// Between the k-th smallest and the k-th largest of n values lies the median of what they are drawn from with
// probability 1 − 2 P(B < k), B binomial (n, 1/2), whatever the distribution (David and Nagaraja, Order Statistics,
// section 7.1). Taken is the largest k with at least the confidence asked for, or all the values where they are too few
// for it; the probability is told.
#pragma once

#include <vector>

namespace poinsot::study {

inline constexpr double kConfidence = 0.95;
inline constexpr double kDecisive = 0.9;  // below it, of fewer than five values, an interval decides nothing

struct Interval {
  double median = 0, low = 0, high = 0;
  double confidence = 0;  // 0 of a single value

  bool contains(double x) const { return low <= x && x <= high; }
  bool decides() const { return confidence >= kDecisive; }
  // The median, beyond the noise.
  bool above(double x) const { return decides() && low > x; }
  bool below(double x) const { return decides() && high < x; }
};

// At least one value.
Interval median_interval(std::vector<double> values, double confidence = kConfidence);

}  // namespace poinsot::study
