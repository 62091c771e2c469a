#include "integrators/stepping/rest_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

Status RestWatch::look(const Problem& problem, const LinearChoice& choice, const State& at) {
  wait_ = kApart;
  if (looks_ == 2 && turned_round(at) && left_branch(problem, choice, at)) {
    return {Failure::singular_position, at.t,
            fmt::format("at t = {:.9g} s the motion, which had come to rest in a singular position of the constraints "
                        "after {:.9g} s, goes on along another branch than its accelerations led to; try another step "
                        "or dop853",
                        at.t, before_.t)};
  }
  std::swap(before_, last_);
  last_.t = at.t, last_.q = at.q, last_.v = at.v;
  looks_ = std::min(looks_ + 1, 2);
  return {};
}

bool RestWatch::turned_round(const State& at) const {
  constexpr double kAltogether = 0.5, kStretches = 3;
  const double h = at.t - last_.t, h_before = last_.t - before_.t;
  const auto now = (at.v - last_.v) / h, then = (last_.v - before_.v) / h_before;
  const double most = std::max(now.cwiseAbs().maxCoeff(), then.cwiseAbs().maxCoeff());
  if (!((now - then).cwiseAbs().maxCoeff() > kAltogether * most)) return false;
  return std::max(largest(span(at.v)), largest(span(last_.v))) < kStretches * h * most;
}

bool RestWatch::left_branch(const Problem& problem, const LinearChoice& choice, const State& at) const {
  constexpr double kSteeper = 4;
  const std::unique_ptr<Problem> own = problem.clone();
  Consistent consistent(*own, choice);
  const auto steepness = [&](double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    own->set_position(t, span(q));
    own->set_velocity(span(v));
    return consistent.factor(t).ok() ? consistent.steepness(t) : HUGE_VAL;
  };
  const double before = steepness(before_.t, before_.q, before_.v), last = steepness(last_.t, last_.q, last_.v);
  const double now = steepness(at.t, at.q, at.v);
  if (!(std::max({before, last, now}) > kSteeper * std::min({before, last, now}))) return false;
  const double h = at.t - last_.t, h_before = last_.t - before_.t;
  return now < HUGE_VAL && consistent.lies_free(at.t, (at.v - last_.v) / h - (last_.v - before_.v) / h_before);
}

}  // namespace poinsot
