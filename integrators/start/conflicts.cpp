#include "integrators/start/conflicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "integrators/start/beside.h"
#include "integrators/start/row_space.h"

namespace poinsot {

std::string describe(const Conflict& conflict) {
  if (conflict.level == Conflict::Level::velocity) return fmt::format("{:.3g} m/s (velocity)", conflict.by);
  if (conflict.level == Conflict::Level::later_velocity)
    return fmt::format("{:.3g} m/s (velocity, at t = {:.3g} s)", conflict.by, conflict.time);
  if (conflict.level == Conflict::Level::position) return fmt::format("{:.3g} m (position)", conflict.by);
  return fmt::format("{:.3g} m (position, at t = {:.3g} s)", conflict.by, conflict.time);
}

std::vector<Conflict> conflicts(Trial& trial, Beside& beside, RowSpace& space) {
  const PlaceBeside& start = trial.start;
  const std::span<const double> off = beside.measure_start(trial);
  std::vector<double> rate(off.size()), nu(off.size());
  space.rates(start.v, rate, nu);
  const double speed = beside.extent(start.v);
  std::vector<Conflict> found;
  for (const int row : trial.onto->without()) {
    const std::size_t k = index(std::ranges::lower_bound(space.rows(), row) - space.rows().begin());
    const double size = space.own_size_of_row(k), length = space.norm_of_row(k);
    const double rate_off = std::abs(rate[k]) / length;
    if (off[k] > kContradicts * size)
      found.push_back({row, Conflict::Level::position, off[k], 0});
    else if (rate_off > kContradicts * std::max({speed * size, std::abs(nu[k]) / length, kHolds * size}))
      found.push_back({row, Conflict::Level::velocity, rate_off, 0});
  }
  return found;
}

}  // namespace poinsot
