// A pendulum whose hinge has two drivers.
#pragma once

#include "core/expression.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

inline Scene twice_driven(const char* first, const char* second) {
  Scene scene = scene_of("single_pendulum_joints");
  scene.drivers.clear();
  for (const char* angle : {first, second}) {
    Driver& driver = scene.drivers.emplace_back();
    driver.name = angle;
    driver.type = DriverType::angle;
    driver.i = scene.joints[0].i, driver.j = scene.joints[0].j;
    driver.axis = scene.joints[0].axis;
    driver.value = Expression::parse(angle);
  }
  return scene;
}

}  // namespace poinsot::test
