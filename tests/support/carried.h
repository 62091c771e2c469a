// Many loops that constrain too often, on a body that turns about the y axis, and the same without redundancy.
#pragma once

#include <fmt/format.h>

#include "core/scene.h"

namespace poinsot::test {

class Carried {
 public:
  // Four-bars side by side, joined by nothing but the body that carries them.
  static Scene four_bars(int count, bool redundant) {
    Carried made(redundant);
    for (int k = 0; k < count; ++k) {
      const double x = 0.3 * k;
      const Vector3 A(x, 0, 0), B(x, 0.2, 1), C(x, 1.3, 1.1), D(x, 1, 0);
      const int a = made.rod(A, B), b = made.rod(B, C), c = made.rod(C, D);
      made.join(JointType::revolute, 0, a, A);
      made.join(JointType::spherical, a, b, B);
      made.join(JointType::cylindrical, b, c, C);
      made.join(JointType::revolute, c, 0, D);
    }
    return made.scene_;
  }

  // Two chains of rods with rungs between them, so that each cell leans on the one before.
  static Scene ladder(int cells, bool redundant) {
    Carried made(redundant);
    int left = 0, right = 0;
    const auto at = [](int k, double z) { return Vector3(0, k + (z > 0 ? 0.1 * (k % 3) : 0.0), z); };
    for (int k = 0; k < cells; ++k) {
      const Vector3 p = at(k + 1, 0), q = at(k + 1, 1);
      const int l = made.rod(at(k, 0), p), r = made.rod(at(k, 1), q), rung = made.rod(p, q);
      made.join(JointType::revolute, left, l, at(k, 0));
      made.join(JointType::revolute, right, r, at(k, 1));
      made.join(JointType::spherical, l, rung, p);
      made.join(JointType::cylindrical, rung, r, q);
      left = l, right = r;
    }
    return made.scene_;
  }

 private:
  explicit Carried(bool redundant) : redundant_(redundant) {
    scene_.name = "carried";
    scene_.gravity = {0, 0, -9.81};
    Body& base = scene_.bodies.emplace_back();
    base.name = "base";
    base.mass = 50;
    base.inertia = Vector3(20, 20, 20).asDiagonal();
    base.angular_velocity = kCarrierSpin;
    join(JointType::revolute, kGround, 0, Vector3::Zero(), Vector3::UnitY());
  }

  int rod(const Vector3& from, const Vector3& to) {
    Body& body = scene_.bodies.emplace_back();
    body.name = fmt::format("rod{}", scene_.bodies.size());
    body.mass = 1;
    body.inertia = Vector3(0.1, 0.1, 0.1).asDiagonal();
    body.position = 0.5 * (from + to);
    body.velocity = kCarrierSpin.cross(body.position);
    body.angular_velocity = kCarrierSpin;
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  void join(JointType type, int i, int j, const Vector3& point, const Vector3& axis = Vector3::UnitX()) {
    Joint& x = scene_.joints.emplace_back();
    x.name = fmt::format("joint{}", scene_.joints.size());
    x.type = redundant_ ? JointType::revolute : type;
    x.i = i, x.j = j;
    x.point = point;
    x.axis = axis;
  }

  inline static const Vector3 kCarrierSpin{0, 4, 0};
  bool redundant_;
  Scene scene_;
};

}  // namespace poinsot::test
