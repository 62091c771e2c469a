#include "integrators/stepping/still_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/index.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
StillWatch::StillWatch(const Problem& problem, std::function<void(const std::string&)> tell)
    : parts_(problem),
      of_(parts_.count()),
      tell_(std::move(tell)),
      v_(Eigen::VectorXd::Zero(problem.nv())),
      change_(v_) {}

void StillWatch::look(const Problem& problem, const State& at) {
  if (told_) return;
  const double since = at.t - t_;
  change_ = at.v - v_;
  v_ = at.v;
  fastest_ = largest(span(v_));
  shares_known_ = false;
  const bool first = std::exchange(t_, at.t) < 0;
  for (std::size_t part = 0; part < parts_.count() && !told_; ++part) {
    const double speed = parts_.count() == 1 ? fastest_ : parts_.largest(part, span(v_));
    if (first)
      of_[part].speed = speed;
    else
      look(problem, at, part, since, speed);
  }
}

// How independent the least independent row of the mechanism is.
double StillWatch::least_share(const Problem& problem, const State& at, std::size_t part) {
  if (!std::exchange(shares_known_, true)) {
    const std::unique_ptr<Problem> own = problem.clone();
    shares_ = independent_shares(*own, static_cast<int>(own->model_rows().size()), at.t, span(at.q));
  }
  double least = 1;
  for (Eigen::Index k = 0; k < shares_.size(); ++k)
    if (parts_.of_row(problem, index(k)) == part) least = std::min(least, shares_[k]);
  return least;
}

void StillWatch::look(const Problem& problem, const State& at, std::size_t part, double since, double speed) {
  constexpr double kStill = 0.1, kMoves = 0.25;
  constexpr double kFades = 0.05;    // in the time that the motion takes to change
  constexpr double kFarLess = 0.05;  // as independent as elsewhere
  Part& of = of_[part];
  const double acceleration = parts_.largest(part, span(change_)) / since;
  const bool rests = parts_.rests(speed, fastest_);
  if (rests) speed = 0;
  if (rests || (speed <= kStill * of.speed && acceleration <= kStill * of.acceleration)) {
    const bool before = std::exchange(of.motion, Motion::at_rest) != Motion::under_way;
    if (before && !(speed < kStill * of.slowest)) return;
    of.t_rest = at.t;
    of.slowest = speed;
    const double share = least_share(problem, at, part);
    of.share = before ? std::min(of.share, share) : share;
    return;
  }
  if (of.motion == Motion::at_rest) of.motion = Motion::going_on;
  if (of.motion == Motion::going_on) {
    if (speed < kMoves * of.speed) return;
    of.motion = Motion::under_way;
    if (of.share < kFarLess * least_share(problem, at, part)) {
      told_ = true;
      tell_(
          fmt::format("at t = {:.6g} s the motion rests in a singular position of the constraints, its accelerations "
                      "included, from where it could go on either way: by which branch it does is not certain",
                      of.t_rest));
    }
  }
  const double faded = 1 - kFades * std::min(1.0, of.speed > 0 ? since * of.acceleration / of.speed : 0);
  of.speed = std::max(speed, faded * of.speed);
  of.acceleration = std::max(acceleration, faded * of.acceleration);
}

}  // namespace poinsot
