#include "integrators/tilted_axes.h"

#include <fmt/format.h>

#include <cmath>

#include "core/index.h"

namespace poinsot {

void tell_tilted_axes(const Model& model, std::span<const BodyState> bodies, const Tell& tell) {
  constexpr double kTilted = 1e-3;  // rad
  for (const OpenAngle& angle : model.open_angles) {
    const auto before = [&](int b) {
      return b == kGround ? Matrix3(Matrix3::Identity()) : model.bodies[index(b)].orientation;
    };
    const auto now = [&](int b) { return b == kGround ? Matrix3(Matrix3::Identity()) : bodies[index(b)].A; };
    const Vector3 on_i = now(angle.i) * angle.axis;
    const Vector3 on_j = now(angle.j) * (before(angle.j).transpose() * (before(angle.i) * angle.axis));
    const double tilt = std::atan2(on_i.cross(on_j).norm(), on_i.dot(on_j));
    if (!(tilt > kTilted)) continue;
    const std::string second =
        angle.j == kGround ? "the ground" : fmt::format("body '{}'", model.bodies[index(angle.j)].name);
    return tell(
        fmt::format("the axis of {} has tilted by {:.2g} rad in {}: its angle is that of a direction of {} which was "
                    "chosen for it, "
                    "and another one would make another motion; name it by \"a_i\" and \"a_j\"",
                    angle.of, tilt, second, second));
  }
}

}  // namespace poinsot
