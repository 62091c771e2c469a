// What a row asks of the bodies, written out once more from its definition: Φ, and Ψ v − f of a velocity row.
#pragma once

#include <cmath>
#include <span>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot::test {

inline double asked(const Row& row, std::span<const BodyState> states, double t) {
  const auto state = [&](int body) { return body == kGround ? BodyState() : states[static_cast<std::size_t>(body)]; };
  const BodyState i = state(row.i), j = state(row.j);
  const double value = row.f.at(t).f, f = row.squared ? value * value : value;
  const Vector3 d = j.r + j.A * row.s_j - i.r - i.A * row.s_i;
  const Vector3 d_dot = j.rd + j.A * j.w.cross(row.s_j) - i.rd - i.A * i.w.cross(row.s_i);
  switch (row.type) {
    case RowType::DP1:
      return (i.A * row.a_i).dot(j.A * row.a_j) - f;
    case RowType::DP2:
      return (i.A * row.a_i).dot(d) - f;
    case RowType::D:
      return d.squaredNorm() - f;
    case RowType::CD:
      return row.c.dot(d) - f;
    case RowType::angle:
      return (i.A * (std::cos(f) * row.b_i - std::sin(f) * row.a_i)).dot(j.A * row.a_j);
    case RowType::pfaffian:
      return (j.A * row.a_j).dot(d_dot) - f;
  }
  return 0;
}

}  // namespace poinsot::test
