// Mechanisms of as many bodies as asked for, give or take a few, in which loops meet in different ways.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "core/index.h"
#include "core/scene.h"
#include "tests/support/carried.h"
#include "tests/support/hubs.h"

namespace poinsot::test {

// Rods between points of a plane, or of several, on hinges across it.
class Rods {
 public:
  int rod(const Vector3& from, const Vector3& to) { return body(0.5 * (from + to)); }
  int body(const Vector3& position) {
    Body& x = scene.bodies.emplace_back();
    x.name = fmt::format("part {}", scene.bodies.size());
    x.mass = 1;
    x.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
    x.position = position;
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  void join(int i, int j, const Vector3& point, const Vector3& axis = Vector3::UnitZ(),
            JointType type = JointType::revolute) {
    Joint& x = scene.joints.emplace_back();
    x.name = fmt::format("joint {}", scene.joints.size());
    x.type = type;
    x.i = i, x.j = j;
    x.point = point;
    x.axis = axis;
  }
  // A ladder in the x-y plane from two points of a body, along `along`.
  void ladder(int on, const Vector3& p, const Vector3& q, const Vector3& along, int cells) {
    int left = on, right = on;
    for (int k = 0; k < cells; ++k) {
      const Vector3 a = p + k * along, b = q + k * along;
      const int l = rod(a, a + along), r = rod(b, b + along), rung = rod(a + along, b + along);
      join(left, l, a);
      join(right, r, b);
      join(l, rung, a + along);
      join(rung, r, b + along);
      left = l, right = r;
    }
  }
  // A four-bar on two points of a body, with hinges about `axis`.
  int four_bar(int on, const Vector3& p, const Vector3& q, const Vector3& up, const Vector3& axis) {
    const Vector3 a = p + up, b = q + 1.2 * up + 0.1 * (q - p);
    const int crank = rod(p, a), coupler = rod(a, b), rocker = rod(b, q);
    join(on, crank, p, axis);
    join(crank, coupler, a, axis);
    join(coupler, rocker, b, axis);
    join(rocker, on, q, axis);
    return coupler;
  }

  Scene scene;
};

inline Vector3 on_circle(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

// Some hundred ladders round one free body.
inline Scene star_of_ladders(int bodies) {
  Rods made;
  constexpr int kCells = 8;
  const int arms = bodies / (3 * kCells), centre = made.body(Vector3::Zero());
  for (int k = 0; k < arms; ++k) {
    const double angle = 2 * std::numbers::pi * k / arms;
    const Vector3 out = on_circle(1, angle), across = 0.3 * Vector3::UnitZ().cross(out);
    made.ladder(centre, out, out + across, out, kCells);
  }
  return made.scene;
}

// Rods along all edges of a net of squares, hinged where they meet: rigid but for its outline's skew.
inline Scene grid(int bodies) {
  Rods made;
  constexpr int kWide = 6;
  const int rows = bodies / (2 * kWide + 1);
  std::vector<int> at(kWide + 1, -1), below(kWide + 1, -1);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c <= kWide; ++c) {
      const Vector3 p(c + 0.1 * ((r + c) % 2), r, 0), right(c + 1 + 0.1 * ((r + c + 1) % 2), r, 0),
          up(c + 0.1 * ((r + 1 + c) % 2), r + 1, 0);
      const int across = c < kWide ? made.rod(p, right) : -1, rise = made.rod(p, up);
      int last = r == 0 && c == 0 ? kGround : -2;
      for (const int one : {at[index(c)], below[index(c)], across, rise}) {
        if (one < 0) continue;
        if (last != -2) made.join(last, one, p);
        last = one;
      }
      below[index(c)] = rise;
      if (c < kWide) at[index(c + 1)] = across;
    }
    at.assign(at.size(), -1);
  }
  return made.scene;
}

// Three bodies with legs between every two of them.
inline Scene three_hubs(int bodies) {
  Rods made;
  const Vector3 centre[] = {Vector3::Zero(), Vector3(3, 0, 0), Vector3(1, 3, 0)};
  int hub[3];
  for (int k = 0; k < 3; ++k) hub[k] = made.body(centre[k]);
  for (int k = 0; k < bodies / 2; ++k) {
    const int a = k % 3, b = (k + 1) % 3;
    const double angle = 2 * std::numbers::pi * k / (bodies / 2.0);
    const Vector3 p = centre[a] + on_circle(1, angle), q = centre[b] + on_circle(1, angle);
    const Vector3 knee = 0.5 * (p + q) + 0.6 * Vector3::UnitZ().cross(q - p).normalized();
    const int thigh = made.rod(p, knee), shank = made.rod(knee, q);
    made.join(hub[a], thigh, p);
    made.join(thigh, shank, knee);
    made.join(shank, hub[b], q);
  }
  return made.scene;
}

// Each four-bar stands on the coupler of the one before.
inline Scene chain_of_four_bars(int bodies) {
  Rods made;
  int on = kGround;
  for (int k = 0; k < bodies / 3; ++k) {
    const Vector3 p(0, 1.5 * k, 0);
    on = made.four_bar(on, p, p + Vector3::UnitX(), 0.8 * Vector3::UnitY(), Vector3::UnitZ());
  }
  return made.scene;
}

// A tree whose bodies hang on two hinges in line each.
inline Scene doubled_tree(int bodies) {
  Rods made;
  std::mt19937 random(1);
  for (int k = 0; k < bodies; ++k) {
    const int on = k == 0 ? kGround : static_cast<int>(random() % static_cast<unsigned>(k));
    const Vector3 foot = on == kGround ? Vector3::Zero() : made.scene.bodies[index(on)].position;
    const Vector3 axis = Vector3(1, static_cast<double>(k % 5), static_cast<double>(k % 3)).normalized();
    const int rod = made.body(foot + Vector3(0.3, -0.5, 0.1 * (k % 7)));
    made.join(on, rod, foot, axis);
    made.join(on, rod, foot + 0.2 * axis, axis);
  }
  return made.scene;
}

// Four-bars round one free body, each in a plane of its own.
inline Scene hub_of_planes(int bodies) {
  Rods made;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const int loops = bodies / 3, centre = made.body(Vector3::Zero());
  for (int k = 0; k < loops; ++k) {
    const Vector3 axis = Vector3(normal(random), normal(random), normal(random)).normalized();
    const Vector3 along = axis.unitOrthogonal(), up = axis.cross(along), p = 2 * on_circle(1, 0.37 * k);
    made.four_bar(centre, p, p + along, up, axis);
  }
  return made.scene;
}

struct LargeKind {
  std::string_view name;
  Scene (*make)(int bodies);
};
inline const LargeKind kLargeKinds[] = {
    {"hub", [](int bodies) { return hub(Hub::four_bars, bodies / 3); }},
    {"two_hubs", [](int bodies) { return hub(Hub::two_hubs, bodies / 2); }},
    {"three_hubs", &three_hubs},
    {"hub_of_planes", &hub_of_planes},
    {"hub_of_arms", [](int bodies) { return hub(Hub::twice, bodies); }},
    {"cranks", [](int bodies) { return hub(Hub::cranks, bodies); }},
    {"ladder", [](int bodies) { return Carried::ladder(bodies / 3, true); }},
    {"four_bars", [](int bodies) { return Carried::four_bars(bodies / 3, true); }},
    {"star_of_ladders", &star_of_ladders},
    {"grid", &grid},
    {"chain_of_four_bars", &chain_of_four_bars},
    {"doubled_tree", &doubled_tree},
};

}  // namespace poinsot::test
