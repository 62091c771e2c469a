// Steps of a fixed length that pass over contacts and catches say so, with a step that sees them; so do those over
// which springs pass through no length. Others say nothing.
#include "integrators/stepping/passed_in_steps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <regex>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct SteppingMethod {
  std::string integrator, formulation;
};
std::vector<SteppingMethod> stepping_methods() {
  std::vector<SteppingMethod> all;
  for (const IntegratorEntry& entry : integrators())
    for (const FormulationEntry& formulation : formulations())
      if (entry.analysis == Analysis::dynamics && !entry.controls_error)
        all.push_back({std::string(entry.name), std::string(formulation.name)});
  return all;
}

// A ball at 2 m/s, `length` from where the law of the spring to its start has its zero, to the right.
Scene thrown(const char* law, double length, double start = -1) {
  Scene scene;
  Body ball;
  ball.name = "ball", ball.mass = 1, ball.inertia = Vector3(1, 1, 1).asDiagonal();
  ball.position = {start, 0, 0}, ball.velocity = {2, 0, 0};
  scene.bodies.push_back(ball);
  Spring spring;
  spring.name = "bump", spring.j = 0, spring.length = length, spring.s_i = {-length, 0, 0};
  spring.law = Expression::parse_law(law);
  scene.forces.push_back(spring);
  return scene;
}

Scene two_balls() {
  Scene scene = thrown("1e5*min(0, x)", 0.02);
  Body other = scene.bodies[0];
  other.name = "other", other.position.setZero(), other.velocity.setZero();
  scene.bodies.push_back(other);
  Spring& contact = std::get<Spring>(scene.forces[0]);
  contact.i = 0, contact.j = 1, contact.s_i.setZero();
  return scene;
}

Scene wheel(double speed) {
  Scene scene = thrown("0", 0);
  scene.forces.clear();
  scene.bodies[0].position.setZero(), scene.bodies[0].velocity.setZero();
  scene.bodies[0].angular_velocity = {0, 0, speed};
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  return scene;
}

Scene toothed_wheel() {
  Scene scene = wheel(1);
  TorsionSpring tooth;
  tooth.name = "tooth", tooth.i = kGround, tooth.j = 0, tooth.axis = {0, 0, 1}, tooth.angle = 1;
  tooth.law = Expression::parse_law("50*exp(-((x - 0.5)/0.001)^2)");
  scene.forces.push_back(tooth);
  return scene;
}

class PassedInStepsTest : public ::testing::TestWithParam<SteppingMethod> {
 protected:
  // Without what is said of its energy.
  Recorded moved(const Scene& scene, double step, double end) const {
    Settings settings = controlled(GetParam().integrator, GetParam().formulation, 1e-8, end, end);
    settings.step = step;
    Recorded r = run(scene, settings);
    EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    std::erase_if(r.outcome.notices,
                  [](const std::string& notice) { return notice.find("largest kinetic energy") != std::string::npos; });
    return r;
  }
  // The step that the only notice offers is taken; its run says nothing.
  Recorded as_offered(const Scene& scene, double step, double end, const char* name) const {
    const Recorded r = moved(scene, step, end);
    EXPECT_THAT(r.outcome.notices, ElementsAre(AllOf(HasSubstr(name), HasSubstr("goes over that"))));
    std::smatch offered;
    static const std::regex pattern("take a step of at most ([0-9.e-]+) s");
    if (r.outcome.notices.empty() || !std::regex_search(r.outcome.notices[0], offered, pattern)) return r;
    const double serves = std::stod(offered[1]);
    EXPECT_LT(serves, step);
    EXPECT_GT(serves, 1e-3 * step) << r.outcome.notices[0];
    Recorded seen = moved(scene, serves, end);
    EXPECT_THAT(seen.outcome.notices, IsEmpty()) << serves;
    return seen;
  }
};
INSTANTIATE_TEST_SUITE_P(All, PassedInStepsTest, ::testing::ValuesIn(stepping_methods()),
                         [](const auto& test) { return test.param.integrator + "_" + test.param.formulation; });

// Both methods of first order lose some of the motion in the contact.
TEST_P(PassedInStepsTest, BallsThatMeetWithinAStepAreTold) {
  const Recorded r = as_offered(two_balls(), 1.0 / 19, 1, "spring 'bump'");
  EXPECT_NEAR(r.samples.back().bodies[1].rd.x(), 2,
              integrators().require(GetParam().integrator).order == 1 ? 0.5 : 0.05);
}

