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
#pragma once

namespace poinsot {

class StiffnessTest {
 public:
  explicit StiffnessTest(double boundary) : boundary_(boundary) {}

  // A step was accepted, with this estimate of |h λ|.
  void accepted(double h_lambda) {
    if (h_lambda > boundary_) {
      ++beyond_;
      within_ = 0;
    } else if (++within_ == kWithin) {
      beyond_ = 0;
    }
  }
  bool stiff() const { return beyond_ >= kBeyond; }

 private:
  static constexpr int kBeyond = 15, kWithin = 6;

  double boundary_;
  int beyond_ = 0, within_ = 0;
};

}  // namespace poinsot
