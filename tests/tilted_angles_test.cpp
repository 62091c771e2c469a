// Angles of drivers and torsion springs on bodies whose axes do not stay together: whose direction they are that of,
// and where there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using Turn = Eigen::AngleAxisd;

// A body that hangs on a joint in the origin, all turned about the vertical by an angle.
Scene hung(JointType type, double turned) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const Matrix3 by = Turn(turned, Vector3::UnitZ()).toRotationMatrix();
  Body& body = scene.bodies.emplace_back();
  body.name = "b", body.mass = 1, body.inertia = 0.05 * Matrix3::Identity();
  body.position = by * Vector3(0.6, 0.2, -0.3);
  Joint& joint = scene.joints.emplace_back();
  joint.name = "joint", joint.type = type, joint.i = kGround, joint.j = 0;
  if (type == JointType::revolute) joint.axis = {0, 0, 1};
  if (type == JointType::universal) joint.axis_i = {0, 0, 1}, joint.axis_j = by * Vector3::UnitY();
  return scene;
}

void drive(Scene& scene) {
  Driver& motor = scene.drivers.emplace_back();
  motor.name = "motor", motor.type = DriverType::angle, motor.i = kGround, motor.j = 0;
  motor.axis = {0, 0, 1}, motor.value = Expression::parse("2*t^2");
}

void spring(Scene& scene, const Vector3& direction) {
  TorsionSpring twist;
  twist.name = "twist", twist.i = kGround, twist.j = 0, twist.axis = {0, 0, 1};
  twist.a_i = twist.a_j = direction;
  twist.stiffness = 3, twist.angle = 1;
  scene.forces.emplace_back(twist);
}

class TiltedAngles : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, TiltedAngles, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// About one axis of a universal joint the other one stays across, however the global axes lie.
TEST_P(TiltedAngles, OnAUniversalJointAreThoseOfItsOtherAxis) {
  for (const bool driven : {true, false}) {
    std::vector<Vector3> ends;
    for (const double turned : {0.0, 0.7, 2.0}) {
      Scene scene = hung(JointType::universal, turned);
      if (driven)
        drive(scene);
      else
        spring(scene, Vector3::Zero());
      const Recorded r = run(scene, controlled("auto", GetParam(), 1e-9, 2, 2));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, Not(Contains(HasSubstr("tilted"))));
      ends.push_back(Turn(-turned, Vector3::UnitZ()) * r.samples.back().bodies[0].r);
      if (!driven) continue;
      const Matrix3 now = r.samples.back().bodies[0].A;  // its y axis was the joint's
      const Vector3 across =
          Turn(-turned - 8, Vector3::UnitZ()) * (now * (Turn(turned, Vector3::UnitZ()) * Vector3::UnitY()));
      EXPECT_NEAR(across.y(), 1, 1e-9);
    }
    for (const Vector3& end : ends) EXPECT_LT((end - ends[0]).norm(), 1e-6) << driven;
  }
}

// Elsewhere the choice is told once it matters.
TEST_P(TiltedAngles, ThatNobodyNamedAreToldWhereTheAxisTilts) {
  const auto notices = [&](Scene scene) {
    const Recorded r = run(scene, controlled("auto", GetParam(), 1e-9, 0.3, 0.3));
    EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    return r.outcome.notices;
  };
  const auto told = Contains(HasSubstr("has tilted by"));
  Scene ball = hung(JointType::spherical, 0);
  spring(ball, Vector3::Zero());
  EXPECT_THAT(notices(ball), Contains(HasSubstr("torsion spring 'twist' has tilted by")));
  Scene driven = hung(JointType::spherical, 0);
  drive(driven);
  EXPECT_THAT(notices(driven), Contains(HasSubstr("driver 'motor' (/drivers/0) has tilted by")));
  Scene named = hung(JointType::spherical, 0);
  spring(named, {1, 0, 0});
  EXPECT_THAT(notices(named), Not(told));
  Scene hinge = hung(JointType::revolute, 0);
  spring(hinge, Vector3::Zero());
  EXPECT_THAT(notices(hinge), Not(told));
}

// A hinge that is closed from a rough pose turns the second body's axis onto the first one's: that is no tilt.
TEST_P(TiltedAngles, OnAHingeDoNotTiltWhereItIsAssembled) {
  Scene scene = hung(JointType::revolute, 0);
  scene.joints[0].axis.setZero();
  scene.joints[0].frames = JointFrames{{0, 0, 0}, {-0.6, -0.2, 0.3}, {0, 0, 1}, {0, 0, 1}};
  scene.bodies[0].orientation = Turn(0.3, Vector3::UnitX()).toRotationMatrix();
  spring(scene, Vector3::Zero());
  const Recorded r = run(scene, controlled("auto", GetParam(), 1e-9, 0.3, 0.3));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_THAT(r.outcome.notices, Not(Contains(HasSubstr("tilted"))));
}

// The spring's direction goes through its axis: there it has no angle, and beyond it one that is half a turn off.
TEST_P(TiltedAngles, EndWhereTheirDirectionComesToLieAlongTheAxis) {
  Scene scene = hung(JointType::universal, 0);
  spring(scene, {1, 0, 0});
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings = controlled(integrator.name, GetParam(), 1e-8, 2, 2);
    settings.step = 1e-3;
    const Recorded r = run(scene, settings);
    ASSERT_FALSE(r.outcome.status.ok());
    EXPECT_THAT(r.outcome.status.message, HasSubstr("torsion spring 'twist' has no angle where"));
    EXPECT_NEAR(r.outcome.status.time, 0.934, 0.02);
  }
  // With a direction that stays across it is an angle for as long as one likes.
  Scene other = hung(JointType::universal, 0);
  spring(other, {0, 1, 0});
  EXPECT_TRUE(run(other, controlled("auto", GetParam(), 1e-9, 2, 2)).outcome.status.ok());
}

}  // namespace
}  // namespace poinsot::test
