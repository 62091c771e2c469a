#include "core/bounds.h"

#include <algorithm>
#include <numbers>

namespace poinsot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kLargest = std::numeric_limits<double>::max();
constexpr double kFunctionRounding = 4 * std::numeric_limits<double>::epsilon();  // rounding, relative

}  // namespace

// Exact results are rounded; those of functions by more. What is not a number could be anything.
Bounds widened(double least, double most) {
  if (!(least <= most)) return Bounds::all();
  least = std::min(least, kLargest), most = std::max(most, -kLargest);
  return {least - kFunctionRounding * std::abs(least), most + kFunctionRounding * std::abs(most)};
}

Bounds hull(Bounds x, Bounds y) {
  return {std::min(x.least, y.least), std::max(x.most, y.most)};
}

Bounds operator+(Bounds x, Bounds y) {
  return widened(x.least + y.least, x.most + y.most);
}

Bounds operator-(Bounds x, Bounds y) {
  return widened(x.least - y.most, x.most - y.least);
}

Bounds operator-(Bounds x) {
  return {-x.most, -x.least};
}

Bounds operator*(Bounds x, Bounds y) {
  double least = kInfinity, most = -kInfinity;
  for (const double a : {x.least, x.most}) {
    for (const double b : {y.least, y.most}) {
      const double ab = a == 0 || b == 0 ? 0 : a * b;
      least = std::min(least, ab), most = std::max(most, ab);
    }
  }
  return widened(least, most);
}

Bounds operator*(double c, Bounds x) {
  return Bounds{c, c} * x;
}

Bounds reciprocal(Bounds x) {
  return x.least > 0 || x.most < 0 ? widened(1 / x.most, 1 / x.least) : Bounds::all();
}

Bounds square(Bounds x) {
  return power(x, 2);
}

Bounds magnitude(Bounds x) {
  return {x.least <= 0 && x.most >= 0 ? 0 : std::min(std::abs(x.least), std::abs(x.most)), x.size()};
}

Bounds sine(Bounds x) {
  constexpr double turn = 2 * std::numbers::pi;
  if (!(x.most - x.least < turn) || !(std::abs(x.least) < 1e8)) return {-1, 1};
  const double slack = kFunctionRounding * (1 + std::abs(x.least) + std::abs(x.most));
  const auto passes = [&](double peak) {  // up to rounding
    return peak + turn * std::ceil((x.least - slack - peak) / turn) <= x.most + slack;
  };
  const auto [least, most] = std::minmax({std::sin(x.least), std::sin(x.most)});
  return {passes(-std::numbers::pi / 2) ? -1 : least - slack, passes(std::numbers::pi / 2) ? 1 : most + slack};
}

Bounds cosine(Bounds x) {  // a quarter turn on
  return sine({x.least + std::numbers::pi / 2, x.most + std::numbers::pi / 2});
}

Bounds power(Bounds x, double n) {
  if (n < 0) return reciprocal(power(x, -n));
  const auto to_n = [n](double a) { return std::pow(a, n); };
  if (n != std::floor(n)) return x.most < 0 ? Bounds::all() : rising({std::max(x.least, 0.0), x.most}, to_n);
  return std::fmod(n, 2) == 0 ? rising(magnitude(x), to_n) : rising(x, to_n);
}

Bounds power(Bounds x, Bounds y) {  // exp(y log x)
  if (!(x.least > 0)) return Bounds::all();
  const Bounds exponent = y * rising(x, [](double a) { return std::log(a); });
  return rising(exponent, [](double a) { return std::exp(a); });
}

}  // namespace poinsot
