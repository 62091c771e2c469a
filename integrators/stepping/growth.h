// Steps whose forces are explicit in the position grow without bound where a spring moves faster than they see: beyond
// h w = 2 its free motion changes its sign in every step and gets larger. So do the changes of the velocity, which is
// looked for: steps in a row, each of whose changes is against the one before and larger.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>

#include "integrators/integrator.h"

namespace poinsot {

class Growth {
 public:
  explicit Growth(Eigen::Index nv) : change_(Eigen::VectorXd::Zero(nv)), next_(nv) {}

  // A step of length h to t took v_n to v. Tells it once.
  void watch(const Run& run, const Eigen::VectorXd& v, const Eigen::VectorXd& v_n, double t, double h) {
    if (told_) return;
    next_ = v - v_n;
    const double square = next_.squaredNorm();
    const bool grows = next_.dot(change_) < 0 && square > kGrows * square_ && square > kNoise * v.squaredNorm();
    in_a_row_ = grows ? in_a_row_ + 1 : 0;
    change_.swap(next_);
    square_ = square;
    if (in_a_row_ < kTold) return;
    told_ = true;
    run.tell(fmt::format(
        "at t = {:.6g} s velocities change to and fro from step to step, the {}th time by more: a spring or damper "
        "moves "
        "faster than h = {:g} s can follow where forces are taken at the start of a step, and what is computed "
        "grows without bound; try integrator radau5 or generalized_alpha, or a smaller step",
        t, kTold, h));
  }

 private:
  static constexpr int kTold = 6;
  static constexpr double kGrows = 1.2, kNoise = 1e-12;  // of squares
  Eigen::VectorXd change_, next_;
  double square_ = 0;
  int in_a_row_ = 0;
  bool told_ = false;
};

}  // namespace poinsot
