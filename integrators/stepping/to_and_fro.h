// Steps whose forces are explicit in the position or of both ends change velocities to and fro where a spring or damper
// moves faster than they see: beyond h w = 2 free motion on a spring changes its sign in every step and gets larger; a
// damper of rate c/m turns velocities round by the factor (1 − ½ h c/m)/(1 + ½ h c/m) of the trapezoidal rule, which is
// −1 all but a little, or where it is explicit by 1 − h c/m. So changes of the velocity are looked at: steps in a row,
// each of whose changes is against the one before and larger, or as good as opposite and little less, in one of the
// scene's mechanisms (core/mechanisms.h).
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

class ToAndFro {
 public:
  explicit ToAndFro(const Run& run)
      : mechanism_(mechanisms(run.problem.model())),
        change_(Eigen::VectorXd::Zero(run.problem.nv())),
        next_(run.problem.nv()) {
    const Model& model = run.problem.model();
    parts_.resize(mechanism_count(mechanism_));
    for (std::size_t b = 0; b < mechanism_.size(); ++b)
      parts_[index(mechanism_[b])].rounding +=
          std::pow(kRounding / run.settings.step, 2) * (1 + model.bodies[b].position.squaredNorm());
    if (parts_.size() == 1) mechanism_.resize(1);  // at one go
  }

  // A step of length h to t took v_n to v. Tells it once.
  void watch(const Run& run, const Eigen::VectorXd& v, const Eigen::VectorXd& v_n, double t, double h) {
    if (grows_told_ && lingers_told_) return;
    next_ = v - v_n;
    const Eigen::Index per_body = mechanism_.empty() ? 0 : v.size() / static_cast<Eigen::Index>(mechanism_.size());
    for (std::size_t b = 0; b < mechanism_.size(); ++b) {
      Part& of = parts_[index(mechanism_[b])];
      const auto next = next_.segment(static_cast<Eigen::Index>(b) * per_body, per_body);
      of.next += next.squaredNorm();
      of.along += next.dot(change_.segment(static_cast<Eigen::Index>(b) * per_body, per_body));
      of.speed += v.segment(static_cast<Eigen::Index>(b) * per_body, per_body).squaredNorm();
    }
    change_.swap(next_);
    for (Part& of : parts_) {
      const bool grows = of.along < 0 && of.next > kGrows * of.square && of.next > kNoise * of.speed + of.rounding;
      const bool lingers = of.along < 0 && of.along * of.along > kOpposite * of.next * of.square &&
                           of.next > kLingers * of.square && of.next > kCounts * of.speed + of.rounding;
      of = {of.next, 0, 0, 0, of.rounding, grows ? of.grows + 1 : 0, lingers ? of.lingers + 1 : 0};
      if (of.grows == kGrowing) tell_growth(run, static_cast<int>(&of - parts_.data()), t, h);
      if (of.lingers == kLingering && of.grows < 2) tell_lingering(run, static_cast<int>(&of - parts_.data()), t, h);
    }
  }

 private:
  static constexpr int kGrowing = 6, kLingering = 10;
  static constexpr double kGrows = 1.2, kNoise = 1e-12;                              // of squares
  static constexpr double kOpposite = 0.9, kLingers = 0.3, kCounts = 1e-4;           // of squares
  static constexpr double kRounding = 1e3 * std::numeric_limits<double>::epsilon();  // of positions, in a step

  struct Part {
    double square = 0;                      // of the change in the step before
    double next = 0, along = 0, speed = 0;  // of the step under way: its square, with the one before, that of v
    double rounding = 0;                    // of squares, what positions at rest make
    int grows = 0, lingers = 0;             // in a row
  };

  void tell_growth(const Run& run, int mechanism, double t, double h) {
    if (std::exchange(grows_told_, true)) return;
    lingers_told_ = true;
    run.tell(fmt::format(
        "at t = {:.6g} s velocities{} change to and fro from step to step, the {}th time by more: a spring or damper "
        "moves faster than h = {:g} s can follow where forces are taken at the start of a step, and what is computed "
        "grows without bound; try integrator radau5 or generalized_alpha, or a smaller step",
        t, of_mechanism(run.problem.model(), mechanism_, mechanism), kGrowing, h));
  }
  void tell_lingering(const Run& run, int mechanism, double t, double h) {
    if (std::exchange(lingers_told_, true)) return;
    run.tell(fmt::format(
        "up to t = {:.6g} s velocities{} change to and fro from step to step, and hardly less each time: a damper or "
        "spring moves faster than h = {:g} s can follow, and what is made of it here is not its motion; try integrator "
        "radau5 or implicit_euler",
        t, of_mechanism(run.problem.model(), mechanism_, mechanism), h));
  }

  std::vector<int> mechanism_;  // of each body, or of all as one
  std::vector<Part> parts_;     // by mechanism
  Eigen::VectorXd change_, next_;
  bool grows_told_ = false, lingers_told_ = false;
};

}  // namespace poinsot
