// Accelerations that turn round and change by more than their size within a step, step after step, are not those of the
// motion, in any of the scene's mechanisms (core/mechanisms.h). Those of an oscillation that the steps resolve turn
// round now and then.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/index.h"
#include "core/mechanisms.h"
#include "integrators/integrator.h"

namespace poinsot {

class Ringing {
 public:
  explicit Ringing(const Problem& problem) : mechanism_(mechanisms(problem.model())) {
    parts_.resize(mechanism_count(mechanism_));
    if (parts_.size() == 1) mechanism_.resize(1);  // at one go
  }

  // A step of length h to (t, q) took the accelerations at the head of z_n to those of z. Tells it once.
  void watch(const Run& run, const Eigen::VectorXd& z, const Eigen::VectorXd& z_n, const Eigen::VectorXd& q, double t,
             double h) {
    if (told_ || mechanism_.empty()) return;
    const auto bodies = static_cast<Eigen::Index>(mechanism_.size());
    const Eigen::Index per_body = run.problem.nv() / bodies;
    for (Eigen::Index b = 0; b < bodies; ++b) {
      Part& of = parts_[index(mechanism_[index(b)])];
      const auto now = z.segment(b * per_body, per_body), then = z_n.segment(b * per_body, per_body);
      of.change += (now - then).squaredNorm();
      of.before += then.squaredNorm();
      of.along += now.dot(then);
    }
    for (Part& of : parts_) {
      const int number = static_cast<int>(&of - parts_.data());
      const bool rings = of.along < 0 && of.change >= of.before &&
                         h * h * std::sqrt(of.change) >= kRounding * std::max(place(q, number), 1.0);
      of = {rings ? of.in_a_row + 1 : std::max(of.in_a_row - 1, 0)};
      if (of.in_a_row >= kTold) return tell(run, number, t, h);
    }
  }

 private:
  static constexpr int kTold = 10;
  static constexpr double kRounding = 1e4 * std::numeric_limits<double>::epsilon();

  struct Part {
    int in_a_row = 0;                          // but for a few
    double change = 0, before = 0, along = 0;  // of the step under way: squares, product
  };

  // |q| of a mechanism, m.
  double place(const Eigen::VectorXd& q, int mechanism) const {
    const auto bodies = static_cast<Eigen::Index>(mechanism_.size());
    const Eigen::Index places = q.size() / bodies;
    double square = 0;
    for (Eigen::Index b = 0; b < bodies; ++b)
      if (mechanism_[index(b)] == mechanism) square += q.segment(b * places, places).squaredNorm();
    return std::sqrt(square);
  }

  void tell(const Run& run, int mechanism, double t, double h) {
    told_ = true;
    run.tell(fmt::format(
        "up to t = {:.6g} s accelerations{} turn round and change by more than their size within a step, step after "
        "step: a stiff damper or spring moves that h = {:g} s does not resolve, and what is made of it here dies out "
        "by the factor spectral_radius a step; try integrator radau5 or a step that resolves it",
        t, of_mechanism(run.problem.model(), mechanism_, mechanism), h));
  }

  std::vector<int> mechanism_;  // of each body, or of all as one
  std::vector<Part> parts_;     // by mechanism
  bool told_ = false;
};

}  // namespace poinsot
