#include "bench/stability/truths.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace poinsot::stability {

double quarter_period(double k) {
  double a = 1, b = std::sqrt(1 - k * k);
  while (std::abs(a - b) > 4 * std::numeric_limits<double>::epsilon() * a) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / (2 * a);
}

double jacobi_sn(double u, double k) {
  constexpr std::size_t kMost = 16;
  std::array<double, kMost> a{1}, c{k};
  double b = std::sqrt(1 - k * k);
  std::size_t n = 0;
  while (n + 1 < kMost && std::abs(c[n]) > std::numeric_limits<double>::epsilon()) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  return std::sin(phi);
}

Swing swing(double w, double start, double t) {
  const double k = std::sin(start / 2), K = quarter_period(k);
  const double u = std::remainder(w * t, 4 * K);
  const double half = k * jacobi_sn(K + u, k);  // sin(θ/2)
  const double angle = 2 * std::asin(half);
  // θ̇² = 4 w² (k² − sin²(θ/2)); on the way down first.
  const double rate = 2 * w * std::sqrt(std::max(0.0, k * k - half * half)) * (u > 0 && u < 2 * K ? -1 : 1);
  return {angle, rate, -w * w * std::sin(angle)};
}

}  // namespace poinsot::stability
