// Steps whose forces are explicit in the position or of both ends change velocities to and fro where a spring or damper
// moves faster than they see: beyond h w = 2 free motion on a spring changes its sign in every step and gets larger; a
// damper of rate c/m turns velocities round by the factor (1 − ½ h c/m)/(1 + ½ h c/m) of the trapezoidal rule, which is
// −1 all but a little, or where it is explicit by 1 − h c/m. So changes of the velocity are looked at: steps in a row,
// each of whose changes is against the one before and larger, or as good as opposite and little less, in one of the
// scene's mechanisms (core/mechanisms.h).
//
// Where nothing rings, what a stiff force holds follows the motion, at positions and velocities that are off by O(h²)
// and at which it is off by as much times its stiffness. Accelerations given out there are not those by which
// velocities change, a ≈ (3 Δv_n − Δv_(n−1))/2h + O(h² ä).
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
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
    if (told()) return;
    next_ = v - v_n;
    equal_steps_ = std::abs(h - h_before_) < kEqual * h ? equal_steps_ + 1 : 1;
    h_before_ = h;
    for_bodies(v.size(), [&](Part& of, Eigen::Index first, Eigen::Index count) {
      const auto next = next_.segment(first, count);
      of.next += next.squaredNorm();
      of.along += next.dot(change_.segment(first, count));
      of.speed += v.segment(first, count).squaredNorm();
    });
    change_.swap(next_);
    for (Part& of : parts_) {
      const bool grows = of.along < 0 && of.next > kGrows * of.square && of.next > kNoise * of.speed + of.rounding;
      const bool lingers = of.along < 0 && of.along * of.along > kOpposite * of.next * of.square &&
                           of.next > kLingers * of.square && of.next > kCounts * of.speed + of.rounding;
      of = {.square = of.next,
            .most = std::max(of.most, of.next / (h * h)),
            .rounding = of.rounding,
            .grows = grows ? of.grows + 1 : 0,
            .lingers = lingers ? of.lingers + 1 : 0,
            .apart = of.apart};
      if (of.grows == kGrowing) tell_growth(run, static_cast<int>(&of - parts_.data()), t, h);
      if (of.lingers == kLingering && of.grows < 2) tell_lingering(run, static_cast<int>(&of - parts_.data()), t, h);
    }
  }

  // Velocities are other coordinates' than before.
  void restart() { equal_steps_ = 0; }
  // Accelerations `a` are given out at t, where the last step ended; the last ones that are, or not. Tells it once.
  void look(const Run& run, std::span<const double> a, double t, bool last) {
    if (told() || equal_steps_ < 2) return;
    for_bodies(change_.size(), [&](Part& of, Eigen::Index first, Eigen::Index count) {
      const Eigen::Map<const Eigen::VectorXd> given(a.data() + first, count);
      of.next +=
          (h_before_ * given - 1.5 * change_.segment(first, count) + 0.5 * next_.segment(first, count)).squaredNorm();
    });
    for (Part& of : parts_) {
      const double off = std::sqrt(std::exchange(of.next, 0)) / h_before_, most = std::sqrt(of.most);
      const bool swings = of.grows > 0 || of.lingers > 0;  // which is told as such
      of.apart = !swings && off > kApart * most && h_before_ * off > std::sqrt(of.rounding) ? of.apart + 1 : 0;
      if (of.apart == kApartInARow || (last && of.apart > 0))
        tell_apart(run, static_cast<int>(&of - parts_.data()), off / most, t);
    }
  }

 private:
  static constexpr int kGrowing = 6, kLingering = 10, kApartInARow = 3;
  static constexpr double kGrows = 1.2, kNoise = 1e-12;                              // of squares
  static constexpr double kOpposite = 0.9, kLingers = 0.3, kCounts = 1e-4;           // of squares
  static constexpr double kRounding = 1e3 * std::numeric_limits<double>::epsilon();  // of positions, in a step

  static constexpr double kApart = 0.15;  // of the largest change of a velocity so far, over time
  static constexpr double kEqual = 1e-6;  // of steps' lengths

  struct Part {
    double square = 0;                      // of the change in the step before
    double next = 0, along = 0, speed = 0;  // of the step under way: its square, with the one before, that of v
    double most = 0;                        // square/h² of all steps
    double rounding = 0;                    // of squares, what positions at rest make
    int grows = 0, lingers = 0;             // in a row
    int apart = 0;                          // samples in a row
  };

  bool told() const { return grows_told_ && lingers_told_; }

  // f(its part, first component, how many) of every body.
  template <class Use>
  void for_bodies(Eigen::Index nv, Use&& use) {
    if (mechanism_.empty()) return;
    const Eigen::Index count = nv / static_cast<Eigen::Index>(mechanism_.size());
    for (std::size_t b = 0; b < mechanism_.size(); ++b)
      use(parts_[index(mechanism_[b])], static_cast<Eigen::Index>(b) * count, count);
  }

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

  void tell_apart(const Run& run, int mechanism, double off, double t) {
    if (std::exchange(apart_told_, true)) return;
    run.tell(fmt::format(
        "at t = {:.6g} s accelerations{} differ by {:.2g} of the largest from those by which velocities change: a "
        "damper or spring is so stiff that small errors of positions and velocities make large forces; where "
        "accelerations, reactions or forces count, try integrator radau5 or generalized_alpha",
        t, of_mechanism(run.problem.model(), mechanism_, mechanism), off));
  }

  std::vector<int> mechanism_;     // of each body, or of all as one
  std::vector<Part> parts_;        // by mechanism
  Eigen::VectorXd change_, next_;  // of v in the last step; in the one before
  double h_before_ = 0;
  int equal_steps_ = 0;
  bool grows_told_ = false, lingers_told_ = false, apart_told_ = false;
};

}  // namespace poinsot
