#include "formulations/spring_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace poinsot {
namespace {

// Gauss's rule with 8 points on [from, to]: exact for polynomials of degree 15 (Abramowitz, Stegun, table 25.4).
struct Gauss {
  double sum = 0;      // ∫ F
  double size = 0;     // ∫ |F|
  double largest = 0;  // |F| at the points

  template <class F>
  Gauss(const F& f, double from, double to) {
    constexpr double kPoints[] = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                  0.960289856497536232};
    constexpr double kWeights[] = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                   0.101228536290376259};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (int k = 0; k < 4; ++k) {
      for (const double at : {middle - half * kPoints[k], middle + half * kPoints[k]}) {
        const double value = f(at);
        sum += half * kWeights[k] * value;
        size += std::abs(half * kWeights[k] * value);
        largest = std::max(largest, std::abs(value));
      }
    }
  }
};

// ∫ F(s, 0, t) ds by halves of what is not yet right, to rounding of the whole or of itself, or where F may come to far
// more between the points than at them: a peak is not passed over, and at a kink only the interval that holds it goes
// on.
class LawIntegral {
 public:
  LawIntegral(const Expression& law, double t) : law_(law), t_(t) {}

  double over(double from, double to) {
    const Gauss whole = gauss(from, to);
    return halved(from, to, whole, kRounding * whole.size, kHalvings);
  }

 private:
  static constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon(), kFar = 4;
  static constexpr int kHalvings = 40, kMostPieces = 20000;

  Gauss gauss(double from, double to) const {
    return {[&](double s) { return law_.law(Arguments<double>{t_, s, 0}).F; }, from, to};
  }
  bool shows(double from, double to, double largest, double allowed) const {
    const double most = law_.range({{t_, t_}, {std::min(from, to), std::max(from, to)}, {0, 0}}).f.size();
    return std::isnan(most) || most <= kFar * largest || most * std::abs(to - from) <= allowed;
  }
  // What is allowed halves with an interval.
  double halved(double from, double to, const Gauss& whole, double allowed, int depth) {
    const double middle = 0.5 * (from + to);
    const Gauss left = gauss(from, middle), right = gauss(middle, to);
    const double enough = std::max(allowed, kRounding * (left.size + right.size));
    const bool right_so_far = !(std::abs(left.sum + right.sum - whole.sum) > enough);
    if (depth == 0 || ++pieces_ > kMostPieces ||
        (right_so_far && shows(from, to, std::max(left.largest, right.largest), enough)))
      return left.sum + right.sum;
    return halved(from, middle, left, allowed / 2, depth - 1) + halved(middle, to, right, allowed / 2, depth - 1);
  }

  const Expression& law_;
  const double t_;
  int pieces_ = 0;
};

}  // namespace

double law_work(const Expression& law, double from, double to, double t) {
  return LawIntegral(law, t).over(from, to);
}

double law_potential(const Expression& law, double x, double t) {
  constexpr double kBeside = 0x1p-40;
  const double side = std::copysign(1.0, x);
  const Bounds zero{std::min(0.0, kBeside * side), std::max(0.0, kBeside * side)};
  const bool bounded =
      law.is_constant() || law.is_function() || std::isfinite(law.range({{t, t}, zero, {0, 0}}).f.size());
  return law_work(law, bounded ? 0 : side, x, t);
}

}  // namespace poinsot
