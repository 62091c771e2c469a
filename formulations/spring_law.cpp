#include "formulations/spring_law.h"

#include <cmath>
#include <limits>

namespace poinsot {
namespace {

// Gauss's rule with 8 points on [from, to]: exact for polynomials of degree 15 (Abramowitz, Stegun, table 25.4).
template <class F>
double gauss(const F& f, double from, double to) {
  constexpr double kPoints[] = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740, 0.960289856497536232};
  constexpr double kWeights[] = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                 0.101228536290376259};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += kWeights[k] * (f(middle - half * kPoints[k]) + f(middle + half * kPoints[k]));
  return half * sum;
}

// Halves what is not yet right to `allowed`, which halves with it: at a kink only the interval that holds it goes on.
template <class F>
double halved(const F& f, double from, double to, double whole, double allowed, int depth) {
  const double middle = 0.5 * (from + to), left = gauss(f, from, middle), right = gauss(f, middle, to);
  const double missing = std::abs(left + right - whole);
  if (!(missing > allowed) || depth == 0) return left + right;
  return halved(f, from, middle, left, allowed / 2, depth - 1) + halved(f, middle, to, right, allowed / 2, depth - 1);
}

}  // namespace

double law_potential(const Expression& law, double x, double t) {
  constexpr double kSlack = 16 * std::numeric_limits<double>::epsilon();
  constexpr int kHalvings = 40;
  const auto force = [&](double s) { return law.law(Arguments<double>{t, s, 0}).F; };
  const auto size = [&](double s) { return std::abs(force(s)); };
  return halved(force, 0, x, gauss(force, 0, x), kSlack * std::abs(gauss(size, 0, x)), kHalvings);
}

}  // namespace poinsot
