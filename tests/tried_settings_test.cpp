// Other settings that a stop offers have been tried: with what is offered the run gets on, and what does not help is
// said to.
#include "bench/study/tried_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "command_line.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::EndsWith;

// A pendulum of 1 m, released level, whose hinge a motor may turn.
Scene hinged_rod() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& rod = scene.bodies.emplace_back();
  rod.name = "rod", rod.mass = 1, rod.inertia = 0.1 * Matrix3::Identity(), rod.position = {1, 0, 0};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.type = JointType::revolute, hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 1, 0};
  return scene;
}

// As `poinsot run` has it.
std::string told(const Scene& scene, const Settings& settings) {
  Outcome outcome = run(scene, settings).outcome;
  EXPECT_FALSE(outcome.status.ok());
  study::try_settings(scene, settings, outcome);
  EXPECT_EQ(outcome.status.settings, 0u);
  return outcome.status.message;
}

TEST(TriedSettings, AreAStepThatIsKnownToServe) {
  Settings settings = dynamics("rA", 0.5, 5, 0);
  settings.integrator = "implicit_euler";
  const std::string message = told(hinged_rod(), settings);
  std::smatch offered;
  ASSERT_TRUE(std::regex_search(message, offered,
                                std::regex("; with --step ([0-9.e-]+) it goes on, as was tried up to t = 5 s$")))
      << message;
  settings.step = std::stod(offered[1]);
  EXPECT_TRUE(run(hinged_rod(), settings).outcome.status.ok());
}

// What another method does not have is to be left out with it.
TEST(TriedSettings, AreWithoutParametersThatMeanNothingThere) {
  Scene slider = hinged_rod();
  slider.joints[0].type = JointType::translational, slider.joints[0].axis = {1, 0, 0};
  slider.bodies[0].mass = 0.46, slider.bodies[0].velocity = {1.8, 0, 0};
  Spring spring;
  spring.name = "brake", spring.i = kGround, spring.j = 0, spring.s_i = {-10, 0, 0}, spring.length = 10;
  spring.law = Expression::parse_law("9.945*x + 9.296*tanh(v/0.00137)");
  slider.forces.push_back(spring);
  Settings settings = dynamics("rA", 0.08, 0.8);
  settings.integrator = "generalized_alpha_i2", settings.parameters["spectral_radius"] = 0.8;
  EXPECT_THAT(told(slider, settings), EndsWith("; with --integrator auto and without --spectral-radius it goes on, as "
                                               "was tried up to t = 0.8 s"));
}

TEST(TriedSettings, AreWhatHelpsOfMoreThanOne) {
  Settings settings = kinematics("rA", 0.1, 1);
  settings.max_iterations = 1;
  EXPECT_THAT(told(with_motor(posts(1, 0.5, 0, false), "t"), settings),
              EndsWith("; with --max-iterations 5 it goes on, as was tried up to t = 1 s"));
}

TEST(TriedSettings, StandBesideWhatElseHelps) {
  EXPECT_THAT(told(with_motor(posts(1, 0.3, 0, false), "-t"), kinematics("rA", 0.05, 1)),
              EndsWith("; end before it, or start beyond it on the branch that is meant, or with --analysis dynamics "
                       "--integrator dop853 it goes on, as was tried up to t = 1 s"));
}

TEST(TriedSettings, ThatDoNotHelpAreSaidNotTo) {
  Scene scene = hinged_rod();  // whose end is to be further away than it is long
  Driver& ram = scene.drivers.emplace_back();
  ram.name = "ram", ram.type = DriverType::distance, ram.i = kGround, ram.j = 0;
  ram.s_i = {0, 0, 1}, ram.value = Expression::parse("sqrt(2) + t");
  Outcome outcome;
  outcome.status = with_settings({Failure::not_converged, 0.58, "at t = 0.58 s it stops"}, "try a smaller step");
  study::try_settings(scene, kinematics("rA", 0.01, 1), outcome);
  EXPECT_EQ(outcome.status.message,
            "at t = 0.58 s it stops; tried without success: --step 0.0025, --max-iterations 100");
  // Of finer steps a quarter takes too long.
  outcome.status = with_settings({Failure::not_converged, 0.58, "at t = 0.58 s it stops"}, "try a smaller step");
  study::try_settings(scene, kinematics("rA", 4e-6, 1), outcome);
  EXPECT_EQ(outcome.status.message,
            "at t = 0.58 s it stops; try a smaller step (not all tried; without success: --max-iterations 100)");
}

