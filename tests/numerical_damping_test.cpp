// What implicit Euler takes out of a motion is told as it is, and the step offered keeps it small.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/support/energy_course.h"
#include "tests/support/sprung_wheel.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Circles about the origin at 1 rad/s.
Scene point_on_rod() {
  Scene scene;
  Body ball;
  ball.name = "ball", ball.mass = 1, ball.inertia = 1e-3 * Matrix3::Identity();
  ball.position = {1, 0, 0}, ball.velocity = {0, 1, 0};
  scene.bodies.push_back(ball);
  Constraint rod;
  rod.type = ConstraintType::D, rod.i = kGround, rod.j = 0, rod.f = Expression(1.0);
  scene.constraints.push_back(rod);
  return scene;
}

// Next to nothing is enough for its energy not to be known (energy_balance_test).
Scene hardly_damped(Scene scene) {
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) {
    LinearDrag drag;
    drag.name = fmt::format("drag{}", b), drag.body = b, drag.translational = drag.rotational = 1e-12;
    scene.forces.push_back(drag);
  }
  return scene;
}

Settings implicit_euler(std::string_view formulation, double step, double end) {
  Settings s;
  s.integrator = "implicit_euler", s.formulation = formulation, s.step = step, s.end = end, s.tolerance = 1e-8;
  return s;
}

struct Lost {
  double percent = 0, told = 0;  // of the largest kinetic energy; as the notice has it
  std::string remedy;
};

Lost lost(const Scene& scene, const Settings& settings) {
  const EnergyCourse energy = energy_course(scene, settings);
  EXPECT_TRUE(energy.outcome.status.ok()) << energy.outcome.status.message;
  Lost result{energy.percent_lost(), 0, {}};
  for (const std::string& notice : energy.outcome.notices) {
    std::smatch found;
    const std::regex pattern("by itself, ([0-9.e+]+) % .*: it damps in proportion to the step; (.*)");
    if (!std::regex_search(notice, found, pattern)) continue;
    result.told = std::stod(found[1]), result.remedy = found[2];
  }
  return result;
}

TEST(NumericalDamping, is_told_as_it_is) {
  int told = 0, silent = 0;
  for (const char* model : {"", "wheel", "double_four_bar", "double_pendulum", "gimbal_pendulum", "simple_pendulum",
                            "single_pendulum_free", "steel_pendulum", "stiff_pendulum"}) {
    const std::string_view name = model;
    const Scene scene = hardly_damped(name.empty()      ? point_on_rod()
                                      : name == "wheel" ? sprung_wheel(0.5, 30)
                                                        : scene_of(model));
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const double step : {1e-3, 1e-2, 2e-2}) {
        SCOPED_TRACE(fmt::format("{} {} {}", model, formulation, step));
        const Lost of = lost(scene, implicit_euler(formulation, step, 2));
        if (of.told == 0) {
          EXPECT_LT(of.percent, 10);
          ++silent;
          continue;
        }
        ++told;
        EXPECT_GT(of.told, 0.6 * of.percent);
        EXPECT_LT(of.told, 1.1 * of.percent);
      }
  }
  EXPECT_GT(told, 20);
  EXPECT_GT(silent, 20);
}

TEST(NumericalDamping, is_small_at_the_step_that_is_offered) {
  const std::regex pattern("a step below ([0-9.e-]+) s, rattle or error control take less than 6 %");
  int offered = 0;
  for (const char* model : {"simple_pendulum", "double_wishbone"})
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const double step : {2e-3, 5e-3, 1e-2, 1.3e-2}) {
        SCOPED_TRACE(fmt::format("{} {} {}", model, formulation, step));
        const Scene scene = hardly_damped(scene_of(model));
        const Lost coarse = lost(scene, implicit_euler(formulation, step, 1.5));
        std::smatch found;
        if (!std::regex_search(coarse.remedy, found, pattern)) continue;
        const Lost fine = lost(scene, implicit_euler(formulation, 0.99 * std::stod(found[1]), 1.5));
        EXPECT_EQ(fine.told, 0);
        if (std::string_view(model) == "simple_pendulum") {  // the other one has dampers
          EXPECT_LT(fine.percent, 6);
        }
        ++offered;
      }
  EXPECT_GE(offered, 12);
}

// Of most of a motion what is left says little of how it goes in finer steps: none is offered.
TEST(NumericalDamping, is_not_extrapolated_from_most_of_the_motion) {
  const Scene scene = scene_of("andrews");
  const Lost coarse = lost(scene, implicit_euler("rA", 2e-3, 0.03));
  ASSERT_GT(coarse.told, 50);
  EXPECT_EQ(coarse.remedy, "of so much it cannot be told which step would take little; rattle or error control do");
  Settings settings = implicit_euler("rA", 1e-5, 0.03);
  settings.integrator = "rattle";
  EXPECT_EQ(lost(scene, settings).told, 0);
}

// Falls from the horizontal about a hinge at x = at.
void add_pendulum(Scene& scene, const char* name, double arm, double at) {
  Body bob;
  bob.name = name, bob.mass = 1, bob.inertia = 0.01 * arm * arm * Matrix3::Identity(), bob.position = {at + arm, 0, 0};
  Joint hinge;
  hinge.i = kGround, hinge.j = static_cast<int>(scene.bodies.size()), hinge.point = {at, 0, 0}, hinge.axis = {0, 1, 0};
  scene.gravity = {0, 0, -9.81};
  scene.bodies.push_back(bob);
  scene.joints.push_back(hinge);
}

