// Broyden's good method over a matrix that stays factored: what the matrix lacks is learnt from the corrections.
//
//   B₀ s = −F(z) is solved outside; improve() turns s into the correction of B_k, where
//   B_{k+1} = B_k + F(z_{k+1}) s_kᵀW/(s_kᵀW s_k), so that B_{k+1} s_k = F(z_{k+1}) − F(z_k)
//
// W takes the first `weighted` unknowns only: the residual's dependence on the others is exact in B₀. Source: Kelley,
// Iterative Methods for Linear and Nonlinear Equations, sec. 7.3.
//
// SUNDIALS, the library at hand, has no such method. What it is worth: the heavy top's steps of 1 ms take 6.0 in the
// place of 10.0 iterations with half_implicit, 5.0 in the place of 9.0 with rattle (rA, tolerance 1e-10); on planar
// mechanisms, whose matrix lacks little, nothing.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace poinsot {

class Broyden {
 public:
  Broyden(Eigen::Index unknowns, Eigen::Index weighted)
      : weighted_(weighted), steps_(unknowns, kMemory), square_(kMemory) {}

  void restart() { count_ = 0; }

  void improve(Eigen::VectorXd& s) {
    for (Eigen::Index j = 0; j + 1 < count_; ++j) s += (product(j, s) / square_[j]) * steps_.col(j + 1);
    if (count_ > 0) {
      const double left = 1 - product(count_ - 1, s) / square_[count_ - 1];
      if (std::abs(left) > kSmall) {
        s /= left;
      } else {
        restart();
      }
    }
    const double square = s.head(weighted_).squaredNorm();
    if (count_ == kMemory || !(square > 0) || !std::isfinite(square)) return restart();
    steps_.col(count_) = s;
    square_[count_++] = square;
  }

 private:
  static constexpr Eigen::Index kMemory = 12;
  static constexpr double kSmall = 0.05;  // a correction lengthened twentyfold is not trusted

  double product(Eigen::Index j, const Eigen::VectorXd& s) const {
    return steps_.col(j).head(weighted_).dot(s.head(weighted_));
  }

  Eigen::Index weighted_, count_ = 0;
  Eigen::MatrixXd steps_;
  Eigen::VectorXd square_;
};

}  // namespace poinsot
