// Starts and output times in a singular position: what is given out is the limit of states beside, or the run stops and
// what it says to try helps.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/every_way.h"
#include "tests/support/remedies.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SingularLimits : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, SingularLimits, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Wheels, the directions of each at an angle of u + c u², u = 1 + δ − t: its row vanishes where that is 0.
Scene wheels_by_cosines(const std::vector<double>& later, double c = 0) {
  Scene scene;
  for (const double delta : later) {
    const int k = static_cast<int>(scene.bodies.size());
    Body& wheel = scene.bodies.emplace_back();
    wheel.name = fmt::format("wheel{}", k), wheel.mass = 1, wheel.inertia = Matrix3::Identity();
    const double u = 1 + delta;
    wheel.orientation = Eigen::AngleAxisd(u + c * u * u, Vector3::UnitZ()).toRotationMatrix();
    wheel.angular_velocity = {0, 0, -1 - 2 * c * u};
    Joint& hinge = scene.joints.emplace_back();
    hinge.name = fmt::format("hinge{}", k), hinge.i = kGround, hinge.j = k, hinge.axis = {0, 0, 1};
    Constraint& row = scene.constraints.emplace_back();
    row.name = fmt::format("cosine{}", k), row.type = ConstraintType::DP1, row.i = kGround, row.j = k;
    row.a_i = row.a_j = {1, 0, 0};
    row.f = Expression::parse(fmt::format("cos({0} - t + {1}*({0} - t)^2)", u, c));
  }
  return scene;
}

constexpr const char* kSampled[] = {"dopri5", "dop853", "radau5"};

// Rates there are rounding: they are the limit of those beside. Those may be singular, too, at some of the distances at
// which they are looked at.
TEST_P(SingularLimits, OfOutputTimesAreGivenOut) {
  for (const std::vector<double>& later : std::vector<std::vector<double>>{
           {0}, {0, 0}, {0, 1e-5}, {0, 0.005}, {0, 0.014}, {0, 0.015}, {0, 0.03}, {0, 0.06}}) {
    for (const char* integrator : kSampled) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, later.back()));
      const Recorded r = run(wheels_by_cosines(later), controlled(integrator, GetParam(), 1e-8, 1.5, 0.5));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      ASSERT_EQ(r.samples.size(), 4u);
      for (const Snapshot& sample : r.samples) {
        for (const BodyState& wheel : sample.bodies) {
          EXPECT_NEAR(wheel.w.z(), -1, 1e-6) << sample.t;
          EXPECT_LT(wheel.wd.norm(), 1e-6) << sample.t;
        }
      }
    }
  }
}

// One of the states beside is within a thousandth of another position: rounding there is seen in what they say.
TEST_P(SingularLimits, AreNotMadeOfStatesBesideOtherPositions) {
  constexpr double kGrows = 0.3;
  for (const double beside : {-0.0149, -0.01499, 0.01501, 0.0301, -0.0449}) {
    for (const char* integrator : kSampled) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, beside));
      const Recorded r =
          run(wheels_by_cosines({0, -0.0664, beside}, kGrows), controlled(integrator, GetParam(), 1e-8, 1.1, 0.5));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      for (const BodyState& wheel : r.samples.at(2).bodies) EXPECT_NEAR(wheel.wd.z(), 2 * kGrows, 1e-5);
    }
  }
}

// At all of them there is nothing to be given out.
TEST_P(SingularLimits, NeedAnOutputTimeBesideWhereOthersAreNear) {
  const Scene scene = wheels_by_cosines({0, 0.015, 0.012, 0.0195});
  for (const char* integrator : kSampled) {
    SCOPED_TRACE(integrator);
    expect_stopped(run(scene, controlled(integrator, GetParam(), 1e-8, 1.5, 0.5)), Failure::singular_position,
                   "constraint 'cosine0'", "take output times beside it");
    expect_helped(scene, controlled(integrator, GetParam(), 1e-8, 1.35, 0.45));
  }
}

// A wheel at the angle s + s^1.5 with s = t + later, by its cosine: accelerations at s = 0 have no limit.
Scene wheel_without_limit(double later, const char* s) {
  constexpr auto f = [](double x) { return 1 - x * x / 2 - std::pow(x, 2.5) - x * x * x / 2 + x * x * x * x / 24; };
  const double slope = later + 2.5 * std::pow(later, 1.5) + 1.5 * later * later - later * later * later / 6;
  Scene scene = wheels_by_cosines({0});
  Body& wheel = scene.bodies[0];
  const double angle = std::acos(f(later));
  wheel.orientation = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  wheel.angular_velocity = {0, 0, later > 0 ? slope / std::sin(angle) : 1};
  scene.constraints[0].f = Expression::parse(
      std::regex_replace("1 - s^2/2 - s^2.5 - s^3/2 + s^4/24", std::regex("s"), fmt::format(fmt::runtime(s), later)));
  return scene;
}

// Of functions without a value before the start it is one of those, too.
TEST_P(SingularLimits, NeedAStartBesideWhereThereIsNone) {
  for (const char* s : {"abs(t + {})", "(t + {})"}) {
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
      SCOPED_TRACE(fmt::format("{} {}", s, integrator.name));
      Settings settings;
      settings.integrator = integrator.name, settings.formulation = GetParam();
      settings.end = 0.3;
      const Recorded refused = run(wheel_without_limit(0, s), settings);
      EXPECT_EQ(refused.outcome.status.failure, s[0] == 'a' ? Failure::singular_position : Failure::not_finite);
      EXPECT_THAT(refused.outcome.status.message, HasSubstr("constraint 'cosine0'"));
      EXPECT_THAT(refused.outcome.status.message, HasSubstr("; start beside it"));
      EXPECT_THAT(refused.outcome.status.message, Not(HasSubstr("end the run before")));
      expect_helped(wheel_without_limit(0.01, s), settings);
    }
  }
}

// On the way there as well: error control comes to its end, RATTLE to another branch, and neither is what to change.
TEST_P(SingularLimits, ThatAreNoneNeedADriverThatKnowsItsAngle) {
  constexpr double kAfter = 0.3;
  Scene scene = wheel_without_limit(kAfter, "abs(t - {})");
  Body& wheel = scene.bodies[0];
  wheel.orientation.transposeInPlace();
  for (const char* integrator : {"dopri5", "dop853", "radau5", "rattle"}) {
    SCOPED_TRACE(integrator);
    Settings settings = controlled(integrator, GetParam(), 1e-8, 0.6);
    settings.step = 1e-3;
    const Recorded r = run(scene, settings);
    ASSERT_FALSE(r.outcome.status.ok());
    EXPECT_NEAR(r.outcome.status.time, kAfter, 1e-4);
    EXPECT_THAT(r.outcome.status.message, HasSubstr("an angle driver in its place does"));
    EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("; try ")));
  }
}

}  // namespace
}  // namespace poinsot::test
