// Velocities that a damper turns round in every step, and that hardly die out, are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kToAndFro = "change to and fro from step to step, and hardly less each time";

// 1 kg at 5 m/s on a soft spring with a damper of c, N s/m; beside it a body that falls.
Scene damped(double c, bool by_law = false) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (const char* name : {"slider", "falling"}) {
    Body& body = scene.bodies.emplace_back();
    body.name = name, body.mass = 1, body.inertia = Matrix3::Identity();
  }
  scene.bodies[0].position = {1, 0, 0};
  scene.bodies[0].velocity = {5, 0, 0};
  Joint& rail = scene.joints.emplace_back();
  rail.type = JointType::translational, rail.i = kGround, rail.j = 0, rail.axis = Vector3::UnitX();
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0, spring.length = 1;
  if (by_law)
    spring.law = Expression::parse_law(fmt::format("100*x + {}*v", c));
  else
    spring.stiffness = 100, spring.damping = c;
  scene.forces.push_back(spring);
  return scene;
}

Settings fixed_steps(const char* method, std::string_view formulation, double step) {
  Settings s;
  s.integrator = method, s.formulation = formulation, s.step = step, s.end = 0.5, s.every = 0.5;
  return s;
}

double speed_at_the_end(const Recorded& r) {
  return std::abs(r.samples.back().bodies[0].rd.x());
}

TEST(ToAndFro, velocities_that_a_damper_turns_round_are_told) {
  for (const std::string& formulation : formulation_names())
    for (const bool by_law : {false, true})
      for (const auto& [c, step] : {std::pair(5e3, 1e-2), {5e4, 1e-2}, {5e4, 1e-3}}) {
        SCOPED_TRACE(fmt::format("{} {} {} {}", formulation, by_law, c, step));
        const Scene scene = damped(c, by_law);
        const Recorded r = run(scene, fixed_steps("rattle", formulation, step));
        ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
        EXPECT_THAT(r.outcome.notices, Contains(HasSubstr(kToAndFro)));
        EXPECT_THAT(r.outcome.notices, Each(Not(HasSubstr("without bound"))));
        for (const char* remedy : {"radau5", "implicit_euler"})
          EXPECT_LT(speed_at_the_end(run(scene, fixed_steps(remedy, formulation, step))), 0.01) << remedy;
      }
}

// Where what is damped explicitly turns round by the factor 1 - h c/m = -1.
TEST(ToAndFro, velocities_that_only_turn_round_are_told) {
  for (const std::string& formulation : formulation_names()) {
    SCOPED_TRACE(formulation);
    const Recorded r = run(damped(2000, true), fixed_steps("half_implicit", formulation, 1e-3));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_GT(speed_at_the_end(r), 1);
    EXPECT_THAT(r.outcome.notices, Contains(HasSubstr(kToAndFro)));
  }
}

TEST(ToAndFro, dampers_that_steps_follow_are_not_told) {
  for (const std::string& formulation : formulation_names())
    for (const double c : {0.0, 1.0, 100.0, 1000.0, 3000.0}) {
      SCOPED_TRACE(fmt::format("{} {}", formulation, c));
      const Recorded r = run(damped(c), fixed_steps("rattle", formulation, 1e-3));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, Each(Not(HasSubstr("to and fro"))));
    }
}

constexpr const char* kMadeOfErrors = "small errors of positions and velocities make large forces";

double largest_acceleration_apart(const Recorded& a, const Recorded& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.samples.back().bodies.size(); ++k)
    most = std::max(most, (a.samples.back().bodies[k].rdd - b.samples.back().bodies[k].rdd).norm());
  return most;
}

// Two balls swing out, held by dampers that nothing moves within a step: velocities are right to 1e-3, what the dampers
// pull with is made of their error, ten times the truth.
TEST(ToAndFro, AccelerationsMadeOfErrorsAreTold) {
  const Scene scene = read_scene(fmt::format("{}/models/flyball_governor.json", POINSOT_SOURCE_DIR));
  for (const std::string& formulation : formulation_names()) {
    SCOPED_TRACE(formulation);
    Settings s = fixed_steps("rattle", formulation, 1e-3);
    s.end = 0.9, s.every = 0.1;
    const Recorded coarse = run(scene, s);
    EXPECT_THAT(coarse.outcome.notices, Contains(HasSubstr(kMadeOfErrors)));
    s.integrator = "dop853";
    const Recorded truth = run(scene, s);
    EXPECT_GT(largest_acceleration_apart(coarse, truth), 100);
    for (const char* remedy : {"radau5", "generalized_alpha"}) {
      s.integrator = remedy;
      EXPECT_LT(largest_acceleration_apart(run(scene, s), truth), 0.1) << remedy;
    }
  }
}

TEST(ToAndFro, AccelerationsThatVelocitiesFollowAreNotTold) {
  for (const auto& [name, step] : {std::pair("double_pendulum_joints", 1e-2),
                                   {"heavy_top", 1e-2},
                                   {"gyroscope", 1e-2},
                                   {"four_link_joints", 1e-2},
                                   {"andrews", 1e-5}}) {
    for (const std::string& formulation : formulation_names()) {
      SCOPED_TRACE(fmt::format("{} {}", name, formulation));
      Settings s = fixed_steps("rattle", formulation, step);
      s.end = 100 * step, s.every = 10 * step;
      const Recorded r = run(read_scene(fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, name)), s);
      EXPECT_THAT(r.outcome.notices, Each(Not(HasSubstr(kMadeOfErrors))));
    }
  }
}

}  // namespace
}  // namespace poinsot::test
