// A table of a scene: a named function given by points, the natural cubic spline through them.
//
// On the interval from x_k to x_k+1 of length h, with u = x − x_k and M the second derivatives at the points,
//   f = y_k + ((y_k+1 − y_k)/h − h (2 M_k + M_k+1)/6) u + M_k/2 u² + (M_k+1 − M_k)/(6h) u³,
// M from continuity of the first derivative at the inner points, and M = 0 at both ends (C. de Boor, A Practical Guide
// to Splines, chapter IV). f is twice continuously differentiable: a table has no kinks. Beyond its points it has no
// value: what it gives there is not a number, and whoever meets that asks Expression::fault() what it was.
#pragma once

#include <string>
#include <vector>

#include "core/bounds.h"
#include "core/jet.h"

namespace poinsot {

class Spline {
 public:
  // At least two points, finite, x increasing.
  Spline(std::string name, std::vector<double> x, const std::vector<double>& y);

  const std::string& name() const { return name_; }
  double first() const { return x_.front(); }
  double last() const { return x_.back(); }
  // To within rounding, as the times of a run are that end where the table does.
  bool covers(double x) const;
  // Of f and its derivatives over a stretch, as its cubics are written: without what rounding adds.
  Jet2<Bounds> range(double from, double to) const;
  // Which of its cubics holds at x, from 0 on; where it has no value, the first or the last.
  int cubic(double x) const;

  template <class T>  // double, long double
  Jet2<T> at(const Jet2<T>& x) const;

 private:
  struct Interval {  // f = ((d u + c) u + b) u + a, u = x − x_k
    double a, b, c, d;
  };
  std::string name_;
  std::vector<double> x_;
  std::vector<Interval> intervals_;
};

}  // namespace poinsot
