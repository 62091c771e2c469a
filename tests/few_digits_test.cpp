// Redundant joints whose axes and points are written with few digits lock a mechanism, or a part of it: it is said why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/input_error.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFewDigits = "of few digits";

Vector3 rounded(const Vector3& x, int digits) {
  const double scale = std::pow(10, digits);
  return (scale * x).array().round() / scale;
}

// A door on three hinges about a skew axis, on a block that is free to move, which turns at a rate, rad/s.
Scene door(int digits, double rate = 0) {
  Scene scene;
  const Vector3 axis = Vector3(1, 2, 3).normalized(), at(0.1, -0.2, 0.3);
  for (const char* name : {"block", "door"}) {
    Body& body = scene.bodies.emplace_back();
    body.name = name, body.mass = 1, body.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
  }
  scene.bodies[1].position = at + axis.unitOrthogonal();
  scene.bodies[1].angular_velocity = rate * axis;
  scene.bodies[1].velocity = rate * axis.cross(scene.bodies[1].position - at);
  for (const double along : {0.0, 0.4, 0.7}) {
    Joint& hinge = scene.joints.emplace_back();
    hinge.name = fmt::format("hinge at {}", along), hinge.type = JointType::revolute, hinge.i = 0, hinge.j = 1;
    hinge.point = rounded(at + along * axis, digits), hinge.axis = rounded(axis, digits);
  }
  return scene;
}

std::vector<std::string> notices(const Scene& scene) {
  Settings settings;
  settings.end = 0.001;
  return simulate(scene, settings, [](const Sample&) {}).notices;
}

TEST(FewDigits, of_hinges_are_said_to_lock_a_door) {
  for (const int digits : {4, 5, 6, 8}) {
    SCOPED_TRACE(digits);
    EXPECT_THAT(notices(door(digits)), Contains(HasSubstr(kFewDigits)));
  }
  EXPECT_THAT(notices(door(13)), Each(Not(HasSubstr(kFewDigits))));
}

// What the rounded axes leave of its velocity is more than rounding.
TEST(FewDigits, of_hinges_are_said_to_contradict_a_velocity) {
  for (const int digits : {5, 6}) {
    SCOPED_TRACE(digits);
    try {
      notices(door(digits, 2));
      FAIL() << "not refused";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AnyOf(HasSubstr(kFewDigits), HasSubstr("write axes and points to more digits")));
    }
  }
  EXPECT_THAT(notices(door(13, 2)), Each(Not(HasSubstr(kFewDigits))));
}

// What they ask for beside the others is rounding: no step is short enough, and nothing of that is a singular position.
TEST(FewDigits, are_said_to_be_why_a_run_stops) {
  int stopped = 0;
  for (const int digits : {7, 8, 9})
    for (const char* integrator : {"auto", "radau5", "generalized_alpha"}) {
      Scene scene = door(digits);
      scene.gravity[2] = -9.81;
      Joint& hinge = scene.joints.emplace_back();
      hinge.name = "frame", hinge.type = JointType::revolute, hinge.i = kGround, hinge.j = 0, hinge.axis = {1, 0, 0};
      Settings settings;
      settings.integrator = integrator, settings.end = 0.5;
      const Status status = simulate(scene, settings, [](const Sample&) {}).status;
      if (status.ok()) continue;
      ++stopped;
      EXPECT_THAT(status.message, HasSubstr("write axes and points with 12 digits or more")) << digits << integrator;
      EXPECT_THAT(status.message, Not(HasSubstr("singular position of the mechanism"))) << digits << integrator;
    }
  EXPECT_GT(stopped, 0);
}

TEST(FewDigits, are_not_what_models_have) {
  for (const std::string& name : model_names()) {
    SCOPED_TRACE(name);
    EXPECT_THAT(notices(scene_of(name)), Each(Not(HasSubstr(kFewDigits))));
  }
}

}  // namespace
}  // namespace poinsot::test
