// Time is an integer: t_n = n h, and the last step lands on the end exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "integrators/settings.h"

namespace poinsot {

struct TimeGrid {
  double end;
  std::int64_t steps;  // of equal length end/steps
  std::int64_t every;  // steps between samples

  // check_counts() (integrators/settings_reader.h) saw to it that the steps can be counted.
  explicit TimeGrid(const Settings& settings)
      : end(settings.end), steps(std::max<std::int64_t>(1, std::llround(settings.end / settings.step))), every(1) {
    if (settings.every >= end) {
      every = steps;  // however long it is
    } else if (settings.every > 0) {
      every = std::max<std::int64_t>(1, std::llround(settings.every / settings.step));
    }
  }

  double step() const { return end / static_cast<double>(steps); }
  double time(std::int64_t n) const {
    return n == steps ? end : end * (static_cast<double>(n) / static_cast<double>(steps));
  }
  bool sampled(std::int64_t n) const { return n % every == 0 || n == steps; }
};

}  // namespace poinsot
