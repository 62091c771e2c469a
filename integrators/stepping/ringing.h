// Accelerations that turn round and change by more than their size within a step, step after step, are not those of the
// motion. Those of an oscillation that the steps resolve turn round now and then.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/integrator.h"

namespace poinsot {

class Ringing {
 public:
  // A step of length h to (t, q) took the accelerations at the head of z_n to those of z. Tells it once.
  void watch(const Run& run, const Eigen::VectorXd& z, const Eigen::VectorXd& z_n, const Eigen::VectorXd& q, double t,
             double h) {
    if (in_a_row_ >= kTold) return;
    double change = 0, before = 0, along = 0;
    for (Eigen::Index k = 0; k < run.problem.nv(); ++k) {
      change += std::pow(z[k] - z_n[k], 2);
      before += std::pow(z_n[k], 2);
      along += z[k] * z_n[k];
    }
    const bool rings = along < 0 && change >= before && h * h * std::sqrt(change) >= kRounding * q.norm();
    in_a_row_ = rings ? in_a_row_ + 1 : std::max(in_a_row_ - 1, 0);
    if (in_a_row_ < kTold) return;
    run.tell(fmt::format(
        "up to t = {:.6g} s accelerations turn round and change by more than their size within a step, step after "
        "step: a stiff damper or spring moves that h = {:g} s does not resolve, and what is made of it here dies out "
        "by the factor spectral_radius a step; try integrator radau5 or a step that resolves it",
        t, h));
  }

 private:
  static constexpr int kTold = 10;
  static constexpr double kRounding = 1e4 * std::numeric_limits<double>::epsilon();
  int in_a_row_ = 0;  // but for a few
};

}  // namespace poinsot
