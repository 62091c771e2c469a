// Arithmetic of intervals: every result holds what the operation gives for any values of its arguments, widened by what
// rounding adds. What could be anything is everything; what is unknown, no number at either end, stays unknown.
#pragma once

#include <cmath>
#include <limits>

#include "core/jet.h"

namespace poinsot {

struct Bounds {
  double least = 0, most = 0;

  static constexpr Bounds all() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  static constexpr Bounds unknown() {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  bool is_unknown() const { return std::isnan(least); }
  // Zero among others.
  bool straddles_zero() const { return least <= 0 && most >= 0 && !(least == 0 && most == 0); }
  double size() const { return std::fmax(std::abs(least), std::abs(most)); }
};

Bounds widened(double least, double most);
Bounds hull(Bounds x, Bounds y);

Bounds operator+(Bounds x, Bounds y);
Bounds operator-(Bounds x, Bounds y);
Bounds operator-(Bounds x);
Bounds operator*(Bounds x, Bounds y);
Bounds operator*(double c, Bounds x);
Bounds reciprocal(Bounds x);
Bounds square(Bounds x);
Bounds magnitude(Bounds x);

Bounds sine(Bounds x);
Bounds cosine(Bounds x);
Bounds power(Bounds x, double n);
Bounds power(Bounds x, Bounds y);

// Of a function that rises throughout.
template <class F>
Bounds rising(Bounds x, F f) {
  return widened(f(x.least), f(x.most));
}

}  // namespace poinsot
