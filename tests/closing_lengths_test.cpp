// Prescribed distances that come to zero between steps or at their ends: no run goes over them.
#include "integrators/stepping/closing_lengths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/every_way.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

// A body on a slider along x, 1 m from the ground's origin and driven towards it.
Scene driven(const std::string& length) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "body", body.mass = 1, body.inertia = Matrix3::Identity(), body.position = {1, 0, 0};
  Joint& joint = scene.joints.emplace_back();
  joint.name = "slider", joint.type = JointType::translational, joint.i = kGround, joint.j = 0, joint.axis = {1, 0, 0};
  Driver& driver = scene.drivers.emplace_back();
  driver.name = "rope", driver.type = DriverType::distance, driver.i = kGround, driver.j = 0;
  driver.value = Expression::parse(length);
  body.velocity = {driver.value.at(0.0).fd, 0, 0};
  return scene;
}

// Where it is seen to close in steps of h over a second; none: infinity.
double closes_at(const std::string& length, double h) {
  const Model model = compile(driven(length));
  ClosingLengths lengths(model, 1);
  for (int n = 1; n * h <= 1; ++n)
    if (const Status status = lengths.look(n * h); !status.ok()) return status.time;
  return HUGE_VAL;
}

TEST(ClosingLengths, AreSeenWhateverTheStep) {
  const double at = 0.37;
  for (const char* f : {"abs(1 - t/0.37)", "(1 - t/0.37)^2", "sqrt((1 - t/0.37)^2)", "1 - t/0.37", "0.37 - t",
                        "cos(pi*t/0.74)^2", "1 - exp(-(200*(t - 0.37))^2)", "min(1, 1e6*abs(t - 0.37))"})
    for (const double h : {1e-3, 0.011, 0.1, 0.37}) EXPECT_NEAR(closes_at(f, h), at, 1e-8) << f << ' ' << h;
}

TEST(ClosingLengths, AreNotWhereTheyStayPositive) {
  for (const char* f : {"1", "1 + 0.5*sin(9*t)", "1e-7 + (1 - t/0.37)^2", "1 + t*sin(20*t)", "1e-3 + abs(1 - t/0.37)",
                        "sin(9*t)^2 + cos(9*t)^2", "1/(1 + 1e4*(t - 0.37)^2)", "1 - 0.999*exp(-(200*(t - 0.37))^2)"})
    for (const double h : {1e-3, 0.1}) EXPECT_EQ(closes_at(f, h), HUGE_VAL) << f << ' ' << h;
}

TEST(ClosingLengths, EndEveryRun) {
  for (const char* f : {"abs(1 - 2*t)", "(1 - 2.003*t)^2", "1 - 2.003*t"}) {
    const Scene scene = driven(f);
    const auto stops = [&](const Settings& settings) {
      const Recorded r = run(scene, settings);
      EXPECT_THAT(r.outcome.status.message, HasSubstr("driver 'rope' (/drivers/0)")) << f;
      EXPECT_NEAR(r.outcome.status.time, 0.5, 1e-3) << f;
      EXPECT_LE(r.samples.back().t, 0.5) << f;
    };
    in_every_way(5e-3, 1, stops);
    for (const std::string& formulation : formulation_names()) stops(kinematics(formulation, 0.04, 1));
  }
}

// Likewise of a constraint, whose function is the square.
TEST(ClosingLengths, AreThoseOfConstraintsToo) {
  Scene scene = driven("1");
  scene.drivers.clear();
  Constraint& d = scene.constraints.emplace_back();
  d.name = "rod", d.type = ConstraintType::D, d.i = kGround, d.j = 0;
  d.f = Expression::parse("(1 - 2.003*t)^2");
  scene.bodies[0].velocity = {-2.003, 0, 0};
  in_every_way(5e-3, 1, [&](const Settings& settings) {
    EXPECT_THAT(run(scene, settings).outcome.status.message,
                HasSubstr("constraint 'rod' (/constraints/0): the squared distance '(1 - 2.003*t)^2' comes to 0"));
  });
}

}  // namespace
}  // namespace poinsot::test
