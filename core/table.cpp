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

int Spline::cubic(double x) const {
  return static_cast<int>(std::upper_bound(x_.begin() + 1, x_.end() - 1, x) - x_.begin()) - 1;
}

// A polynomial stays within its Bézier points.
Jet2<Bounds> Spline::range(double from, double to) const {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr Bounds none{inf, -inf};
  Jet2<Bounds> range{none, none, none};
  const std::size_t first = static_cast<std::size_t>(cubic(from)), last = static_cast<std::size_t>(cubic(to));
  for (std::size_t k = first; k <= last; ++k) {
    const Interval& p = intervals_[k];
    const double u = k == first ? from - x_[k] : 0;
    const double h = (k == last ? to : x_[k + 1]) - x_[k] - u;
    const double f = ((p.d * u + p.c) * u + p.b) * u + p.a, fd = (3 * p.d * u + 2 * p.c) * u + p.b;
    const double fdd = 6 * p.d * u + 2 * p.c, fddd = 6 * p.d;
    const auto hull_of = [](Bounds& held, std::initializer_list<double> points) {
      held = {std::min(held.least, std::min(points)), std::max(held.most, std::max(points))};
    };
    hull_of(range.f,
            {f, f + h * fd / 3, f + h * (2 * fd / 3 + h * fdd / 6), f + h * (fd + h * (fdd / 2 + h * fddd / 6))});
    hull_of(range.fd, {fd, fd + h * fdd / 2, fd + h * (fdd + h * fddd / 2)});
    hull_of(range.fdd, {fdd, fdd + h * fddd});
  }
  return range;
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