std::string notice(const Scene& scene, const Settings& settings) {
  std::string all;
  for (const std::string& sentence : simulate(scene, settings, {}).notices) all += sentence;
  return all;
}

// A large mechanism beside a small one does not drown it, nor one that drivers lead.
TEST(NumericalDamping, is_told_by_mechanism) {
  Scene alone, both;
  add_pendulum(alone, "small", 0.02, 0);
  add_pendulum(both, "large", 20, 50);
  add_pendulum(both, "small", 0.02, 0);
  const Settings settings = implicit_euler("rA", 1e-3, 2);
  const auto told = [&](const Scene& scene) {
    std::smatch found;
    const std::string said = notice(hardly_damped(scene), settings);
    EXPECT_TRUE(std::regex_search(
        said, found,
        std::regex("some ([0-9.e-]+) J or more out of the motion(.*) by itself, ([0-9.]+) % of (the|its) largest")))
        << said;
    return std::vector<std::string>(found.begin() + 1, found.end());
  };
  const std::vector<std::string> of_alone = told(alone), of_both = told(both);
  ASSERT_EQ(of_alone.size(), 4u);
  ASSERT_EQ(of_both.size(), 4u);
  EXPECT_EQ(of_alone[0], of_both[0]);
  EXPECT_EQ(of_alone[1], "");
  EXPECT_EQ(of_both[1], " of the mechanism of body 'small' (/bodies/1)");
  EXPECT_EQ(of_alone[2], of_both[2]);

  Scene driven;
  add_pendulum(driven, "large", 20, 50);
  add_pendulum(driven, "led", 0.02, 0);
  Driver driver;
  driver.i = kGround, driver.j = 1, driver.axis = {0, 1, 0}, driver.value = Expression::parse("sin(40*t)/40");
  driven.drivers.push_back(driver);
  for (const char* formulation : {"rA", "rp", "reps"})
    EXPECT_THAT(notice(driven, implicit_euler(formulation, 1e-3, 2)), Not(HasSubstr("by itself"))) << formulation;
}

// Forces and torques that are functions of time give what they give, whatever the way.
TEST(NumericalDamping, IsNotWhatFunctionsOfTimeDo) {
  for (const char* push : {"10*sin(20*t)", "1000*(step(t - 0.3) - step(t - 0.301))", "10*step(0.1 - t)"}) {
    for (const Frame frame : {Frame::global, Frame::body}) {
      Scene slide, wheel;
      add_pendulum(slide, "slider", 1, 0);
      slide.gravity = {0, 0, 0};
      slide.joints[0].type = JointType::translational, slide.joints[0].axis = {0.48, 0.6, 0.64};
      PointForce force;
      force.body = 0, force.frame = frame;
      for (int k = 0; k < 3; ++k)
        force.force[k] = Expression::parse(fmt::format("{}*({})", slide.joints[0].axis[k], push));
      slide.forces.push_back(force);
      add_pendulum(wheel, "wheel", 0.1, 0);
      wheel.gravity = {0, 0, 0}, wheel.joints[0].point = wheel.bodies[0].position, wheel.bodies[0].inertia *= 100;
      Torque torque;
      torque.body = 0, torque.frame = frame, torque.torque[1] = Expression::parse(push);
      wheel.forces.push_back(torque);
      for (const Scene& scene : {slide, wheel})
        for (const std::string& formulation : formulation_names())
          for (const double step : {1e-3, 1e-2})
            EXPECT_THAT(notice(scene, implicit_euler(formulation, step, 2)), Not(HasSubstr("by itself")))
                << push << ' ' << scene.bodies[0].name << ' ' << formulation << ' ' << step;
    }
  }
}

// What a pendulum loses is told as without a push beside it.
TEST(NumericalDamping, IsToldBesideFunctionsOfTime) {
  for (const std::string& formulation : formulation_names()) {
    Scene scene = point_on_rod();
    const Lost alone = lost(hardly_damped(scene), implicit_euler(formulation, 5e-2, 2));
    ASSERT_GT(alone.told, 1);
    PointForce force;
    force.body = 0, force.force[2] = Expression::parse("1e-3*sin(30*t)"),
    force.force[0] = Expression::parse("1e-3*cos(30*t)");
    scene.forces.push_back(force);
    EXPECT_NEAR(lost(scene, implicit_euler(formulation, 5e-2, 2)).told, alone.told, 0.2);
  }
}

// Drivers alone say how these move; other methods take nothing.
TEST(NumericalDamping, is_not_told_where_there_is_none) {
  EXPECT_EQ(lost(scene_of("four_link"), implicit_euler("rA", 1e-2, 2)).told, 0);
  Settings settings = implicit_euler("rA", 1e-2, 2);
  settings.integrator = "rattle";
  const Lost of = lost(hardly_damped(scene_of("simple_pendulum")), settings);
  EXPECT_EQ(of.told, 0);
  EXPECT_LT(std::abs(of.percent), 1);
}

}  // namespace
}  // namespace poinsot::test
