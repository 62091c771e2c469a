#include "integrators/stepping/still_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// How independent the least independent row is.
double least_share(const Problem& problem, const State& at) {
  const std::unique_ptr<Problem> own = problem.clone();
  return most_dependent_row(*own, static_cast<int>(own->model_rows().size()), at.t, span(at.q)).share;
}

}  // namespace

StillWatch::StillWatch(const Problem& problem, std::function<void(const std::string&)> tell)
    : tell_(std::move(tell)), v_(Eigen::VectorXd::Zero(problem.nv())) {}

void StillWatch::look(const Problem& problem, const State& at) {
  constexpr double kStill = 0.1, kMoves = 0.25;
  constexpr double kFades = 0.05;    // in the time that the motion takes to change
  constexpr double kFarLess = 0.05;  // as independent as elsewhere
  if (told_) return;
  const double speed = at.v.lpNorm<Eigen::Infinity>();
  const double since = at.t - t_;
  const double acceleration = (at.v - v_).lpNorm<Eigen::Infinity>() / since;
  const bool first = t_ < 0;
  v_ = at.v;
  t_ = at.t;
  if (first) {
    speed_ = speed;
    return;
  }
  if (speed <= kStill * speed_ && acceleration <= kStill * acceleration_) {
    const bool before = std::exchange(motion_, Motion::at_rest) != Motion::under_way;
    if (before && !(speed < kStill * slowest_)) return;
    t_rest_ = at.t;
    slowest_ = speed;
    share_ = before ? std::min(share_, least_share(problem, at)) : least_share(problem, at);
    return;
  }
  if (motion_ == Motion::at_rest) motion_ = Motion::going_on;
  if (motion_ == Motion::going_on) {
    if (speed < kMoves * speed_) return;
    motion_ = Motion::under_way;
    if (share_ < kFarLess * least_share(problem, at)) {
      told_ = true;
      tell_(
          fmt::format("at t = {:.6g} s the motion rests in a singular position of the constraints, its accelerations "
                      "included, from where it could go on either way: by which branch it does is not certain",
                      t_rest_));
    }
  }
  const double faded = 1 - kFades * std::min(1.0, speed_ > 0 ? since * acceleration_ / speed_ : 0);
  speed_ = std::max(speed, faded * speed_);
  acceleration_ = std::max(acceleration, faded * acceleration_);
}

}  // namespace poinsot
