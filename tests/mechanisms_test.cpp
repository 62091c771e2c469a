// Bodies that nothing joins are mechanisms of their own, and what one of them does is told whatever the others do.
#include "core/mechanisms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/model.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Scene bodies(int count) {
  Scene scene;
  for (int k = 0; k < count; ++k) {
    Body& body = scene.bodies.emplace_back();
    body.name = fmt::format("body {}", k), body.mass = 1, body.inertia = Matrix3::Identity();
    body.position = {static_cast<double>(k), 0, 0};
  }
  return scene;
}

template <class Part>
Part between(int i, int j) {
  Part part;
  part.i = i, part.j = j;
  return part;
}

TEST(Mechanisms, are_joined_by_all_but_the_ground) {
  Scene scene = bodies(12);
  scene.joints.push_back(between<Joint>(kGround, 0));
  scene.joints.push_back(between<Joint>(kGround, 1));
  scene.joints.push_back(between<Joint>(8, 2));
  for (Joint& joint : scene.joints) joint.type = JointType::spherical;
  Constraint rod = between<Constraint>(3, 2);
  rod.type = ConstraintType::CD, rod.c = Vector3::UnitX(), rod.f = Expression(-1.0);
  scene.constraints.push_back(rod);
  Driver driver = between<Driver>(4, 1);
  driver.type = DriverType::distance, driver.value = Expression(3.0);
  scene.drivers.push_back(driver);
  scene.forces.push_back(between<Spring>(5, 6));
  TorsionSpring torsion = between<TorsionSpring>(6, 7);
  torsion.axis = Vector3::UnitX();
  scene.forces.push_back(torsion);
  CallbackForce callback;
  callback.bodies = {9, 11}, callback.loads = [](double, auto, auto) {};
  scene.forces.push_back(callback);
  const std::vector<int> of = mechanisms(compile(scene));
  EXPECT_THAT(of, ElementsAre(0, 1, 2, 2, 1, 3, 3, 3, 2, 4, 5, 4));
  EXPECT_EQ(of_mechanism(compile(scene), of, 3), " of the mechanism of body 'body 5'");
  EXPECT_EQ(of_mechanism(compile(bodies(1)), mechanisms(compile(bodies(1))), 0), "");
}

// On a spring of the rate w, beside a body that a large force moves along evenly.
Scene beside_a_large_motion(double w) {
  Scene scene = bodies(2);
  scene.bodies[1].velocity = {0, 0.1, 0};
  Spring spring = between<Spring>(kGround, 1);
  spring.stiffness = w * w;
  scene.forces.push_back(spring);
  PointForce force;
  force.body = 0, force.force[2] = Expression(1e12);
  scene.forces.push_back(force);
  return scene;
}

TEST(Mechanisms, growth_of_one_is_told_beside_another) {
  for (const char* integrator : {"rattle", "half_implicit"})
    for (const std::string& formulation : formulation_names()) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, formulation));
      Settings settings = dynamics(formulation, 1e-3, 0.02);
      settings.integrator = integrator;
      const Recorded grows = run(beside_a_large_motion(2100), settings);
      EXPECT_THAT(grows.outcome.notices,
                  ElementsAre(HasSubstr("velocities of the mechanism of body 'body 1' (/bodies/1) change to and fro"),
                              HasSubstr("the energy of the mechanism of body 'body 1' (/bodies/1) ")));
      EXPECT_THAT(run(beside_a_large_motion(500), settings).outcome.notices, Not(Contains(HasSubstr("to and fro"))));
    }
}

TEST(Mechanisms, ringing_of_one_is_told_beside_another) {
  for (const std::string& formulation : formulation_names()) {
    SCOPED_TRACE(formulation);
    Settings settings = dynamics(formulation, 1e-3, 0.1);
    settings.integrator = "generalized_alpha";
    const Recorded rings = run(beside_a_large_motion(1e5), settings);
    EXPECT_THAT(rings.outcome.notices,
                ElementsAre(HasSubstr("accelerations of the mechanism of body 'body 1' (/bodies/1) turn round"),
                            HasSubstr("the energy of the mechanism of body 'body 1' (/bodies/1) ")));
    EXPECT_THAT(run(beside_a_large_motion(100), settings).outcome.notices, SizeIs(0));
  }
}

// What rests beside a motion moves by rounding alone, of which nothing is said.
TEST(Mechanisms, rest_beside_a_motion_is_no_motion) {
  Scene scene = bodies(3);
  scene.gravity = {0, 0, -9.81};
  scene.bodies[2].position = {3.1, 0, 0.7};
  scene.bodies[2].velocity = {0.1, 0, 0};
  for (const int body : {0, 1}) {
    Spring spring = between<Spring>(kGround, body);
    spring.s_i = scene.bodies[index(body)].position + Vector3(0.1, 0.2, 0.7);
    spring.length = Vector3(0.1, 0.2, 0.7).norm();
    spring.stiffness = body == 0 ? 300 : 3e6;
    scene.forces.push_back(spring);
  }
  PointForce held;
  held.force[2] = Expression(9.81);
  for (held.body = 0; held.body < 2; ++held.body) scene.forces.push_back(held);
  for (const char* integrator : {"implicit_euler", "rattle", "half_implicit", "generalized_alpha"})
    for (const std::string& formulation : formulation_names()) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, formulation));
      Settings settings = dynamics(formulation, 1e-3, 5);
      settings.integrator = integrator;
      EXPECT_THAT(run(scene, settings).outcome.notices, SizeIs(0));
    }
}

// The tolerance holds for each mechanism: what rests beside one does not loosen it. (`ida` weighs all as one.)
TEST(Mechanisms, steps_are_those_of_one_alone_whatever_rests_beside_it) {
  for (const char* integrator : {"auto", "dopri5", "dop853", "radau5"})
    for (const std::string& formulation : formulation_names()) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, formulation));
      Settings settings = dynamics(formulation, 1e-3, 1);
      settings.integrator = integrator, settings.rtol = 1e-6;
      Scene scene = scene_of("double_pendulum");
      const Recorded alone = run(scene, settings);
      for (Body& body : bodies(200).bodies) scene.bodies.push_back(body);
      for (int body = 2; body < 202; ++body) {
        Joint joint = between<Joint>(kGround, body);
        joint.type = JointType::fixed, joint.point = scene.bodies[index(body)].position;
        scene.joints.push_back(joint);
      }
      const Recorded beside = run(scene, settings);
      EXPECT_NEAR(static_cast<double>(beside.outcome.statistics.steps),
                  static_cast<double>(alone.outcome.statistics.steps), 1);
      EXPECT_LT((beside.samples.back().bodies[1].r - alone.samples.back().bodies[1].r).norm(), 1e-2 * settings.rtol);
    }
}

}  // namespace
}  // namespace poinsot::test
