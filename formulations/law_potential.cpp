#include "formulations/law_potential.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace poinsot {
namespace {

// Gauss's rule with 8 points on [from, to]: exact for polynomials of degree 15 (Abramowitz, Stegun, table 25.4).
struct Gauss {
  double sum = 0;      // ∫ F
  double size = 0;     // ∫ |F|
  double largest = 0;  // |F| at the points

  Gauss(const Expression& law, double t, double from, double to) {
    constexpr double kPoints[] = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                  0.960289856497536232};
    constexpr double kWeights[] = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                   0.101228536290376259};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (int k = 0; k < 4; ++k) {
      for (const double x : {middle - half * kPoints[k], middle + half * kPoints[k]}) {
        const double F = law.along(Arguments<Jet2<double>>{{t, 0, 0}, {x, 0, 0}, {0, 0, 0}}).f;
        const double part = half * kWeights[k] * F;
        sum += part;
        size += std::abs(part);
        largest = std::max(largest, std::abs(F));
      }
    }
  }
};

// ∫ F(s, 0, t) ds by halves of what is not yet right, to rounding of the whole or of itself, or where F may come to far
// more between the points than at them: a peak is not passed over, and at a kink only the interval that holds it goes
// on. Where there is more to do than can be done, what is farthest off goes first.
class LawIntegral {
 public:
  LawIntegral(const Expression& law, double t, double part) : law_(law), t_(t), part_(std::max(part, kRounding)) {}

  double over(double from, double to) {
    const Gauss whole(law_, t_, from, to);
    add(from, to, whole, part_ * whole.size, HUGE_VAL);
    for (int pieces = 1; !open_.empty() && pieces < kMostPieces; ++pieces) {
      std::ranges::pop_heap(open_, {}, &Piece::off);
      const Piece piece = std::move(open_.back());
      open_.pop_back();
      const double middle = 0.5 * (piece.from + piece.to);
      add(piece.from, middle, piece.left, piece.allowed / 2, piece.off);
      add(middle, piece.to, piece.right, piece.allowed / 2, piece.off);
    }
    for (const Piece& piece : open_) done_ += piece.left.sum + piece.right.sum;
    return done_;
  }

 private:
  static constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon(), kFar = 4;
  static constexpr int kMostPieces = 20000;

  struct Piece {
    double from, to, allowed, off;
    Gauss left, right;
  };

  // What is allowed halves with an interval; `before` is what the one that was halved was off by.
  void add(double from, double to, const Gauss& whole, double allowed, double before) {
    const double middle = 0.5 * (from + to);
    const Gauss left(law_, t_, from, middle), right(law_, t_, middle, to);
    const double sum = left.sum + right.sum, size = left.size + right.size;
    double enough = std::max(allowed, part_ * size), off = std::abs(sum - whole.sum);
    // Where x is rounded to more than F is, what is left is small and does not become less.
    constexpr double kNearly = 1e-10, kLess = 0.25;
    bool rounded = !(off > enough) || (off <= kNearly * size && off > kLess * before);
    double hidden = most_hidden(from, to, std::max(left.largest, right.largest));
    if (!rounded || hidden > enough) {  // where terms cancel, F is rounded as they are
      enough = std::max(enough, rounding(middle) * std::abs(to - from));
      rounded = rounded || off <= enough;
      if (hidden <= kFar * enough) hidden = 0;
    }
    if ((rounded && hidden <= enough) || middle == from || middle == to) {
      done_ += sum;
      return;
    }
    if (hidden > enough) off = std::max(off, hidden);
    open_.push_back({from, to, allowed, off, left, right});
    std::ranges::push_heap(open_, {}, &Piece::off);
  }
  // What a peak between the points may add; 0 where F cannot come to far more there.
  double most_hidden(double from, double to, double largest) const {
    const double most = law_.range({{t_, t_}, {std::min(from, to), std::max(from, to)}, {0, 0}}).f.size();
    return std::isnan(most) || most <= kFar * largest ? 0 : most * std::abs(to - from);
  }

  // What F is uncertain by at x.
  double rounding(double x) const {
    const Bounds F = law_.range({{t_, t_}, {x, x}, {0, 0}}).f;
    return F.most - F.least > 0 ? F.most - F.least : 0;
  }

  const Expression& law_;
  const double t_, part_;
  std::vector<Piece> open_;  // a heap
  double done_ = 0;
};

// Bits of the ends of parts beside the first; from one end to the next of the last there is a thousandth of x or less.
constexpr int kBits[] = {0, 3, 7, 10};
constexpr std::size_t kMostKnown = 1u << 16;

// Toward 0.
double with_bits(double x, int bits) {
  constexpr int kMantissa = std::numeric_limits<double>::digits - 1;
  const int cut = kMantissa - bits;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) >> cut << cut);
}

}  // namespace

double law_work(const Expression& law, double from, double to, double t, double part) {
  return LawIntegral(law, t, part).over(from, to);
}

double LawPotential::at(double x, double t) {
  if (law_->depends_on_time()) return law_work(*law_, origin(x, t), x, t);
  return up_to(x, std::ssize(kBits));
}

double LawPotential::origin(double x, double t) {
  constexpr double kBeside = 0x1p-40;
  const double side = std::copysign(1.0, x);
  std::optional<bool>& bounded = bounded_[side < 0];
  if (law_->depends_on_time() || !bounded) {
    const Bounds zero{std::min(0.0, kBeside * side), std::max(0.0, kBeside * side)};
    bounded = law_->is_constant() || law_->is_function() || std::isfinite(law_->range({{t, t}, zero, {0, 0}}).f.size());
  }
  return *bounded ? 0 : side;
}

// Level 0 are the powers of two, from where each next one has more bits; x itself is of the last.
double LawPotential::up_to(double x, int level) {
  const bool whole = level < std::ssize(kBits);
  if (whole)
    if (const auto known = known_.find(x); known != known_.end()) return known->second;
  double V = 0;
  if (level == 0) {
    V = law_work(*law_, origin(x, 0), x, 0);
  } else {
    const double before = with_bits(x, kBits[level - 1]);
    V = up_to(before, level - 1);
    if (before != x) V += law_work(*law_, before, x, 0);
  }
  if (whole) {
    if (known_.size() >= kMostKnown) known_.clear();
    known_[x] = V;
  }
  return V;
}

}  // namespace poinsot