// The rod's end is to be further away than it is long at 0.58 s, with whatever tolerance.
TEST(TriedSettings, ThatLeadFartherAreOfferedWithWhereTheyStop) {
  Scene scene = hinged_rod();
  Driver& ram = scene.drivers.emplace_back();
  ram.name = "ram", ram.type = DriverType::distance, ram.i = kGround, ram.j = 0;
  ram.s_i = {0, 0, 1}, ram.value = Expression::parse("sqrt(2) + t");
  Settings settings = dynamics("rA", 0.01, 1);
  settings.integrator = "dop853";
  Outcome outcome;
  outcome.status = with_settings({Failure::step_size_too_small, 0.1, "at t = 0.1 s it stops"}, "try another method");
  study::try_settings(scene, settings, outcome);
  EXPECT_THAT(outcome.status.message,
              ::testing::ContainsRegex("it stops; with .* it goes on up to t = 0.58[0-9]* s, and stops there$"));
}

// Steps of a millisecond go over where two bodies that attract each other meet, to nowhere, as they say themselves.
TEST(TriedSettings, AreNotStepsThatGoOverWhereAForceGrowsWithoutBound) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "comet", body.mass = 1, body.inertia = Matrix3::Identity(), body.position = {1, 0, 0};
  Spring sun;
  sun.name = "sun", sun.j = 0, sun.law = Expression::parse_law("1/x^2");
  scene.forces.push_back(sun);
  Settings settings = dynamics("rA", 1e-3, 2);
  settings.integrator = "dop853";
  const std::string message = told(scene, settings);
  EXPECT_THAT(message, ::testing::HasSubstr("tried without success"));
  EXPECT_THAT(message, ::testing::HasSubstr("--integrator rattle"));
  EXPECT_THAT(message, ::testing::Not(::testing::HasSubstr("it goes on")));
}

TEST(TriedSettings, OfALongRunAreNotTried) {
  const Settings settings = kinematics("rA", 1e-7, 1);
  Outcome outcome;
  outcome.status = with_settings({Failure::not_converged, 0.5, "at t = 0.5 s it stops"}, "try more iterations");
  study::try_settings(with_motor(posts(1, 0.3, 0, false), "t"), settings, outcome);
  EXPECT_EQ(outcome.status.message, "at t = 0.5 s it stops; try more iterations (not tried)");
}

TEST(TriedSettings, AreNotLookedForWhereTheSceneHasToChange) {
  Outcome outcome;
  outcome.status = with_remedy(Failure::singular_position, 0.5, "at t = 0.5 s it stops", "end before it");
  study::try_settings(hinged_rod(), dynamics("rA", 0.1, 1, 0), outcome);
  EXPECT_EQ(outcome.status.message, "at t = 0.5 s it stops; end before it");
}

class TriedSettingsOnTheCommandLine : public CommandLineWithPendulum {};

TEST_F(TriedSettingsOnTheCommandLine, AreOptionsThatLeadOn) {
  const std::vector<std::string> given{
      "run", "pendulum.json", "--integrator", "implicit_euler", "--step", "0.5", "--end", "5", "--out", "o.csv"};
  const Result stopped = poinsot(given);
  EXPECT_EQ(stopped.status, 3) << stopped.err;
  std::smatch offered;
  ASSERT_TRUE(std::regex_search(stopped.err, offered, std::regex("with --step (\\S+) it goes on"))) << stopped.err;
  std::vector<std::string> helped = given;
  helped[5] = offered[1];
  EXPECT_EQ(poinsot(helped).status, 0);
}

}  // namespace
}  // namespace poinsot::test
