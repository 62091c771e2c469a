// Time is an integer: t_n = n h, and the last step lands on the end exactly.
#pragma once

#include <cmath>
#include <cstdint>

#include "integrators/settings.h"

namespace poinsot {

struct TimeGrid {
  double end;
  std::int64_t steps;  // of equal length end/steps
  std::int64_t every;  // steps between samples

  explicit TimeGrid(const Settings& settings)
      : end(settings.end),
        steps(std::llround(settings.end / settings.step)),
        every(settings.every > 0 ? std::llround(settings.every / settings.step) : 1) {
    if (steps < 1) steps = 1;
    if (every < 1) every = 1;
  }

  double step() const { return end / static_cast<double>(steps); }
  double time(std::int64_t n) const {
    return n == steps ? end : end * (static_cast<double>(n) / static_cast<double>(steps));
  }
  bool sampled(std::int64_t n) const { return n % every == 0 || n == steps; }
};

}  // namespace poinsot
