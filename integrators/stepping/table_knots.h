// Where a function goes on by another cubic of a table: f‴ jumps there, which estimates of the error of high order make
// little of. Steps end there, where it matters.
//
// A jump J of f‴, by the part s of a step, at a distance w from the next such place or end of the step to either side
// leaves f off what a polynomial through it comes to by some |J| w³/48, which evens out, as (4 w)², where there are
// many in a step: a table with points far closer than steps are long is smooth for them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/model.h"

namespace poinsot {

// The first such place of a step, s from 0 to 1, at which f is off by more than `nothing`; 1 if there is none.
// cubics(s, out) says which cubics hold there, slope(s) is df/ds.
template <class Cubics, class Slope>
double first_knot(const Cubics& cubics, const Slope& slope, double nothing) {
  constexpr int kLooks = 8, kKnots = 6, kHalvings = 30;
  constexpr double kBeyond = 1e-9, kJump = 48, kMany = 0.25;
  using Held = std::array<int, 4>;  // by the first tables of a function; few have more than one
  const auto held = [&](double s) {
    Held out{};
    cubics(s, out);
    return out;
  };
  const auto next = [&](double from) {
    const Held here = held(from + kBeyond);
    const double part = (1 - from) / kLooks;
    for (int k = 1; k <= kLooks; ++k) {
      double before = from + (k - 1) * part, after = k == kLooks ? 1 : from + k * part;
      if (held(after) == here) continue;
      for (int n = 0; n < kHalvings; ++n) {
        const double middle = before + 0.5 * (after - before);
        (held(middle) == here ? before : after) = middle;
      }
      return after;
    }
    return 1.0;
  };
  double last = 0, knot = next(0);
  for (int k = 0; k < kKnots && knot < 1; ++k) {
    const double following = next(knot), w = std::min(knot - last, following - knot), d = 0.25 * w;
    const double there = slope(knot);
    const auto third = [&](double by) { return (slope(knot + 2 * by) - 2 * slope(knot + by) + there) / (by * by); };
    const double evened = std::min(w / kMany, 1.0), weight = w * w * w * evened * evened;
    if (std::abs(third(d) - third(-d)) * weight > kJump * nothing) return knot;
    last = std::exchange(knot, following);
  }
  return 1;
}

// Of forces and torques that are functions of time. What drivers prescribe holds however long steps are.
class TableKnots {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  TableKnots(const Model& model, double end, double rtol);

  // How far a step from t to `to` may go.
  double reach(double t, double to) const;

 private:
  struct Function {
    const Expression* f;
    double nothing;  // what of it does not matter
  };
  std::vector<Function> functions_;
};

}  // namespace poinsot
