#include "integrators/stepping/driver_impulses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// What ḟ changes by; 0 where that may be rounding, of rates of the size that f̈ makes in a run.
double jump_of_rate(const Row& row, double before, double beyond, double end) {
  constexpr double kNoJump = 1e-9;
  if (row.type == RowType::pfaffian || row.f.is_constant()) return 0;
  const Jet2<double> from = row.f.at(before), to = row.f.at(beyond);
  const double size = std::max({std::abs(from.fd), std::abs(to.fd), end * std::abs(from.fdd), end * std::abs(to.fdd)});
  return std::abs(to.fd - from.fd) > kNoJump * size ? to.fd - from.fd : 0;
}

}  // namespace

void DriverImpulses::expect(const State& at, double beyond) {
  row_ = -1;
  if (told_) return;
  Problem& problem = run_.problem;
  for (const int k : problem.model_rows()) {
    jump_ = jump_of_rate(problem.model().rows[index(k)], at.t, beyond, run_.settings.end);
    if (jump_ == 0) continue;
    row_ = k;
    problem.set_position(at.t, span(at.q));
    problem.set_velocity(span(at.v));
    kinetic_ = kinetic(at);
    return;
  }
}

void DriverImpulses::look(const State& beyond) {
  if (row_ < 0) return;
  const double gain = kinetic(beyond) - kinetic_;
  told_ = true;
  run_.tell(
      fmt::format("at t = {:.6g} s the rate of {} jumps by {:.3g}, and velocities with it: the impulse that does it, "
                  "and the {:.3g} J that it {}, are in no reaction, effort or power",
                  beyond.t, describe_row(run_.problem.model(), std::exchange(row_, -1)), jump_, std::abs(gain),
                  gain < 0 ? "takes" : "brings"));
}

double DriverImpulses::kinetic(const State& at) const {
  Eigen::VectorXd momentum(at.v.size());
  run_.problem.momentum(span(at.v), span(momentum));
  return 0.5 * at.v.dot(momentum);
}

}  // namespace poinsot
