// A wheel on a torsion spring that turns to and fro about a fixed axis, its centre at rest.
#pragma once

#include "core/scene.h"

namespace poinsot::test {

// Begins unloaded at `rate`, rad/s; `stiffness`: N m/rad, of a moment of inertia of 3 kg m².
inline Scene sprung_wheel(double rate, double stiffness) {
  Scene scene;
  Body wheel;
  wheel.name = "wheel", wheel.mass = 1, wheel.inertia = Vector3(1, 2, 3).asDiagonal();
  wheel.angular_velocity = {0, 0, rate};
  scene.bodies.push_back(wheel);
  Joint hinge;
  hinge.type = JointType::revolute, hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  TorsionSpring spring;
  spring.i = kGround, spring.j = 0, spring.axis = {0, 0, 1}, spring.stiffness = stiffness;
  scene.forces.push_back(spring);
  return scene;
}

}  // namespace poinsot::test
