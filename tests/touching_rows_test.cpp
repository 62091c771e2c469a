// Rows that follow from others along a motion, but to the first order only: platforms on parallel rods of one length.
#include <gmock/gmock.h>

#include <cmath>

#include "bench/study/scene_check_text.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRopeLength = 2;

struct ParallelRods {
  std::vector<Vector3> at{{0.1, 0.25, 0}, {0.1, -0.25, 0}, {-0.1, 0.25, 0}, {-0.1, -0.25, 0}};  // on the platform
  double swung = 0, rate = 0;  // rad, of the rods about y, and its rate
};

Scene platform(const ParallelRods& rods) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& seat = scene.bodies.emplace_back();
  seat.name = "seat", seat.mass = 30, seat.inertia = Vector3(0.5, 2, 2).asDiagonal();
  const double s = std::sin(rods.swung), c = std::cos(rods.swung);
  seat.position = kRopeLength * Vector3(s, 0, -c), seat.velocity = kRopeLength * rods.rate * Vector3(c, 0, s);
  for (const Vector3& at : rods.at) {
    Constraint& rod = scene.constraints.emplace_back();
    rod.type = ConstraintType::D, rod.j = 0, rod.s_i = rod.s_j = at, rod.f = Expression(kRopeLength * kRopeLength);
    rod.name = "rod" + std::to_string(scene.constraints.size());
  }
  return scene;
}

// Of the swing, a pendulum of a point: kRopeLength ẍ = −g sin x.
double swings(double from, double rate, double t) {
  constexpr int kSteps = 20000;
  double x = from, w = rate;
  const double h = t / kSteps;
  for (int k = 0; k < kSteps; ++k) {  // Störmer and Verlet's
    w -= 0.5 * h * 9.81 / kRopeLength * std::sin(x);
    x += h * w;
    w -= 0.5 * h * 9.81 / kRopeLength * std::sin(x);
  }
  return x;
}

class TouchingRows : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, TouchingRows, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// From rest and not, hanging and swung, on four rods and on six, by all methods.
TEST_P(TouchingRows, APlatformOnParallelRodsSwingsWithoutTurning) {
  ParallelRods six{.swung = 0.5};
  for (const double x : {-0.3, 0.3}) six.at.push_back({x, 0.2, 0});
  for (const ParallelRods& rods : {ParallelRods{}, ParallelRods{.rate = 0.75}, ParallelRods{.swung = 0.5},
                                   ParallelRods{.swung = 1, .rate = -0.4}, six}) {
    const double until = 1, x = swings(rods.swung, rods.rate, until);
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
      SCOPED_TRACE(::testing::Message() << integrator.name << ", " << rods.at.size() << " rods, from " << rods.swung
                                        << " rad at " << rods.rate << " rad/s");
      Settings settings;
      settings.integrator = integrator.name, settings.formulation = GetParam();
      settings.step = 1e-3, settings.rtol = 1e-8, settings.end = settings.every = until;
      const Recorded r = run(platform(rods), settings);
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, Contains(HasSubstr("from others to the first order only")));
      EXPECT_EQ(r.outcome.undetermined_reactions.size(), rods.at.size());
      const auto& seat = r.samples.back().bodies[0];
      const double allowed = integrator.controls_error ? 1e-6 : integrator.order == 1 ? 1e-2 : 1e-5;
      EXPECT_LT((seat.r - kRopeLength * Vector3(std::sin(x), 0, -std::cos(x))).norm(), allowed);
      EXPECT_LT((seat.A - Matrix3::Identity()).norm(), 1e-6);
    }
  }
}

// A torque turns a platform that has swung aside, which the fourth rod forbids: what was set aside does not hold.
TEST_P(TouchingRows, WhatIsForbiddenStopsTheRun) {
  Scene scene = platform({.swung = 0.5});
  Torque torque;
  torque.body = 0;
  for (Expression& x : torque.torque) x = Expression(0);
  torque.torque[2] = Expression(30);
  scene.forces.push_back(torque);
  Settings settings;
  settings.formulation = GetParam(), settings.end = settings.every = 2;
  const Recorded r = run(scene, settings);
  EXPECT_FALSE(r.outcome.status.ok());
  EXPECT_THAT(r.outcome.status.message, HasSubstr("'rod"));
}

TEST(TouchingRowsTold, ByTheCheck) {
  const std::string said = study::check_text(study::check_scene(platform({})));
  EXPECT_THAT(said, HasSubstr("to the first order of it"));
  EXPECT_THAT(said, HasSubstr("degrees of freedom: 3"));
  EXPECT_THAT(said, Not(HasSubstr("singular position")));
}

}  // namespace
}  // namespace poinsot::test
