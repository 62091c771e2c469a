// Motions that come to rest in a singular position and turn back: to first order they may go on by any branch. A run
// follows the one that accelerations lead along, or says that it does not know.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tests/support/every_way.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// An angle that comes down to 0 and goes up again.
struct Turn {
  const char* text;
  std::function<double(double)> angle;
  double end;
};
const std::array kTurns{
    Turn{"(1 - t)^2", [](double t) { return (1 - t) * (1 - t); }, 1.5},
    Turn{"0.3*(1 - t)^2*(1 + t)", [](double t) { return 0.3 * (1 - t) * (1 - t) * (1 + t); }, 1.5},
    Turn{"1 - sin(3*t)", [](double t) { return 1 - std::sin(3 * t); }, 0.9},
    Turn{"0.5*(1 - sin(5*t + 1))", [](double t) { return 0.5 * (1 - std::sin(5 * t + 1)); }, 0.5},
};

// A wheel driven by the cosine of its angle, which does not say to which side it turns.
Scene cosine_of(const Turn& turn) {
  Scene scene;
  Body& wheel = scene.bodies.emplace_back();
  wheel.name = "wheel", wheel.mass = 1, wheel.inertia = Matrix3::Identity();
  wheel.orientation = Eigen::AngleAxisd(turn.angle(0), Vector3::UnitZ()).toRotationMatrix();
  wheel.angular_velocity = {0, 0, (turn.angle(1e-5) - turn.angle(-1e-5)) / 2e-5};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  Constraint& row = scene.constraints.emplace_back();
  row.name = "cosine", row.type = ConstraintType::DP1, row.i = kGround, row.j = 0;
  row.a_i = row.a_j = {1, 0, 0};
  row.f = Expression::parse(std::string("cos(") + turn.text + ")");
  return scene;
}

class RestInSingular : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, RestInSingular, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(RestInSingular, IsLeftAlongTheAccelerationsOrEndsTheRun) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (refusal_of(integrator, GetParam()) || integrator.analysis != Analysis::dynamics) continue;
    int followed = 0;
    for (const Turn& turn : kTurns)
      for (const double fine : {1e-3, 1e-5}) {
        SCOPED_TRACE(fmt::format("{} {} {}", integrator.name, turn.text, fine));
        Settings settings;
        settings.integrator = integrator.name, settings.formulation = GetParam();
        settings.rtol = 1e-5 * fine, settings.tolerance = 1e-8;
        settings.step = turn.end / std::round(turn.end / (0.01 * std::pow(fine, 0.2)));
        settings.end = settings.every = turn.end;
        const Recorded r = run(cosine_of(turn), settings);
        if (!r.outcome.status.ok()) {
          EXPECT_THAT(r.outcome.status.message, ::testing::HasSubstr("'cosine'"));
          continue;
        }
        ++followed;
        const Matrix3& A = r.samples.back().bodies[0].A;
        EXPECT_NEAR(std::atan2(A(1, 0), A(0, 0)), turn.angle(turn.end), 1e-3);
      }
    if (!integrator.controls_error) {
      EXPECT_GE(followed, 6) << integrator.name;
    }
    if (integrator.name == "dop853") {
      EXPECT_EQ(followed, 8) << "its steps are long enough to go over it";
    }
  }
}

// A wheel that stays there, by a kink of its driver, has left no branch.
TEST_P(RestInSingular, MayLast) {
  const Turn stay{"max(1 - t, 0)^2", [](double t) { return std::pow(std::max(1 - t, 0.0), 2); }, 2};
  int stayed = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const double tolerance : {1e-3, 1e-8}) {
      Settings settings;
      settings.integrator = integrator.name, settings.formulation = GetParam();
      settings.step = 5e-3, settings.tolerance = tolerance, settings.end = stay.end;
      const Recorded r = run(cosine_of(stay), settings);
      EXPECT_THAT(r.outcome.status.message, ::testing::Not(::testing::HasSubstr("accelerations led to")));
      if (!r.outcome.status.ok()) continue;
      ++stayed;
      EXPECT_LT((r.samples.back().bodies[0].A - Matrix3::Identity()).norm(), 1e-6) << integrator.name;
    }
  }
  EXPECT_GE(stayed, 6);
}

