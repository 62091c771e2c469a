// Contacts that steps of a fixed length do not resolve are told; with the step that is offered they give back what they
// took.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// A ball that falls half a metre onto a floor.
Scene dropped(const char* law) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& ball = scene.bodies.emplace_back();
  ball.name = "ball", ball.mass = 1, ball.inertia = Matrix3::Identity(), ball.position = {0, 0, 5.5};
  Joint& guide = scene.joints.emplace_back();
  guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {0, 0, 1};
  Spring floor;
  floor.name = "floor", floor.i = kGround, floor.j = 0, floor.length = 5, floor.law = Expression::parse_law(law);
  scene.forces.push_back(floor);
  return scene;
}

Recorded fall(const Scene& scene, std::string_view integrator, double step) {
  Settings settings = dynamics("rA", step, 1, 0.01);
  settings.integrator = integrator;
  return run(scene, settings);
}

std::vector<std::string> methods_of_fixed_steps() {
  std::vector<std::string> all;
  for (const IntegratorEntry& entry : integrators())
    if (entry.analysis == Analysis::dynamics && !entry.controls_error) all.emplace_back(entry.name);
  return all;
}

TEST(StruckInSteps, AreToldWithAStepThatGivesBackWhatWasTaken) {
  for (const std::string& integrator : methods_of_fixed_steps())
    for (const char* law : {"1e7*min(0, x)", "1e6*min(0, x) - 10*step(-x)*v", "-1e9*max(0, -x)^1.5", "-exp(-1000*x)"}) {
      SCOPED_TRACE(integrator + " " + law);
      const Recorded coarse = fall(dropped(law), integrator, 1e-3);
      ASSERT_THAT(coarse.outcome.notices, Contains(HasSubstr("spring 'floor' changes by")));
      std::string told;
      for (const std::string& notice : coarse.outcome.notices)
        if (notice.find("is made by the step") != std::string::npos) told = notice;
      std::smatch offered;
      ASSERT_TRUE(std::regex_search(told, offered, std::regex("a step of at most ([0-9.e-]+) s"))) << told;
      const Recorded fine = fall(dropped(law), integrator, std::stod(offered[1]));
      EXPECT_THAT(fine.outcome.notices, Not(Contains(HasSubstr("is made by the step")))) << offered[1];
      double highest = 0;
      for (const Snapshot& sample : fine.samples)
        if (sample.t > 0.4) highest = std::max(highest, sample.bodies[0].r.z());
      EXPECT_LT(highest, 5.55);  // 5.5 it fell from
    }
}

TEST(StruckInSteps, AreNotWhereStepsResolveThem) {
  for (const std::string& integrator : methods_of_fixed_steps())
    for (const char* law :
         {"1e4*min(0, x)", "100*x + 50*x^3", "-10*tanh(100*v)", "-20*exp(-20*x)", "1e4*sin(3000*t)"}) {
      const Recorded r = fall(dropped(law), integrator, 1e-3);
      EXPECT_THAT(r.outcome.notices, Not(Contains(HasSubstr("is made by the step")))) << integrator << ' ' << law;
    }
}

}  // namespace
}  // namespace poinsot::test
