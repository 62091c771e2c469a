// Contacts and catches that a step could pass over: laws of springs that do much over little of the way.
#include "integrators/stepping/passed_laws.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/controlled_ways.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::IsEmpty;

Scene flying(const Vector3& velocity, const char* law, double length) {
  Scene scene;
  Body ball;
  ball.name = "ball", ball.mass = 1, ball.inertia = Vector3(1, 1, 1).asDiagonal();
  ball.position = {-1, 0, 0}, ball.velocity = velocity;
  scene.bodies.push_back(ball);
  Spring spring;
  spring.j = 0, spring.length = length, spring.s_i = {-length, 0, 0};
  spring.law = Expression::parse_law(law);
  scene.forces.push_back(spring);
  return scene;
}

Scene balls(const Vector3& gravity) {
  Scene scene = flying({2, 0, 0}, "1e5*min(0, x)", 0.02);
  scene.gravity = gravity;
  Body other = scene.bodies[0];
  other.name = "other", other.position.setZero(), other.velocity.setZero();
  scene.bodies.push_back(other);
  Spring& contact = std::get<Spring>(scene.forces[0]);
  contact.i = 0, contact.j = 1;
  contact.s_i.setZero();
  return scene;
}

class PassedLawsTest : public ControlledWays {
 protected:
  Recorded moved(const Scene& scene, double end) const {
    const Recorded r = run(scene, settings(1e-8, end, end));
    EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_THAT(r.outcome.notices, IsEmpty());
    return r;
  }
};
INSTANTIATE_TEST_SUITE_P(All, PassedLawsTest, ::testing::ValuesIn(controlled_ways()), name_of_way);

// Balls of equal mass that meet in line exchange their velocities, at rest in space as well as in free fall.
TEST_P(PassedLawsTest, BallsThatMeetExchangeTheirVelocities) {
  for (const double g : {0.0, 9.81}) {
    const Recorded r = moved(balls({0, 0, -g}), 1);
    ASSERT_EQ(r.samples.size(), 2u);
    const auto& bodies = r.samples[1].bodies;
    EXPECT_NEAR(bodies[0].rd.x(), 0, 1e-4) << g;
    EXPECT_NEAR(bodies[1].rd.x(), 2, 1e-4) << g;
    EXPECT_NEAR(bodies[0].r.x() + bodies[1].r.x(), 1, 1e-6) << g;
    EXPECT_NEAR(bodies[0].rd.z(), -g, 1e-6) << g;
    EXPECT_LT(r.outcome.statistics.steps, 2000) << g;
  }
}

// A barrier of 10.6 or 5 J turns 2 J round, where it is smooth and where it has kinks; one of 1 J is passed.
TEST_P(PassedLawsTest, BarriersThatAreThinTurnBodiesRound) {
  for (const char* law : {"2000*exp(-(x/0.003)^2)", "5e6*max(0, 0.001 - abs(x))"}) {
    const Recorded r = moved(flying({2, 0, 0}, law, 3), 1);
    EXPECT_NEAR(r.samples.back().bodies[0].rd.x(), -2, 1e-4) << law;
  }
  const Recorded r = moved(flying({2, 0, 0}, "1e6*max(0, 0.001 - abs(x)) - 1e6*max(0, 0.001 - abs(x - 0.01))", 3), 1);
  EXPECT_NEAR(r.samples.back().bodies[0].rd.x(), 2, 1e-4);
}

// What is thin beside an ordinary spring in one and the same law is felt as it is in a law of its own: energy tells, by
// the potential of the thin part. At 1e-8 it was 1 J of 50 off where the law was looked at as a whole.
TEST_P(PassedLawsTest, WhatIsThinIsFeltBesideASpring) {
  const auto bell = [](double force, double width, double x) {
    return force * width * 0.5 * std::sqrt(std::numbers::pi) * std::erf(x / width);
  };
  const auto rounded = [](double x) { return std::abs(x) + std::log1p(std::exp(-2 * std::abs(x))); };
  const std::pair<const char*, std::function<double(double)>> laws[] = {
      {"100*x - 95*exp(-((x + 0.31)/0.0035)^2)", [&](double x) { return bell(-95, 0.0035, x + 0.31); }},
      {"100*x - 14.5*(tanh((x - 0.43)/0.0031) - tanh((x - 0.4393)/0.0031))",
       [&](double x) { return -14.5 * 0.0031 * (rounded((x - 0.43) / 0.0031) - rounded((x - 0.4393) / 0.0031)); }},
      {"20*x*(5 - 40*exp(-((x - 0.2)/0.004)^2))",  // 20 x 40 = 800 (x − 0.2) + 160
       [&](double x) {
         return bell(-160, 0.004, x - 0.2) + 400 * 0.004 * 0.004 * std::exp(-std::pow((x - 0.2) / 0.004, 2));
       }}};
  for (const auto& [law, thin] : laws) {
    Scene scene = flying({0, 0, 0}, law, 10);
    scene.bodies[0].position = {1, 0, 0};
    const auto energy = [&V = thin](const BodyState& at) {
      return 0.5 * at.rd.squaredNorm() + 50 * at.r.x() * at.r.x() + V(at.r.x());
    };
    const Recorded r = run(scene, settings(1e-8, 2, 0.01));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    for (const Snapshot& at : r.samples)
      ASSERT_NEAR(energy(at.bodies[0]), energy(r.samples[0].bodies[0]), 5e-5) << law << at.t;
  }
}

