#include "integrators/stepping/rest_watch.h"

#include <fmt/format.h>

#include <algorithm>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

Status other_branch_after_rest(double t, double since) {
  return with_settings(
      {Failure::singular_position, t,
       fmt::format("at t = {:.9g} s the motion, which had come to rest in a singular position of the constraints "
                   "after {:.9g} s, goes on along another branch than its accelerations led to",
                   t, since)},
      "try another step or dop853");
}

RestWatch::RestWatch(const Problem& problem)
    : parts_(problem), a_(Eigen::VectorXd::Zero(problem.nv())), usual_(parts_.count()) {
  before_.fill({0, Eigen::VectorXd::Zero(problem.nq()), a_, a_});
}

Status RestWatch::look(const Problem& problem, const LinearChoice& choice, const State& at) {
  constexpr int kAccelerations = 3;  // looks, of which the last two know theirs
  // A motion that lasts in the position moves by rounding, to and fro.
  constexpr double kMoves = 0.1, kForgotten = 0.99;
  wait_ = kApart;
  if (looks_ > 0) {
    a_ = (at.v - before_[0].v) / (at.t - before_[0].t);
    const double all = largest(span(a_));
    for (std::size_t part = 0; part < parts_.count(); ++part) {
      const double size = parts_.largest(part, span(a_));
      usual_[part] = std::max(size, kForgotten * usual_[part]);
      if (looks_ < kAccelerations || !(size > kMoves * usual_[part]) || parts_.rests(size, all)) continue;
      // The last stretch may have turned round in its midst, so that its mean is nothing.
      const auto turned = [&](const Look& look) { return turned_round(parts_, part, look.a, a_); };
      const auto then = std::ranges::find_if(before_, turned);
      if (then != before_.end() && left_branch(problem, choice, at, *then, part)) {
        return other_branch_after_rest(at.t, before_[1].t);
      }
    }
  }
  std::swap(before_[0], before_[1]);
  before_[0].t = at.t, before_[0].q = at.q, before_[0].v = at.v, before_[0].a = a_;
  looks_ = std::min(looks_ + 1, kAccelerations);
  return {};
}

bool RestWatch::left_branch(const Problem& problem, const LinearChoice& choice, const State& at, const Look& then,
                            std::size_t part) const {
  constexpr double kStretches = 3, kFarSteeper = 4;
  const auto larger = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    return std::max(parts_.largest(part, span(x)), parts_.largest(part, span(y)));
  };
  if (!(larger(at.v, before_[0].v) < kStretches * (at.t - before_[0].t) * larger(a_, then.a))) return false;
  const std::unique_ptr<Problem> own = problem.clone();
  Consistent consistent(*own, choice);
  const auto steepness = [&](double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    own->set_position(t, span(q));
    own->set_velocity(span(v));
    return consistent.factor(t).ok() ? consistent.steepness(t, part) : HUGE_VAL;
  };
  const auto of = [&](const Look& look) { return steepness(look.t, look.q, look.v); };
  const double first = of(before_[1]), last = of(before_[0]), now = steepness(at.t, at.q, at.v);
  if (!(std::max({first, last, now}) > kFarSteeper * std::min({first, last, now}))) return false;
  return now < HUGE_VAL && consistent.lies_free(at.t, a_ - then.a, part);
}

}  // namespace poinsot
