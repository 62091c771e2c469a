// A body without moment about an axis, held about it by a rope alone, which does not where the scene begins.
#pragma once

#include "core/scene.h"

namespace poinsot::test {

// Of a body, which is put to the origin: its matrix is singular at t = 0, though not at every pose.
inline void spin_at_the_start(Scene& scene, int body) {
  Body& rod = scene.bodies[static_cast<std::size_t>(body)];
  rod.inertia = Vector3(0, 1, 1).asDiagonal();
  rod.position.setZero(), rod.orientation.setIdentity();
  rod.velocity.setZero(), rod.angular_velocity.setZero();
  Constraint& rope = scene.constraints.emplace_back();
  rope.name = "rope", rope.type = ConstraintType::D, rope.j = body;
  rope.s_i = {0, 1.125, 0}, rope.s_j = {0, 0.125, 0};
  rope.f = Expression(1);
}

}  // namespace poinsot::test