TEST_P(PassedInStepsTest, BarriersWithinAStepAreTold) {
  for (const char* law : {"2000*exp(-(x/0.003)^2)", "5e6*max(0, 0.001 - abs(x))"}) {
    const Recorded r = as_offered(thrown(law, 3), 0.0137, 1, "spring 'bump'");
    EXPECT_LT(r.samples.back().bodies[0].rd.x(), -1) << law;
  }
}

// Of a force that jumps with the position, too, which steps that see it may not follow.
TEST_P(PassedInStepsTest, JumpsWithinAStepAreTold) {
  const Recorded r = moved(thrown("5e3*step(0.001 - abs(x))", 3), 0.0137, 1);
  EXPECT_THAT(r.outcome.notices, ElementsAre(HasSubstr("at t = 0.4995")));
  EXPECT_THAT(r.outcome.notices, ElementsAre(HasSubstr("take a step of at most 9e-05 s")));
}

TEST_P(PassedInStepsTest, CatchesOfWheelsWithinAStepAreTold) {
  const Recorded r = moved(toothed_wheel(), 0.0107, 2.03);
  EXPECT_THAT(r.outcome.notices, Contains(AllOf(HasSubstr("torsion spring 'tooth' comes to"), HasSubstr(" N m "))));
}

// Smooth laws that steps resolve, contacts that last for many of them, springs through their zero, friction.
TEST_P(PassedInStepsTest, WhatStepsSeeIsNotTold) {
  const auto quiet = [&](const Scene& scene) {
    const Recorded r = moved(scene, 1e-3, 2);
    EXPECT_THAT(r.outcome.notices, IsEmpty()) << std::get<Spring>(scene.forces[0]).law->text();
  };
  for (const char* law :
       {"100*x + 50*x^3", "1e3*min(0, x)", "20*abs(x)*x", "200*exp(-(x/0.05)^2)", "5*sin(20*x)",
        "10*tanh(100*v) + 50*x", "10*sign(v)*step(1 - abs(v))", "50*x + 3*v*abs(v)", "x^2", "1 + cos(3*x)*sin(x)"}) {
    quiet(thrown(law, 3));
    Scene beside = thrown(law, 0.5, 1);  // where the spring has no length
    beside.bodies[0].position.y() = 0.3;
    quiet(beside);
  }
}

// A ball that goes through the other end of its spring, or beside it.
Scene through_its_spring(double beside, const char* law) {
  Scene scene = thrown(law, 0);
  scene.bodies[0].position = {-1, beside, 0};
  return scene;
}
Scene through_linear_spring() {
  Scene scene = through_its_spring(0, "0");
  Spring& spring = std::get<Spring>(scene.forces[0]);
  spring.law.reset();
  spring.stiffness = 20, spring.length = 0.25;
  return scene;
}

TEST_P(PassedInStepsTest, SpringsThroughNoLengthAreTold) {
  const auto told = [&](const Scene& scene, const char* force) {
    const Recorded r = moved(scene, 1e-3, 1);
    EXPECT_THAT(r.outcome.notices, ElementsAre(AllOf(HasSubstr("spring 'bump' passes through no length within a step"),
                                                     HasSubstr(force), HasSubstr("at t = 0."))));
  };
  for (const double beside : {0.0, 1e-6, 2e-4})
    for (const char* law : {"5", "5 + 20*x", "5 + 20*x + 0.1*v"}) told(through_its_spring(beside, law), ", 5 N");
  told(through_linear_spring(), ", -5 N");
}

TEST_P(PassedInStepsTest, SpringsBesideNoLengthAreNot) {
  const auto quiet = [&](double beside, const char* law) {
    const Recorded r = moved(through_its_spring(beside, law), 1e-3, 2);
    EXPECT_THAT(r.outcome.notices, IsEmpty()) << law << " " << beside;
  };
  quiet(0.02, "5 + 20*x");
  quiet(0, "20*x");
  quiet(0, "20*x + 50*x^3");
  quiet(0, "1e-5 + 20*x");
}

}  // namespace
}  // namespace poinsot::test
