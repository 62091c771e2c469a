#include "core/table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"

namespace poinsot {
namespace {

// M at the points, by elimination in the tridiagonal system
//   h_k-1 M_k-1 + 2 (h_k-1 + h_k) M_k + h_k M_k+1 = 6 ((y_k+1 − y_k)/h_k − (y_k − y_k-1)/h_k-1).
std::vector<double> second_derivatives(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> M(n, 0.0), upper(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = x[k] - x[k - 1], after = x[k + 1] - x[k];
    const double right = 6 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before);
    const double pivot = 2 * (before + after) - before * upper[k - 1];
    upper[k] = after / pivot;
    M[k] = (right - before * M[k - 1]) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 1;) M[k] -= upper[k] * M[k + 1];
  return M;
}

}  // namespace

Spline::Spline(std::string name, std::vector<double> x, const std::vector<double>& y)
    : name_(std::move(name)), x_(std::move(x)) {
  check(x_.size() >= 2 && x_.size() == y.size(), "a table has two points or more");
  const std::vector<double> M = second_derivatives(x_, y);
  for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
    const double h = x_[k + 1] - x_[k];
    check(h > 0, "the points of a table are in order");
    intervals_.push_back(
        {y[k], (y[k + 1] - y[k]) / h - h * (2 * M[k] + M[k + 1]) / 6, M[k] / 2, (M[k + 1] - M[k]) / (6 * h)});
  }
}

bool Spline::covers(double x) const {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  const double slack = kRounding * std::max(std::abs(first()), std::abs(last()));
  return x >= first() - slack && x <= last() + slack;
}

// Linear between the points.
Bounds Spline::second_derivative(double from, double to) const {
  const auto interval = [this](double x) {
    return static_cast<std::size_t>(std::upper_bound(x_.begin() + 1, x_.end() - 1, x) - x_.begin()) - 1;
  };
  Bounds bounds{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t k = interval(from), last = interval(to); k <= last; ++k) {
    for (const double x : {std::max(from, x_[k]), std::min(to, x_[k + 1])}) {
      const double M = 6 * intervals_[k].d * (x - x_[k]) + 2 * intervals_[k].c;
      bounds = {std::min(bounds.least, M), std::max(bounds.most, M)};
    }
  }
  return bounds;
}

template <class T>
Jet2<T> Spline::at(const Jet2<T>& x) const {
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  if (!covers(static_cast<double>(x.f))) return {nan, nan, nan};
  const auto next = std::upper_bound(x_.begin() + 1, x_.end() - 1, x.f);
  const std::size_t k = static_cast<std::size_t>(next - x_.begin()) - 1;
  const T u = x.f - T(x_[k]), a = T(intervals_[k].a), b = T(intervals_[k].b), c = T(intervals_[k].c),
          d = T(intervals_[k].d);
  return compose(x, ((d * u + c) * u + b) * u + a, (3 * d * u + 2 * c) * u + b, 6 * d * u + 2 * c);
}

template Jet2<double> Spline::at(const Jet2<double>&) const;
template Jet2<long double> Spline::at(const Jet2<long double>&) const;

}  // namespace poinsot
