// Whether an explicit method's steps are held by its stability rather than by accuracy.
//
// The last two points an explicit pair comes to are both at t_n + h: g_s, where its last stage stands, and y_{n+1}.
// What f makes of their difference tells the size of the eigenvalue that the difference has turned to,
//
//   |h λ| ≈ h |f(y_{n+1}) − f(g_s)| / |y_{n+1} − g_s|
//
// and the motion is stiff for the pair where that has been beyond the boundary of its domain of stability so many times
// without as many steps in a row within it. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", sec.
// IV.2; boundary and counts are those of their codes DOPRI5 and DOP853. Error control aims at its safety factor times
// the boundary, which is what is compared with.
//
// At tight tolerances steps are short of the boundary, and yet for nothing: the error has terms of the fast part in it
// long after that part has decayed. Where the differences keep to one real eigenvalue λ < 0, seen in their velocities,
//
//   −h λ ≈ −h ⟨Δv', Δv⟩ / ⟨Δv, Δv⟩ ≈ |h λ|
//
// over so many steps in a row, the part of it has decayed by exp(Σ h λ). Differences of an oscillation turn; what keeps
// to one of them, Δv' = −α Δq − β Δv with β² < 4 α, has |h λ|² = h² α and has decayed by exp(−Σ h β/2). α and β are
// fitted to the last few steps, as one alone cannot tell them apart.
#pragma once

#include <algorithm>
#include <cmath>

namespace poinsot {

// Of Δq, Δv and Δv' = Δa, weighted alike.
struct DifferenceProducts {
  double qq = 0, qv = 0, vv = 0, qa = 0, va = 0, aa = 0;
};

class StiffnessTest {
 public:
  explicit StiffnessTest(double boundary) : boundary_(boundary) {}

  // A step of length h was accepted, with this estimate of |h λ| and these products. Δq may be `open`, rounding.
  void accepted(double h, double h_lambda, const DifferenceProducts& p, bool open) {
    const double real = p.vv > 0 ? -h * p.va / p.vv : 0;
    if (!open) swing_ = oscillation(p);
    if (swing_.is_one) {
      h_lambda = h * swing_.w;
      keeps_to_one(std::max(0.5 * h * swing_.beta, 0.0));
    } else if (real > kReal * h_lambda) {
      keeps_to_one(real);
    } else if (!open) {
      decaying_ = 0;
      decay_ = 0;
    }
    if (h_lambda > boundary_) {
      ++beyond_;
      within_ = 0;
    } else if (++within_ == kWithin) {
      beyond_ = 0;
    }
  }
  bool stiff() const { return beyond_ >= kBeyond; }
  // Whether the differences have kept to a part of the motion that is less than this by now.
  bool decayed_below(double rtol) const { return decaying_ >= kBeyond && decay_ > -std::log(rtol); }
  // Likewise over so many steps that it is worth a word.
  bool long_decayed_below(double rtol) const { return decaying_ >= kLong && decayed_below(rtol); }

 private:
  static constexpr int kBeyond = 15, kWithin = 6, kLong = 100;
  static constexpr double kReal = 0.9;
  static constexpr double kRemembered = 0.8;  // of a step at the next one
  static constexpr double kOneOnly = 0.02;    // of |Δa|², what no oscillation has left of it
  static constexpr double kApart = 1e-6;      // of the fit's determinant: below it any of a line of pairs will do

  struct Oscillation {
    bool is_one = false;
    double w = 0, beta = 0;  // w² = α
  };

  // The part they keep to decays by exp(−decay) in a step.
  void keeps_to_one(double decay) {
    ++decaying_;
    decay_ += decay;
  }

  // What the differences keep to.
  Oscillation oscillation(const DifferenceProducts& p) {
    if (!(p.aa > 0)) return {};
    const auto keep = [&](double& sum, double x) { sum = kRemembered * sum + x / p.aa; };
    keep(fit_.qq, p.qq), keep(fit_.qv, p.qv), keep(fit_.vv, p.vv), keep(fit_.qa, p.qa), keep(fit_.va, p.va);
    const double determinant = fit_.qq * fit_.vv - fit_.qv * fit_.qv;
    if (!(determinant > kApart * fit_.qq * fit_.vv)) return {};
    const double alpha = (fit_.qv * fit_.va - fit_.vv * fit_.qa) / determinant;
    const double beta = (fit_.qv * fit_.qa - fit_.qq * fit_.va) / determinant;
    const double left = p.aa + alpha * (alpha * p.qq + 2 * (beta * p.qv + p.qa)) + beta * (beta * p.vv + 2 * p.va);
    if (!(left < kOneOnly * p.aa && beta * beta < 4 * alpha)) return {};
    return {true, std::sqrt(alpha), beta};
  }

  double boundary_;
  int beyond_ = 0, within_ = 0, decaying_ = 0;
  double decay_ = 0;
  Oscillation swing_;  // that differences kept to when Δq was last no rounding
  DifferenceProducts fit_;
};

}  // namespace poinsot
