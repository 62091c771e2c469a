// Singular positions and places where a scene asks for what cannot be: what a stop there says to try helps, in the same
// scene.
#include <gtest/gtest.h>

#include "core/input_error.h"
#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/passages.h"
#include "tests/support/remedies.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class SingularRemedies : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, SingularRemedies, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(SingularRemedies, OfKinematicsAreToEndBeforeOrToStartBeyond) {
  for (const bool redundant : {false, true}) {
    SCOPED_TRACE(redundant);
    const Settings settings = kinematics(GetParam(), 0.05, 1);
    const Recorded stopped = run(with_motor(posts(1, 0.3, 0, redundant), "-t"), settings);
    expect_stopped(stopped, Failure::singular_position, "joint 'joint", "end before it, or start beyond it");
    EXPECT_NEAR(stopped.outcome.status.time, 0.3, 1e-4);
    EXPECT_EQ(remedy_of(stopped),
              "; end before it, or start beyond it on the branch that is meant, or let analysis "
              "dynamics pass it by integrator dop853");
    Scene moving = with_motor(posts(1, 0.3, -1, redundant), "-t");
    moving.bodies = posts(1, 0.3, -1, redundant).bodies;
    for (const char* integrator : {"dop853", "dopri5"}) {
      const Recorded r = run(moving, controlled(integrator, GetParam(), 1e-8, 1));
      EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_NEAR(r.samples.back().bodies[1].r.x(), 1 + 0.5 * std::cos(-0.7), 1e-6) << "parallel";
      EXPECT_NEAR(r.samples.back().bodies[1].r.y(), 0.5 * std::sin(-0.7), 1e-6) << "parallel";
    }
    Settings before = settings;
    before.end = 0.29, before.step = 0.01;
    expect_helped(with_motor(posts(1, 0.3, 0, redundant), "-t"), before);
    const Scene beyond = with_motor(posts(1, -0.01, 0, redundant), "-t");
    expect_helped(beyond, settings);
    const Snapshot end = run(beyond, settings).samples.back();
    EXPECT_NEAR(end.bodies[1].r.x(), 1 + 0.5 * std::cos(1.01), 1e-9) << "parallel";
    EXPECT_NEAR(end.bodies[1].r.y(), -0.5 * std::sin(1.01), 1e-9) << "parallel";
  }
}

TEST_P(SingularRemedies, OfKinematicsFromThereAreToStartBesideOrDynamics) {
  const Settings settings = kinematics(GetParam(), 0.01, 0.1);
  const Recorded stopped = run(with_motor(posts(1, 0, 0, false), "-3*t"), settings);
  EXPECT_EQ(stopped.outcome.status.failure, Failure::singular_position);
  EXPECT_THAT(stopped.outcome.status.message, HasSubstr("joint 'joint4'"));
  EXPECT_EQ(remedy_of(stopped),
            "; start beside it, or with analysis dynamics, which follows the branch that the "
            "initial velocities lead to");
  expect_helped(with_motor(posts(1, -0.01, 0, false), "-3*t"), settings);
  Scene moving = posts(1, 0, -3, false);
  moving.drivers = with_motor(posts(1, 0, 0, false), "-3*t").drivers;
  expect_helped(moving, controlled("dop853", GetParam(), 1e-8, 0.1));
}

TEST_P(SingularRemedies, OfIterationsInKinematicsAreMoreOfThemOrALargerTolerance) {
  const Scene scene = with_motor(posts(1, 0.5, 0, false), "t");
  Settings settings = kinematics(GetParam(), 0.1, 1);
  settings.max_iterations = 1;
  const Recorded stopped = run(scene, settings);
  expect_stopped(stopped, Failure::not_converged, "body '", "");
  EXPECT_EQ(remedy_of(stopped), "; try more iterations or a larger tolerance");
  settings.max_iterations = 20;
  expect_helped(scene, settings);
  settings.max_iterations = 1, settings.tolerance = 1e-3;
  expect_helped(scene, settings);
}

