// Steppers of error-controlled methods driven with steps of equal length, and the orders that then show.
#pragma once

#include <array>

#include "integrators/equal_steps.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

// The motion after every quarter of `steps` steps, a multiple of four.
template <class Stepper>
std::vector<Snapshot> quarters(EqualSteps<Stepper> bench, double end, int steps) {
  std::vector<Snapshot> samples;
  check(bench.march(end, steps, steps / 4, [&](const Sample& s) { samples.push_back(snapshot(s)); }).ok(),
        "the steps exist and can be projected");
  return samples;
}

// Root mean squares over instants, bodies and components, relative to those of the motion.
inline std::array<double, 4> mean_errors(const std::vector<Snapshot>& x, const std::vector<Snapshot>& exact) {
  std::array<double, 4> apart{}, size{};
  const auto add = [&](std::size_t k, const auto& u, const auto& v) {
    apart[k] += (u - v).squaredNorm();
    size[k] += v.squaredNorm();
  };
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (std::size_t b = 0; b < x[n].bodies.size(); ++b) {
      const BodyState &u = x[n].bodies[b], &v = exact[n].bodies[b];
      add(0, u.r, v.r), add(0, u.A, v.A);
      add(1, u.rd, v.rd), add(1, u.w, v.w);
      add(2, u.rdd, v.rdd), add(2, u.wd, v.wd);
    }
    const auto rows = [](const std::vector<double>& l) {
      return Eigen::Map<const Eigen::VectorXd>(l.data(), static_cast<Eigen::Index>(l.size()));
    };
    add(3, rows(x[n].lambda), rows(exact[n].lambda));
  }
  std::array<double, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) result[k] = size[k] > 0 ? std::sqrt(apart[k] / size[k]) : 0;
  return result;
}

}  // namespace poinsot::test
