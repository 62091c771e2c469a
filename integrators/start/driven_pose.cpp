#include "integrators/start/driven_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"

namespace poinsot {

Status check_driven_pose(const Problem& problem, std::span<const double> a) {
  const Model& model = problem.model();
  const auto driven = [](const Row& row) { return row.type == RowType::angle || row.squared; };
  if (std::ranges::none_of(model.rows, driven)) return {};
  std::vector<BodyState> states(model.bodies.size());
  problem.to_bodies(a, states);
  const auto in_space = [&](int body, const Vector3& x) -> Vector3 {
    if (body == kGround) return x;
    return states[index(body)].A * x;
  };
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (!driven(row)) continue;
    const double f = row.f.at(0.0).f;
    if (row.squared && f < 0) {
      return {Failure::inconsistent_state, 0,
              fmt::format("{} asks for a length of {:.4g} m at t = 0; a length is not negative",
                          describe_row(model, static_cast<int>(k)), f)};
    }
    if (row.type != RowType::angle) continue;
    const Vector3 u_f = in_space(row.i, std::cos(f) * row.a_i + std::sin(f) * row.b_i);
    if (u_f.dot(in_space(row.j, row.a_j)) > 0) continue;
    return {Failure::inconsistent_state, 0,
            fmt::format("{} asks for an angle of {:.4g} rad at t = 0, the bodies stand half a turn off: angles count "
                        "from the initial pose, and it is found for small ones only; give the bodies in the pose the "
                        "motion starts from, and the angle from there",
                        describe_row(model, static_cast<int>(k)), f)};
  }
  return {};
}

}  // namespace poinsot
