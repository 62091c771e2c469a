// A body that nothing holds, under a force along x.
#pragma once

#include "core/scene.h"

namespace poinsot::test {

inline Scene pushed(const char* force) {
  Scene scene;
  scene.name = "pushed";
  Body body;
  body.name = "body";
  body.mass = 1;
  body.inertia = Vector3(0.1, 0.2, 0.3).asDiagonal();
  scene.bodies.push_back(body);
  PointForce push;
  push.body = 0;
  push.force[0] = Expression::parse(force);
  scene.forces.push_back(push);
  return scene;
}

}  // namespace poinsot::test