// So is what is thin in the rate.
TEST_P(PassedLawsTest, WhatIsThinInTheRateIsFeltBesideASpring) {
  Scene scene = flying({0, 0, 0}, "100*x + 13.4*exp(-((v + 3)/0.082)^2)", 10);
  scene.bodies[0].position = {1, 0, 0};
  const auto end = [&](const Settings& settings) { return run(scene, settings).samples.back().bodies[0].r.x(); };
  EXPECT_NEAR(end(settings(1e-8, 2, 2)), end(controlled("dop853", "rA", 1e-11, 2)), 1e-6);
}

// A wheel that comes to a tooth of 0.8 J with 0.5 J turns back, whatever it carries.
TEST_P(PassedLawsTest, CatchesTurnWheelsRound) {
  Scene scene = flying({0, 0, 0}, "0", 0);
  scene.forces.clear();
  scene.bodies[0].position.setZero();
  scene.bodies[0].angular_velocity = {0, 0, 1};
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  TorsionSpring tooth;
  tooth.i = kGround, tooth.j = 0, tooth.axis = {0, 0, 1}, tooth.angle = 1;
  tooth.law = Expression::parse_law("50*exp(-((x - 0.5)/0.01)^2)");
  scene.forces.push_back(tooth);
  const Recorded r = moved(scene, 3);
  EXPECT_NEAR(r.samples.back().bodies[0].w.z(), -1, 1e-4);
}

// A point on a wheel comes to a post, in steps that could turn the wheel round and round.
TEST_P(PassedLawsTest, PointsOnWheelsMeetPosts) {
  Scene scene = flying({0, 0, 0}, "0", 0);
  scene.forces.clear();
  scene.bodies[0].position.setZero();
  scene.bodies[0].angular_velocity = {0, 0, 10};
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  Spring post;
  post.j = 0, post.s_i = {1, 0.001, 0}, post.s_j = Vector3(0, -1, 0), post.length = 0.01;
  post.law = Expression::parse_law("1e7*min(0, x)");
  scene.forces.push_back(post);
  const Recorded r = moved(scene, 0.5);
  EXPECT_NEAR(r.samples.back().bodies[0].w.z(), -10, 1e-4);  // 500 J hold 50
}

// A force that jumps to and fro along the way, at both ends of a step the same: x = 1 + t − 5/2 t² up to 1.1, ...
TEST_P(PassedLawsTest, CombsAreFelt) {
  for (const char* law : {"5*sign(sin(10*x))", "5*(2*step(sin(7*x)) - 1)"}) {
    Scene scene = flying({1, 0, 0}, law, 1);
    scene.bodies[0].position.x() = 1, std::get<Spring>(scene.forces[0]).s_i.setZero();
    const Recorded r = moved(scene, 1.5);
    EXPECT_NEAR(r.samples.back().bodies[0].r.x(), 0.925, 1e-6) << law;
    EXPECT_NEAR(r.samples.back().bodies[0].rd.x(), 0.5, 1e-6) << law;
  }
}

// Forces that turn over within less than a step: what an estimate of the error makes of them is luck, up to some
// hundred tolerances. Energy tells, by the potential V.
TEST_P(PassedLawsTest, SteepForcesAreResolved) {
  const std::pair<const char*, double (*)(double)> laws[] = {
      {"5*tanh(1e4*x)", [](double x) { return 5e-4 * (1e4 * std::abs(x) + std::log1p(std::exp(-2e4 * std::abs(x)))); }},
      {"5*x/sqrt(x^2 + 1e-8)", [](double x) { return 5 * std::sqrt(x * x + 1e-8); }},
      {"5*atan(1e5*x)", [](double x) { return 5 * x * std::atan(1e5 * x) - 2.5e-5 * std::log1p(1e10 * x * x); }}};
  const double most = GetParam().integrator == "ida" ? 400 : 50;  // tolerances
  constexpr double kRtol = 1e-7, kSpeeds[] = {1.7, 1.9, 2.1, 2.3, 2.5, 2.7};
  for (const auto& [law, potential] : laws) {
    const auto energy = [V = potential](const BodyState& ball) { return 0.5 * ball.rd.squaredNorm() + V(ball.r.x()); };
    for (const double speed : kSpeeds) {
      const Recorded r = run(flying({speed, 0, 0}, law, 3), settings(kRtol, 1.2, 1.2));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, IsEmpty()) << law;
      EXPECT_NEAR(energy(r.samples.back().bodies[0]), energy(r.samples[0].bodies[0]), most * kRtol) << law << speed;
      EXPECT_LT(r.outcome.statistics.steps, 600) << law << speed;
    }
  }
}

// So are those that turn over with the rate, as where a slider that a spring pulls comes to stick and breaks loose.
TEST_P(PassedLawsTest, SteepForcesOfTheRateAreResolved) {
  const double most = GetParam().integrator == "ida" ? 2000 : 200;  // tolerances
  for (const char* friction : {"(3 + 2*exp(-(v/0.05)^2))*tanh(v/1e-3)", "4*v/sqrt(v^2 + 1e-6)"}) {
    Scene scene = flying({0, 0, 0}, friction, 3);
    Spring pull = std::get<Spring>(scene.forces[0]);
    pull.law = Expression::parse_law("1000*(x + 1 - 0.5*t)");
    scene.forces.push_back(pull);
    const auto moved = [&](const Settings& settings) {
      const Recorded r = run(scene, settings);
      EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, IsEmpty()) << friction;
      return r.samples;
    };
    const auto right = moved(controlled("dop853", "rA", 1e-11, 2, 0.02));
    for (const double rtol : {1e-6, 1e-7}) {
      const auto samples = moved(settings(rtol, 2, 0.02));
      ASSERT_EQ(samples.size(), right.size());
      double off = 0;
      for (std::size_t k = 0; k < samples.size(); ++k)
        off = std::max(off, (samples[k].bodies[0].rd - right[k].bodies[0].rd).norm());
      EXPECT_LT(off, most * rtol) << friction << rtol;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