// Where accelerations vanish, too, methods take either branch; which one is right no run claims to know.
TEST_P(RestInSingular, IsToldWhereAccelerationsVanishToo) {
  const std::array turns{Turn{"(1 - t)^3", [](double t) { return std::pow(1 - t, 3); }, 2},
                         Turn{"0.5*(1 - t)^5", [](double t) { return 0.5 * std::pow(1 - t, 5); }, 2}};
  int went_on = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (refusal_of(integrator, GetParam()) || integrator.analysis != Analysis::dynamics) continue;
    for (const Turn& turn : turns)
      for (const bool hinge_angle : {false, true}) {
        SCOPED_TRACE(fmt::format("{} {} {}", integrator.name, turn.text, hinge_angle));
        Scene scene = cosine_of(turn);
        if (hinge_angle) {  // which tells at every angle how it goes on
          scene.constraints.clear();
          Driver& driver = scene.drivers.emplace_back();
          driver.name = "motor", driver.i = kGround, driver.j = 0;
          driver.axis = {0, 0, 1}, driver.a_i = driver.a_j = {1, 0, 0};
          driver.value = Expression::parse(turn.text);
        }
        Settings settings;
        settings.integrator = integrator.name, settings.formulation = GetParam();
        settings.rtol = 1e-6, settings.step = 5e-3, settings.end = settings.every = turn.end;
        const Recorded r = run(scene, settings);
        if (!r.outcome.status.ok()) continue;
        ++went_on;
        const auto told = std::ranges::count_if(r.outcome.notices, [](const std::string& notice) {
          return notice.find("either way") != std::string::npos;
        });
        EXPECT_EQ(told, hinge_angle ? 0 : 1);
      }
  }
  EXPECT_GE(went_on, 12);
}

// Beside a wheel that spins by itself, whose velocities and accelerations are far larger.
void add_spinning_wheel(Scene& scene) {
  Body& other = scene.bodies.emplace_back();
  other.name = "other", other.mass = 1, other.inertia = Matrix3::Identity();
  other.position = {1, 5, 0}, other.velocity = {0, 20, 0}, other.angular_velocity = {0, 0, 20};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "other hinge", hinge.i = kGround, hinge.j = 1, hinge.point = {0, 5, 0}, hinge.axis = {0, 0, 1};
}

TEST_P(RestInSingular, IsSeenBesideAFasterMechanism) {
  int went_on = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const Turn& turn : kTurns) {
      SCOPED_TRACE(fmt::format("{} {}", integrator.name, turn.text));
      Scene scene = cosine_of(turn);
      add_spinning_wheel(scene);
      Settings settings = dynamics(GetParam(), turn.end / std::round(turn.end / 2e-3), turn.end, turn.end);
      settings.integrator = integrator.name;
      const Recorded r = run(scene, settings);
      if (!r.outcome.status.ok()) continue;
      ++went_on;
      const Matrix3& A = r.samples.back().bodies[0].A;
      EXPECT_NEAR(std::atan2(A(1, 0), A(0, 0)), turn.angle(turn.end), 1e-3);
    }
    Scene scene = cosine_of({"(1 - t)^3", [](double t) { return std::pow(1 - t, 3); }, 2});
    add_spinning_wheel(scene);
    Settings settings = dynamics(GetParam(), 5e-3, 2, 2);
    settings.integrator = integrator.name;
    const Recorded r = run(scene, settings);
    if (!r.outcome.status.ok()) continue;
    EXPECT_THAT(r.outcome.notices, ::testing::Contains(::testing::HasSubstr("either way"))) << integrator.name;
    ++went_on;
  }
  EXPECT_GE(went_on, 12);
}

TEST_P(RestInSingular, IsNotSaidToBeBarred) {
  for (const Turn& turn : kTurns) {
    Settings settings = kinematics(GetParam(), turn.end / 100, turn.end);
    const Recorded r = run(cosine_of(turn), settings);
    if (r.outcome.status.ok()) continue;
    EXPECT_THAT(r.outcome.status.message, ::testing::HasSubstr("in more than one way")) << turn.text;
  }
}

}  // namespace
}  // namespace poinsot::test
