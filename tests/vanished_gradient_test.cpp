// A distance is said to have come to nothing beside its mechanism's lengths, not beside where the origin lies, nor a
// metre.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A rod about a point so far from the origin that holds a body by an arm, all in rods' lengths but the arm; and what
// pushes its end along x.
struct Rod {
  double length = 1, far = 0, arm = 0;
  double shortens = 0;  // by the second
  double x = 0.5, rate = 0.3;
  bool pushed = true;
};

Scene scene_with(const Rod& of) {
  Scene scene;
  const double L = of.length, x = of.pushed ? of.x : 1, y = -std::sqrt(1 - x * x);
  const double xd = of.pushed ? of.rate : -of.shortens, yd = of.pushed ? -(of.shortens + x * xd) / y : 0;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = 0.1 * L * L * Matrix3::Identity();
  bob.position = {of.far + x * L - of.arm, y * L, 0}, bob.velocity = {xd * L, yd * L, 0};
  const auto add = [&](ConstraintType type, const char* name) -> Constraint& {
    Constraint& c = scene.constraints.emplace_back();
    c.type = type, c.name = name, c.i = kGround, c.j = 0;
    if (type != ConstraintType::DP1) c.s_i = {of.far, 0, 0}, c.s_j = {of.arm, 0, 0};
    return c;
  };
  add(ConstraintType::D, "rod").f =
      of.shortens > 0 ? Expression::parse(fmt::format("{}*(1 - {}*t)^2", L * L, of.shortens)) : Expression(L * L);
  if (!of.pushed) return scene;
  Constraint& pusher = add(ConstraintType::CD, "pusher");
  pusher.c = Vector3::UnitX(), pusher.f = Expression::parse(fmt::format("{}*({} + {}*t)", L, of.x, of.rate));
  add(ConstraintType::CD, "plane").c = Vector3::UnitZ();
  for (int axis = 0; axis < 3; ++axis) {
    Constraint& held = add(ConstraintType::DP1, "");
    held.a_i = Vector3::Unit(axis), held.a_j = Vector3::Unit((axis + 1) % 3);
  }
  return scene;
}

std::string stop_of(const Scene& scene, const char* integrator) {
  Settings settings = dynamics("rA", 1e-3, 2);
  settings.integrator = integrator;
  const Outcome outcome = simulate(scene, settings, {});
  EXPECT_FALSE(outcome.status.ok());
  return outcome.status.message;
}

// Where what pushes asks the end beyond the rod.
TEST(VanishedGradient, is_no_reason_where_a_mechanism_is_far_or_small) {
  const Rod rods[] = {{.length = 1},
                      {.length = 5e-4},
                      {.length = 1e-5},
                      {.length = 1, .far = 1e4},
                      {.length = 5e-4, .arm = 1},
                      {.length = 1, .far = 1e4, .shortens = 0.4, .x = 0.4, .rate = 0}};
  for (const char* integrator : {"dop853", "rattle"})
    for (const Rod& rod : rods) {
      SCOPED_TRACE(fmt::format("{} {} {} {}", integrator, rod.length, rod.far, rod.arm));
      const std::string message = stop_of(scene_with(rod), integrator);
      EXPECT_THAT(message, Not(HasSubstr("has come to a length")));
      if (std::string_view(integrator) == "dop853") {
        EXPECT_THAT(message, HasSubstr("there for more than the mechanism reaches"));
      }
    }
}

TEST(VanishedGradient, is_told_of_a_length_that_is_driven_to_nothing) {
  for (Rod rod : {Rod{.length = 1}, Rod{.length = 5e-4}, Rod{.length = 1, .far = 1e4}}) {
    SCOPED_TRACE(fmt::format("{} {}", rod.length, rod.far));
    rod.shortens = 1, rod.pushed = false;
    EXPECT_THAT(
        stop_of(scene_with(rod), "rattle"),
        ::testing::AllOf(HasSubstr("constraint 'rod'"), HasSubstr("comes to 0"), HasSubstr("three CD constraints")));
  }
}

}  // namespace
}  // namespace poinsot::test
