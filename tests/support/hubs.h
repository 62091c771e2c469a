// Mechanisms round one body with many joints, which constrain too often.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

#include "core/scene.h"

namespace poinsot::test {

// Round a hub on a hinge: arms that are hinged twice, arms hinged to their neighbours, too (so that all move as one, in
// one plane or at different heights, or kilometres away from their hinges), four-bars, legs of two parts to another
// hub. Or a coupler on parallel cranks, the hub; on hinges or on balls.
enum class Hub { twice, triangles, flat_triangles, far_triangles, four_bars, two_hubs, cranks, ball_cranks };

struct HubKind {
  Hub hub;
  std::string_view name;
  int freedoms(int count) const {  // of the mechanism with so many arms, loops or cranks
    if (hub == Hub::twice || hub == Hub::four_bars) return count + 1;
    if (hub == Hub::two_hubs) return 4;      // the other one moves in the plane
    return hub == Hub::ball_cranks ? 2 : 1;  // a coupler turns about a line of balls
  }
};
inline constexpr HubKind kHubs[] = {
    {Hub::twice, "hinged twice"},
    {Hub::triangles, "triangles"},
    {Hub::flat_triangles, "flat triangles"},
    {Hub::far_triangles, "far triangles"},
    {Hub::four_bars, "four-bars"},
    {Hub::two_hubs, "two hubs"},
    {Hub::cranks, "cranks"},
    {Hub::ball_cranks, "cranks with balls"},
};

inline Scene hub(Hub kind, int count) {
  Scene scene;
  const auto body = [&](const Vector3& position) {
    Body& x = scene.bodies.emplace_back();
    x.name = fmt::format("part {}", scene.bodies.size());
    x.mass = 1;
    x.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
    x.position = position;
    return static_cast<int>(scene.bodies.size()) - 1;
  };
  const auto join = [&](int i, int j, const Vector3& point, JointType type = JointType::revolute) {
    Joint& x = scene.joints.emplace_back();
    x.name = fmt::format("joint {}", scene.joints.size());
    x.type = type;
    x.i = i, x.j = j;
    x.point = point;
    x.axis = Vector3::UnitZ();
  };
  const auto polar = [](double r, double angle) { return Vector3(r * std::cos(angle), r * std::sin(angle), 0); };
  scene.gravity = {1, -2, 0};
  const int centre = body({0, kind == Hub::cranks || kind == Hub::ball_cranks ? 1.0 : 0.0, 0});
  if (kind == Hub::cranks || kind == Hub::ball_cranks) {
    for (int k = 0; k < count; ++k) {
      const Vector3 foot(0.1 * k, 0, 0);
      const int crank = body(foot + Vector3(0, 0.5, 0));
      join(kGround, crank, foot);
      join(crank, centre, foot + Vector3::UnitY(), kind == Hub::cranks ? JointType::revolute : JointType::spherical);
    }
    return scene;
  }
  join(kGround, centre, Vector3::Zero());
  if (kind == Hub::two_hubs) {
    const Vector3 apart(1.5, 0, 0);
    const int other = body(apart);
    for (int k = 0; k < count; ++k) {
      const Vector3 foot = polar(1, 2 * std::numbers::pi * k / count), knee = foot + Vector3(0.8, 0.7, 0);
      const int thigh = body(foot + Vector3(0.4, 0.3, 0)), shank = body(knee + Vector3(0.3, -0.3, 0));
      join(centre, thigh, foot);
      join(thigh, shank, knee);
      join(shank, other, foot + apart);
    }
    return scene;
  }
  int last = centre;
  for (int k = 0; k < count; ++k) {
    const double angle = kind == Hub::four_bars ? 2 * std::numbers::pi * k / count : 0.1 * k;
    const double part = kind == Hub::four_bars ? 2.0 / count : 0.05;
    const double apart = kind == Hub::flat_triangles ? 0.0 : kind == Hub::far_triangles ? 8.0 : 0.01;
    const Vector3 height(0, 0, apart * (kind == Hub::far_triangles ? k : k % 100));
    const int arm = body(polar(2, angle) + height);
    if (kind == Hub::far_triangles) scene.bodies.back().inertia *= 1 + height.squaredNorm();
    join(centre, arm, polar(1, angle));
    if (kind == Hub::twice) join(centre, arm, polar(1, angle) + Vector3(0, 0, 0.5));
    if (kind != Hub::twice && kind != Hub::four_bars && k > 0) join(last, arm, polar(1.5, angle - part));
    last = arm;
    if (kind == Hub::four_bars) {
      const int coupler = body(polar(2, angle + part / 2)), other = body(polar(1.5, angle + part));
      join(arm, coupler, polar(2, angle));
      join(coupler, other, polar(2, angle + part));
      join(other, centre, polar(1, angle + part));
    }
  }
  return scene;
}

}  // namespace poinsot::test
