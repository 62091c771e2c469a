// Generalized-alpha where a damper is far stiffer than its step.
#include <gmock/gmock.h>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A body that a drag stops within a hundredth of a step, and one that falls beside it.
Scene stopped(double drag) {
  Scene scene;
  scene.name = "stopped";
  scene.gravity = {0, 0, -9.81};
  for (const double x : {0.0, 1.0}) {
    Body body;
    body.name = x == 0 ? "stopped" : "falling";
    body.mass = 1;
    body.inertia = Vector3(0.1, 0.2, 0.3).asDiagonal();
    body.position = {x, 0, 0};
    body.velocity = {0, 1, 0};
    scene.bodies.push_back(body);
  }
  LinearDrag force;
  force.body = 0;
  force.translational = drag;
  scene.forces.push_back(force);
  return scene;
}

class StiffDamper : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(All, StiffDamper,
                         ::testing::Combine(::testing::Values("generalized_alpha", "generalized_alpha_i2"),
                                            ::testing::ValuesIn(formulation_names())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

TEST_P(StiffDamper, StopsABodyWithinTheFirstStep) {
  Settings s = dynamics(std::get<1>(GetParam()), 1e-3, 0.1, 0);
  s.integrator = std::get<0>(GetParam());
  for (const double drag : {1e4, 1e5, 1e6}) {
    const Recorded r = run(stopped(drag), s);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    const Snapshot& end = r.samples.back();
    // exact: 1/drag; within the first step, which is implicit, it is not resolved
    EXPECT_LT(std::abs(end.bodies[0].r.y()), 0.6e-3 + 1 / drag) << drag;
    EXPECT_LT(std::abs(r.samples[2].bodies[0].rd.y()), 2 / (1e-3 * drag)) << drag;
    EXPECT_NEAR(end.bodies[0].rd.z(), -9.81 / drag, 1e-2 / drag);
    EXPECT_NEAR(end.bodies[1].r.z(), -9.81 * 0.01 / 2, 1e-9) << drag;
    EXPECT_NEAR(end.bodies[1].r.y(), 0.1, 1e-12) << drag;
  }
}

TEST_P(StiffDamper, WhatRingsIsTold) {
  Settings s = dynamics(std::get<1>(GetParam()), 1e-3, 0.1, 0.1);
  s.integrator = std::get<0>(GetParam());
  Scene scene = stopped(1e5);
  PointForce kick;  // at 0.05 s
  kick.body = 0;
  kick.force[1] = Expression::parse("1e5*max(0, 1 - abs(t - 0.05)/0.001)");
  scene.forces.push_back(kick);
  const Recorded r = run(scene, s);
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  ASSERT_EQ(r.outcome.notices.size(), 2u);
  EXPECT_THAT(r.outcome.notices[1], HasSubstr("spectral_radius"));
  EXPECT_THAT(r.outcome.notices[1], HasSubstr("radau5"));
  EXPECT_THAT(run(scene_of("double_pendulum"), s).outcome.notices, IsEmpty());
  EXPECT_THAT(run(stopped(1), s).outcome.notices, IsEmpty());
}

// A body that is driven along a guide as if by a blow, without any damper or spring.
Scene driven_by_a_blow() {
  Scene scene;
  scene.name = "driven by a blow";
  Body& sled = scene.bodies.emplace_back();
  sled.name = "sled";
  sled.mass = 1;
  sled.inertia = Vector3(0.1, 0.2, 0.3).asDiagonal();
  sled.position = {1, 0, 0};
  Joint& guide = scene.joints.emplace_back();
  guide.name = "guide", guide.type = JointType::translational, guide.j = 0;
  guide.axis = Vector3::UnitX();
  Driver& leg = scene.drivers.emplace_back();
  leg.name = "leg", leg.type = DriverType::distance, leg.j = 0;
  leg.value = Expression::parse("1.01 + 0.01*tanh((t - 0.05)/0.0004)");
  return scene;
}

TEST_P(StiffDamper, WhatRingsAcrossConstraintsIsPutDownToNone) {
  Settings s = dynamics(std::get<1>(GetParam()), 1e-3, 0.2, 0.1);
  s.integrator = std::get<0>(GetParam());
  const auto told = [&] {
    const Recorded r = run(driven_by_a_blow(), s);
    EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    return fmt::format("{}", fmt::join(r.outcome.notices, "\n"));
  };
  EXPECT_THAT(told(), AllOf(Not(HasSubstr("damper")), HasSubstr("across the constraints")));
  s.step = 1e-5, s.tolerance = 1e-11 / (s.step * s.step);
  EXPECT_THAT(told(), Not(HasSubstr("across")));
  s.integrator = "radau5";
  EXPECT_THAT(told(), IsEmpty());
}

}  // namespace
}  // namespace poinsot::test