// Here a step ends beside the flat position, from where a method of first order may go on on another branch; where it
// is left for certain the run stops, and offers the same.
TEST(SingularRemediesOfBranches, AreATenthOfTheStepOrDop853) {
  const Scene scene = posts(2, 0.2515015516593695, kSpin, false);
  const auto uncertain = Contains(HasSubstr("is not certain; try a tenth of it or dop853"));
  int doubted = 0;
  in_every_way(3e-2, 2, [&](const Settings& way) {
    Settings settings;
    settings.formulation = way.formulation, settings.integrator = way.integrator;
    settings.step = way.step, settings.end = way.end;
    const Recorded r = run(scene, settings);
    if (!r.outcome.status.ok()) {
      expect_stopped(r, Failure::singular_position, "joint '", "try another step or dop853");
    } else if (!::testing::Value(r.outcome.notices, uncertain)) {
      return;
    }
    ++doubted;
    Settings tenth = with_step(settings, 0.1 * settings.step), controls = settings;
    controls.integrator = "dop853";
    for (const Settings& remedy : {tenth, controls}) {
      SCOPED_TRACE(remedy.integrator);
      const Recorded again = run(scene, remedy);
      EXPECT_TRUE(again.outcome.status.ok()) << again.outcome.status.message;
      EXPECT_THAT(again.outcome.notices, Not(uncertain));
      for (const std::size_t coupler : {3u, 4u})  // which turn on other branches alone
        EXPECT_LT((again.samples.back().bodies[coupler].A - Matrix3::Identity()).norm(), 1e-2);
    }
  });
  EXPECT_GT(doubted, 0);
}

TEST_P(SingularRemedies, OfAPositionThatJumpsIsAWayThroughTheValuesBetween) {
  const auto scene = [](const char* angle) { return with_motor(posts(1, 0.5, 0, false), angle); };
  for (const char* integrator : {"dopri5", "dop853", "radau5"}) {
    SCOPED_TRACE(integrator);
    const Settings settings = controlled(integrator, GetParam(), 1e-8, 1);
    expect_stopped(run(scene("0.1*t + 0.2*step(t - 0.5)"), settings), Failure::inconsistent_state, "",
                   "prescribes a jump of positions, which no motion follows; let it pass through the values between");
    expect_helped(scene("0.1*t + 0.2*min(max(10*(t - 0.5), 0), 1)"), settings);
  }
}

TEST_P(SingularRemedies, OfVelocitiesOnNoBranchAreThoseOfOneOrAStartBeside) {
  Scene none = posts(1, 0, kSpin, false);
  none.bodies[1].velocity = {0, -0.75, 0}, none.bodies[1].angular_velocity = {0, 0, -1.5};
  none.bodies[2].velocity = {0, (-1.5 + kSpin) / 2, 0}, none.bodies[2].angular_velocity = {0, 0, -1.5 - kSpin};
  const Settings settings = controlled("dop853", GetParam(), 1e-8, 0.1);
  const Recorded refused = run(none, settings);
  EXPECT_EQ(refused.outcome.status.failure, Failure::singular_position);
  EXPECT_THAT(refused.outcome.status.message, HasSubstr("joint 'joint4'"));
  EXPECT_THAT(refused.outcome.status.message, HasSubstr("start beside it, or with the velocities of one branch"));
  expect_helped(posts(1, 0, kSpin, false), settings);
  expect_helped(posts(1, 0.01, kSpin, false), settings);
}

// Two pendulums in parallel planes, which turn at a rate, and what holds their ends together. The right one's mass lies
// nearer to its hinge, so that alone it would swing faster.
Scene held_together(Constraint by, double rate) {
  Scene scene;
  scene.gravity = {5, 0, -9.81};
  for (const int k : {0, 1}) {
    Body& body = scene.bodies.emplace_back();
    body.name = k == 0 ? "left" : "right", body.mass = 1, body.inertia = 0.1 * Matrix3::Identity();
    const double arm = k == 0 ? 0.5 : 0.4;
    body.position = {0, 0.2 * k, -arm};
    body.velocity = {-arm * rate, 0, 0}, body.angular_velocity = {0, rate, 0};
    Joint& hinge = scene.joints.emplace_back();
    hinge.type = JointType::revolute, hinge.j = k, hinge.point = {0, 0.2 * k, 0}, hinge.axis = Vector3::UnitY();
  }
  by.name = "together", by.i = 0, by.j = 1, by.s_i = {0, 0, -0.5}, by.s_j = {0, 0, -0.6};
  scene.constraints.push_back(by);
  return scene;
}

