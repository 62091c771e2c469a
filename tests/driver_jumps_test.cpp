// Drivers that jump without a sign or a step to tell of it, or by half a turn, which the row of an angle does not feel:
// no run goes over them.
#include "integrators/stepping/driver_jumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/every_way.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

// On a slider or a hinge, driven.
Scene driven(DriverType type, const std::string& f) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "body", body.mass = 1, body.inertia = Matrix3::Identity(), body.position = {1, 0, 0};
  Joint& joint = scene.joints.emplace_back();
  joint.name = "joint", joint.i = kGround, joint.j = 0;
  Driver& driver = scene.drivers.emplace_back();
  driver.name = "motor", driver.type = type, driver.i = kGround, driver.j = 0;
  driver.value = Expression::parse(f);
  if (type == DriverType::angle) {
    joint.axis = driver.axis = {0, 0, 1}, driver.a_i = driver.a_j = {1, 0, 0};
  } else {
    joint.type = JointType::translational, joint.axis = {1, 0, 0};
  }
  return scene;
}

// Where it is seen to jump in steps of h over a second; none: infinity.
double seen(const std::string& f, double h) {
  const Model model = compile(driven(DriverType::distance, f));
  DriverJumps jumps(model, 1);
  for (int n = 1; n * h <= 1; ++n)
    if (const Status status = jumps.look(n * h); !status.ok()) {
      EXPECT_THAT(status.message, HasSubstr("driver 'motor' prescribes a jump of positions"));
      return status.time;
    }
  return HUGE_VAL;
}

TEST(DriverJumps, AreSeenWhateverTheStep) {
  const double at = 0.37;
  for (const char* f : {"2 + 0.1*step(t - 0.37)", "2 + 3*t + 1e-3*sign(t - 0.37)", "2 + 0.1*atan(1/(t - 0.37))",
                        "2 + 0.1*(t - 0.37)/sqrt((t - 0.37)^2)", "2 + 0.2*tanh(1e13*(t - 0.37))",
                        "2 + sin(t) + 0.1*min(1, max(0, 1e12*(t - 0.37)))",
                        "2 + 0.1*atan2(sin(5*(t - 0.37)), -cos(5*(t - 0.37)))", "2 + 0.1*atan(tan(t - 0.37 + pi/2))"})
    for (const double h : {1e-3, 0.011, 0.1}) EXPECT_NEAR(seen(f, h), at, 1e-9) << f << ' ' << h;
}

TEST(DriverJumps, AreNotWhereAFunctionIsContinuous) {
  for (const char* f : {"2 + sin(3*t)", "2 + sin(300*t)", "2 + abs(t - 0.3)", "2 + sqrt(abs(t - 0.5))",
                        "2 + 0.1*tanh(1e4*(t - 0.37))", "2 + 0.1*acos(cos(30*t))", "2 + max(0, sin(20*t))", "2 + t^0.5",
                        "2 + atan2(sin(t), cos(t))", "1e6 + 1e3*t", "2 + 0.1*sqrt((t - 0.31)^2)"})
    for (const double h : {1e-3, 0.011, 0.1}) EXPECT_EQ(seen(f, h), HUGE_VAL) << f << ' ' << h;
}

// Half a turn off, a hinge satisfies the sine of its driver's angle as well.
TEST(DriverJumps, OfHalfATurnEndEveryRun) {
  for (const char* f : {"4.5*t + pi*step(t - 0.35)", "4.5*t + 2*pi*step(t - 0.35)", "0.5*atan2(sin(9*t), cos(9*t))",
                        "4.5*t + pi*tanh(1e13*(t - 0.35))"}) {
    const Scene scene = driven(DriverType::angle, f);
    const auto stops = [&](const Settings& settings) {
      const Recorded r = run(scene, settings);
      EXPECT_EQ(r.outcome.status.failure, Failure::inconsistent_state) << f;
      EXPECT_THAT(r.outcome.status.message, HasSubstr("prescribes a jump of positions")) << f;
      EXPECT_LE(r.samples.back().t, 0.351) << f;
    };
    in_every_way(5e-3, 1, stops);
    for (const std::string& formulation : formulation_names()) stops(kinematics(formulation, 5e-3, 1));
  }
}

// And a second driver, whose row depends on the first one's, asks for half a turn more from then on.
TEST(DriverJumps, OfRedundantDriversEndTheRun) {
  Scene scene = driven(DriverType::angle, "t^2");
  scene.drivers.push_back(driven(DriverType::angle, "t^2 + pi*step(t - 0.4)").drivers[0]);
  scene.drivers[1].name = "other";
  in_every_way(5e-3, 1, [&](const Settings& settings) {
    EXPECT_EQ(run(scene, settings).outcome.status.failure, Failure::inconsistent_state);
  });
}

TEST(DriverJumps, OfALengthEndEveryRun) {
  const Scene scene = driven(DriverType::distance, "1.5 - 0.5 + 0.1*atan2(sin(9*t), cos(9*t))");
  const auto stops = [&](const Settings& settings) {
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::inconsistent_state);
    EXPECT_THAT(r.outcome.status.message, HasSubstr("driver 'motor' (/drivers/0) prescribes a jump of positions"));
    EXPECT_NEAR(r.outcome.status.time, 0.349065850, 1e-8);
  };
  in_every_way(5e-3, 1, stops);
  for (const std::string& formulation : formulation_names())
    for (const double step : {1e-3, 0.02, 0.05}) stops(kinematics(formulation, step, 1));
}

}  // namespace
}  // namespace poinsot::test
