// Straight lines by least squares: y = intercept + slope x; with logarithms of both, powers y = c xᵏ.
#pragma once

#include <span>

#include "bench/study/range.h"

namespace poinsot::study {

struct Line {
  double slope = 0, intercept = 0;
};

// At least two different x.
Line fit_line(std::span<const double> x, std::span<const double> y);

// The exponent k, all numbers positive, and those between neighbours.
struct Power {
  double exponent = 0;
  Range neighbours = {};
};
Power fit_power(std::span<const double> x, std::span<const double> y);

}  // namespace poinsot::study
