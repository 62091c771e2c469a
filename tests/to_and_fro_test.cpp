// Velocities that a damper turns round in every step, and that hardly die out, are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace poinsot::test
