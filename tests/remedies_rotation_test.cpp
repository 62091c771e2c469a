// Steps that turn bodies too far: the step that the stop offers goes to the end of the same run, in the plane and in
// space, by every method of fixed steps in every formulation and in kinematics.
#include <gtest/gtest.h>

#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/remedies.h"

namespace poinsot::test {
namespace {

Scene wheel(double rate, const char* driver) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "wheel", body.mass = 1, body.inertia = Vector3(1, 1, 1).asDiagonal();
  body.angular_velocity = {0, 0, rate};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  if (driver) {
    Driver& motor = scene.drivers.emplace_back();
    motor.name = "motor", motor.i = kGround, motor.j = 0, motor.axis = {0, 0, 1};
    motor.value = Expression::parse(driver);
  } else {
    TorsionSpring spring;
    spring.name = "soft", spring.i = kGround, spring.j = 0, spring.axis = {0, 0, 1}, spring.stiffness = 1;
    scene.forces.push_back(spring);
  }
  return scene;
}

Scene tumbling(const Vector3& inertia) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "body", body.mass = 1, body.inertia = inertia.asDiagonal();
  body.angular_velocity = Vector3(0.3, 0.9, 0.3).normalized();
  return scene;
}

// A rod on a hinge, let go level.
Scene falling_rod() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  Body& rod = scene.bodies.emplace_back();
  rod.name = "rod", rod.mass = 1, rod.inertia = Vector3(0.001, 1.0 / 12, 1.0 / 12).asDiagonal();
  rod.position = {0.5, 0, 0};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  return scene;
}

// Calls visit(settings) for each method of fixed steps and formulation.
template <class Visit>
int in_every_fixed_way(double step, double end, Visit&& visit) {
  int ways = 0;
  in_every_way(step, end, [&](Settings settings) {
    if (integrators().require(settings.integrator).controls_error) return;
    settings.stopping = Settings{}.stopping;
    settings.tolerance = 1e-8;
    visit(settings);
    ++ways;
  });
  return ways;
}

struct TooFar {
  const char* what;
  Scene scene;
  double step, end;
  const char* of;
};

std::vector<TooFar> turning_too_far() {
  return {{"a torsion spring", wheel(100, nullptr), 0.0305, 0.5, "'"},
          {"a driven wheel", wheel(100, "100*t"), 0.05, 1, "wheel"},
          {"a tumbling body", tumbling({1, 2, 3}), 3.3, 20, "body 'body'"},
          {"a tumbling slender body", tumbling({0.5, 1, 1}), 3.3, 20, "body 'body'"},
          {"a falling rod", falling_rod(), 0.5, 5, "rod"}};
}

TEST(RemediesOfRotation, AreStepsThatGoToTheEnd) {
  for (const TooFar& far : turning_too_far()) {
    int offered = 0;
    const int ways = in_every_fixed_way(far.step, far.end, [&](const Settings& settings) {
      SCOPED_TRACE(far.what);
      const Recorded stopped = run(far.scene, settings);
      ASSERT_FALSE(stopped.outcome.status.ok());
      const std::string& message = stopped.outcome.status.message;
      EXPECT_THAT(message, ::testing::HasSubstr(fmt::format("t = {:.9g} s", stopped.outcome.status.time)));
      EXPECT_THAT(message, ::testing::HasSubstr(far.of));
      const std::optional<double> step = offered_step(message);
      if (!step) {  // Newton's method had failed before
        EXPECT_THAT(message, ::testing::HasSubstr("try an integrator with error control"));
        return;
      }
      ++offered;
      EXPECT_LE(*step, settings.step);
      EXPECT_GE(*step, 1e-4 * settings.step) << "is no step that anyone would take";
      expect_helped(far.scene, with_step(settings, *step));
    });
    EXPECT_EQ(ways, 15);
    EXPECT_GE(offered, 14) << far.what;
  }
}

// Where bodies turn faster and faster the step that is offered goes on for as long as it was good for.
TEST(RemediesOfRotation, GoOnWhereBodiesTurnFasterStill) {
  const Scene scene = wheel(0, "50*t^2");
  in_every_fixed_way(0.05, 1.5, [&](const Settings& settings) {
    const Recorded stopped = run(scene, settings);
    ASSERT_EQ(stopped.outcome.status.failure, Failure::rotation_too_large) << stopped.outcome.status.message;
    const std::optional<double> step = offered_step(stopped.outcome.status.message);
    ASSERT_TRUE(step) << stopped.outcome.status.message;
    const Recorded further = run(scene, with_step(settings, *step));
    EXPECT_GT(further.samples.back().t, std::min(1.5, 3 * stopped.outcome.status.time) - 1e-9);
  });
}

// Where steps are so long that a method diverges, what it makes of a body says nothing of the step to take.
TEST(RemediesOfRotation, AreNotMadeOfWhatDiverged) {
  const Scene scene = loop({4, Frames::random, true, true});
  int offered = 0;
  in_every_fixed_way(0.07, 2, [&](Settings settings) {
    settings.tolerance = 1e-3;
    const Recorded stopped = run(scene, settings);
    const auto step = offered_step(stopped.outcome.status.message);
    if (!step) return;
    ++offered;
    EXPECT_GE(*step, 1e-3 * settings.step) << stopped.outcome.status.message;
    const Recorded further = run(scene, with_step(settings, *step));
    EXPECT_GT(further.samples.back().t, stopped.samples.back().t);
  });
  EXPECT_GT(offered, 0);
}

TEST(RemediesOfRotation, OfKinematicsAreStepsThatItCanFollow) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const char* angle : {"1e4*t", "1e6*t", "1e12*t"}) {
      SCOPED_TRACE(fmt::format("{} {}", formulation.name, angle));
      const Scene scene = wheel(0, angle);
      const Recorded stopped = run(scene, kinematics(formulation.name, 1, 3));
      expect_stopped(stopped, Failure::rotation_too_large, "body 'wheel'", "try a step of at most");
      const std::optional<double> step = offered_step(stopped.outcome.status.message);
      ASSERT_TRUE(step);
      expect_helped(scene, with_step(kinematics(formulation.name, 1, 100 * *step), *step));
    }
  }
}

// Where no step is short enough the driver is what is wrong, whatever the analysis.
TEST(RemediesOfRotation, OfADriverThatIsFasterThanTimesAreAnotherFunction) {
  for (const FormulationEntry& formulation : formulations())
    for (const char* angle : {"1e17*t", "1e100*t", "1e300*t"}) {
      Settings settings = kinematics(formulation.name, 0.1, 1);
      for (const char* integrator : {"", "dop853", "rattle"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", formulation.name, angle, integrator));
        if (*integrator) settings.analysis = Analysis::dynamics, settings.integrator = integrator;
        const Recorded stopped = run(wheel(0, angle), settings);
        expect_stopped(stopped, Failure::rotation_too_large, "driver '", "from one time to the next");
        EXPECT_EQ(remedy_of(stopped), "; change the function");
        expect_helped(wheel(0, "t"), settings);
      }
    }
  Settings settings = kinematics("rA", 0.01, 1);
  const Scene later = wheel(0, "1e17*max(0, t - 0.505)");
  const Recorded stopped = run(later, settings);
  expect_stopped(stopped, Failure::rotation_too_large, "driver '", "from one time to the next");
  EXPECT_EQ(remedy_of(stopped), "; end before it, or change the function");
  settings.end = 0.5;
  expect_helped(later, settings);
}

}  // namespace
}  // namespace poinsot::test