// A bar as long as the planes are apart leaves no regular position, however they move; a coordinate does.
TEST_P(SingularRemedies, OfConstraintsThatMeetWithoutCrossingAreOthers) {
  Constraint bar, coordinate;
  bar.type = ConstraintType::D, coordinate.type = ConstraintType::CD;
  bar.f = Expression(0.04), coordinate.c = {1, 0, 0};
  const Settings settings = controlled("dop853", GetParam(), 1e-8, 0.3);
  for (const double rate : {0.0, 1.0}) {
    const Recorded refused = run(held_together(bar, rate), settings);
    EXPECT_EQ(refused.outcome.status.failure, Failure::singular_position);
    EXPECT_THAT(refused.outcome.status.message,
                AllOf(HasSubstr("and so are all found beside it"), HasSubstr("; write what they amount to by other"),
                      Not(HasSubstr("start beside it"))));
    expect_helped(held_together(coordinate, rate), settings);
  }
}

TEST_P(SingularRemedies, OfABodyWithoutInertiaIsInertia) {
  const Scene with = scene_of("free_body");
  Scene without = with;
  without.bodies[0].inertia.setZero();
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings;
    settings.integrator = integrator.name, settings.formulation = GetParam();
    settings.end = 0.01;
    try {
      (void)run(without, settings);
      ADD_FAILURE() << "it ran";
    } catch (const InputError& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("has no moment of inertia about"));
      EXPECT_THAT(refused.what(), HasSubstr("give it a small moment there"));
    }
    expect_helped(with, settings);
  }
}

// A telescope that asks for more than a rod can reach: no method goes on there, and the time before it is done.
TEST_P(SingularRemedies, OfADriverThatAsksForTooMuchIsToEndBefore) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& rod = scene.bodies.emplace_back();
  rod.name = "rod", rod.mass = 3, rod.inertia = Vector3(1, 0.01, 1).asDiagonal(), rod.position = {0, 0, -1};
  rod.orientation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vector3::UnitX()).toRotationMatrix();
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {1, 0, 0};
  Driver& telescope = scene.drivers.emplace_back();
  telescope.name = "telescope", telescope.type = DriverType::distance, telescope.i = kGround, telescope.j = 0;
  telescope.s_i = {0, 3, 0}, telescope.s_j = {0, 1, 0};
  telescope.value = Expression::parse("sqrt(13) + (5 - sqrt(13))*t");
  for (const IntegratorEntry& integrator : integrators()) {
    if (refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings;
    settings.integrator = integrator.name, settings.formulation = GetParam(), settings.analysis = integrator.analysis;
    settings.step = 0.01, settings.end = 2;
    Recorded r = run(scene, settings);
    // RATTLE is told by the rotation it comes to; with the step that is offered it comes to the same end.
    for (int k = 0; k < 2 && offered_step(r.outcome.status.message); ++k) {
      settings.step = *offered_step(r.outcome.status.message);
      r = run(scene, settings);
    }
    ASSERT_FALSE(r.outcome.status.ok());
    EXPECT_NEAR(r.outcome.status.time, 1, 0.02);
    EXPECT_THAT(r.outcome.status.message, HasSubstr("end before it"));
    EXPECT_THAT(r.outcome.status.message, HasSubstr("no method passes"));
    EXPECT_THAT(r.outcome.status.message, AllOf(Not(HasSubstr("try ")), Not(HasSubstr("step over"))));
    EXPECT_LT(r.outcome.statistics.violation.position, 1e-6) << "what is given out is on the constraints";
    settings.end = 0.97;
    expect_helped(scene, settings);
  }
}

TEST_P(SingularRemedies, OfACosineBeyondOneIsToEndBefore) {
  Scene scene;
  Body& arm = scene.bodies.emplace_back();
  arm.name = "arm", arm.mass = 2, arm.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal(), arm.position = {0, 1, 0};
  arm.velocity = {0, 0, 0.5}, arm.angular_velocity = {0.5, 0, 0};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {1, 0, 0};
  Constraint& height = scene.constraints.emplace_back();
  height.name = "height", height.j = 0, height.a_i = {0, 0, 1}, height.a_j = {0, 1, 0};
  height.f = Expression::parse("0.5*t");
  for (const IntegratorEntry& integrator : integrators()) {
    if (refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings;
    settings.integrator = integrator.name, settings.formulation = GetParam(), settings.analysis = integrator.analysis;
    settings.step = 0.01, settings.end = 3;
    expect_stopped(run(scene, settings), Failure::singular_position, "asks for a cosine beyond 1 from t = 2 s on",
                   "; end before it");
    settings.end = 1.95;
    expect_helped(scene, settings);
  }
}

}  // namespace
}  // namespace poinsot::test
