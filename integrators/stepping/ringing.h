// Accelerations that turn round and change by more than their size within a step, step after step, are not those of the
// motion, in any of the scene's mechanisms (core/mechanisms.h). Those of an oscillation that the steps resolve turn
// round now and then.
//
// Along the constraints a stiff damper or spring rings. Across them no force does: there the steps themselves have kept
// what they did not follow, of a start or of a change too sudden for them.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/mechanisms.h"
#include "integrators/integrator.h"

namespace poinsot {

class Ringing {
 public:
  explicit Ringing(const Problem& problem) : mechanism_(mechanisms(problem.model())), change_(problem.nv()) {
    parts_.resize(mechanism_count(mechanism_));
    if (parts_.size() == 1) mechanism_.resize(1);  // at one go
  }

  // A step of length h to (t, q) took the accelerations at the head of z_n to those of z. Tells it once of either kind,
  // told apart by keep_along(x), which leaves of accelerations at (t, q) what the constraints allow, or fails.
  template <class KeepAlong>
  void watch(const Run& run, const Eigen::VectorXd& z, const Eigen::VectorXd& z_n, const Eigen::VectorXd& q, double t,
             double h, KeepAlong&& keep_along) {
    if ((told_along_ && told_across_) || mechanism_.empty()) return;
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
      if (of.in_a_row < kTold) continue;
      of.in_a_row = 0;
      const double whole = keep_change(number, z, z_n);
      if (keep_along(change_).ok()) tell(run, number, change_.norm() > kAlong * whole, t, h);
    }
  }

 private:
  static constexpr int kTold = 10;
  static constexpr double kRounding = 1e4 * std::numeric_limits<double>::epsilon();
  static constexpr double kAlong = 0.1;  // of a change: what a force has to do with it

  struct Part {
    int in_a_row = 0;                          // but for a few
    double change = 0, before = 0, along = 0;  // of the step under way: squares, product
  };

  static bool has_forces(const Model& model) {
    return !(model.springs.empty() && model.torsions.empty() && model.drags.empty() && model.callbacks.empty());
  }

  // |q| of a mechanism, m.
  double place(const Eigen::VectorXd& q, int mechanism) const {
    const auto bodies = static_cast<Eigen::Index>(mechanism_.size());
    const Eigen::Index places = q.size() / bodies;
    double square = 0;
    for (Eigen::Index b = 0; b < bodies; ++b)
      if (mechanism_[index(b)] == mechanism) square += q.segment(b * places, places).squaredNorm();
    return std::sqrt(square);
  }

  // Of a mechanism, in change_; its size.
  double keep_change(int mechanism, const Eigen::VectorXd& z, const Eigen::VectorXd& z_n) {
    const auto bodies = static_cast<Eigen::Index>(mechanism_.size());
    const Eigen::Index per_body = change_.size() / bodies;
    change_.setZero();
    for (Eigen::Index b = 0; b < bodies; ++b)
      if (mechanism_[index(b)] == mechanism)
        change_.segment(b * per_body, per_body) =
            z.segment(b * per_body, per_body) - z_n.segment(b * per_body, per_body);
    return change_.norm();
  }

  void tell(const Run& run, int mechanism, bool along, double t, double h) {
    if (std::exchange(along ? told_along_ : told_across_, true)) return;
    run.tell(fmt::format(
        "up to t = {:.6g} s accelerations{} turn round and change by more than their size within a step, step after "
        "step{}dies out by the factor spectral_radius a step; try integrator radau5 or a step that resolves it",
        t, of_mechanism(run.problem.model(), mechanism_, mechanism),
        along ? fmt::format(": {} that h = {:g} s does not resolve, and what is made of it here ",
                            has_forces(run.problem.model()) ? "a stiff damper or spring moves" : "something moves", h)
              : fmt::format(", across the constraints: before that something changed faster than h = {:g} s follows, "
                            "and what it has left here in accelerations, reactions and velocities, not in positions, ",
                            h)));
  }

  std::vector<int> mechanism_;  // of each body, or of all as one
  std::vector<Part> parts_;     // by mechanism
  Eigen::VectorXd change_;      // of accelerations
  bool told_along_ = false, told_across_ = false;
};

}  // namespace poinsot
