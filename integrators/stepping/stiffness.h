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
// over so many steps in a row, the part of it has decayed by exp(Σ h λ). Oscillations turn, and their differences with
// them.
#pragma once

#include <cmath>

namespace poinsot {

class StiffnessTest {
 public:
  explicit StiffnessTest(double boundary) : boundary_(boundary) {}

  // A step was accepted, with these estimates of |h λ| and, should λ be real and negative, of −h λ.
  void accepted(double h_lambda, double decay) {
    const bool decays = decay > kReal * h_lambda;
    decaying_ = decays ? decaying_ + 1 : 0;
    decay_ = decays ? decay_ + decay : 0;
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

 private:
  static constexpr int kBeyond = 15, kWithin = 6;
  static constexpr double kReal = 0.9;

  double boundary_;
  int beyond_ = 0, within_ = 0, decaying_ = 0;
  double decay_ = 0;
};

}  // namespace poinsot
