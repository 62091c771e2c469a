// DP1 constraints with an alternate: which of the two stands, and whether both tell the same motion.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "core/index.h"
#include "core/status.h"
#include "formulations/configuration.h"

namespace poinsot {

template <Formulation F>
bool alternate_stands_in(const Configuration<F, double>& c, std::size_t k) {
  const AlternateRow& row = c.elements->alternates[k];
  const DP1Row& now = c.dp1[index(row.primary)];
  return now.u == row.alternate.u && now.v == row.alternate.v && now.f == row.alternate.f;
}

// Whether one that stood at the last accepted step does not where the mechanism stands now.
template <Formulation F>
bool alternates_change(const Configuration<F, double>& c) {
  for (std::size_t k = 0; k < c.alternate_stood_in.size(); ++k)
    if (c.alternate_stood_in[k] != alternate_stands_in(c, k)) return true;
  return false;
}

// A row and its alternate tell the same motion where one takes the other's place: with the one that stands now
// satisfied, so is the one that stood. `rows_off()`: by how much rows that stand are off at most, as where a tolerance
// of kinematics leaves them.
template <Formulation F, class RowsOff>
Status exchange_alternates(Configuration<F, double>& c, double t, RowsOff&& rows_off) {
  // rad, and times as far off as others: as of rows set aside (integrators/start/over_constrained.h)
  constexpr double kLost = 1e-5, kAsOthers = 100;
  for (std::size_t k = 0; k < c.alternate_stood_in.size(); ++k) {
    const AlternateRow& row = c.elements->alternates[k];
    const char stands = alternate_stands_in(c, k);
    char& stood = c.alternate_stood_in[k];
    if (stood == stands) continue;
    const DP1Row& other = stands ? row.normal : row.alternate;
    const Vector3 &u = c.s[index(other.u)], &v = c.s[index(other.v)];
    const double off = std::abs(u.dot(v) - c.f[index(other.f)].f) / (u.norm() * v.norm());
    if (stood == 2 || !(off > kLost) || off <= kAsOthers * rows_off()) {
      stood = stands;
      continue;
    }
    return with_remedy(
        Failure::constraint_lost, t,
        fmt::format("at t = {:.9g} s, where |f| passes 0.9, {} and its alternate contradict one another: with one "
                    "satisfied the other is violated by {:.3g}",
                    t, describe_row(*c.elements->model, c.elements->model_row[index(row.normal.row)]), off),
        "f and the directions of both have to tell the same motion, or an angle driver takes the place of both");
  }
  return {};
}

}  // namespace poinsot
