#include "integrators/stepping/numerical_damping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

NumericalDamping::NumericalDamping(const Run& run)
    : moves_(run.problem.nv() > run.problem.nc()), momentum_(run.problem.nv()) {
  if (!moves_) return;
  bodies_.resize(index(run.problem.bodies()));
  run.problem.to_bodies(run.state.a(), bodies_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) then_.push_back(motion(run.problem.model().bodies[b], bodies_[b]));
}

NumericalDamping::Motion NumericalDamping::motion(const Body& body, const BodyState& at) {
  return {at.rd, at.A * (body.inertia * at.w), at.A * at.w};
}

void NumericalDamping::add(const Problem& problem, const State& x) {
  since_ = 0;
  if (!moves_) return;
  steps_ += kApart;
  problem.to_bodies(x.a(), bodies_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = problem.model().bodies[b];
    const Motion now = motion(body, bodies_[b]), &then = then_[b];
    const double turning = std::max(0.0, (now.L - then.L).dot(now.w - then.w));
    taken_ += (body.mass * (now.rd - then.rd).squaredNorm() + turning) / kApart;
    then_[b] = now;
  }
  problem.momentum(span(x.v), span(momentum_));
  most_kinetic_ = std::max(most_kinetic_, 0.5 * x.v.dot(momentum_));
}

void NumericalDamping::say(const Run& run, double h) const {
  constexpr double kTold = 0.06;     // of the kinetic energy: 3 % of speeds
  constexpr double kFromRest = 2.5;  // steps: a constant force makes 2/n of that in n of them, with the motion it makes
  if (steps_ == 0 || !(taken_ > (kTold + kFromRest / static_cast<double>(steps_)) * most_kinetic_)) return;
  const double share = taken_ / most_kinetic_;
  // Less is taken of what is left: of most of it the step's part is not that of a small loss.
  const double rate = -std::log1p(-std::min(share, 0.99));
  run.tell(fmt::format(
      "{} has taken some {:.3g} J or more out of the motion by itself, {:.3g} % of the largest kinetic energy (what "
      "drivers put back included): it damps in proportion to the step; a step below {:.2g} s, rattle or error control "
      "take less than {:.0f} %",
      run.settings.integrator, taken_, 100 * share, 0.9 * h * kTold / rate, 100 * kTold));
}

}  // namespace poinsot
