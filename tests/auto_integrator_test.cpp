// The default integrator: what it picks, how accurate it is, and that it says so.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/benchmark_references.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A rod on a hinge, one metre to its centre, from the horizontal.
Scene swinging_body() {
  Scene scene;
  scene.name = "pendulum";
  scene.gravity = {0, 0, -9.81};
  Body rod;
  rod.name = "rod";
  rod.mass = 2;
  rod.inertia = Vector3(0.6, 0.01, 0.6).asDiagonal();
  rod.position = {0, 1, 0};
  scene.bodies.push_back(rod);
  Joint hinge;
  hinge.type = JointType::revolute;
  hinge.j = 0;
  hinge.axis = {1, 0, 0};
  scene.joints.push_back(hinge);
  return scene;
}

// The same with a bob on a spring beyond its tip.
Scene with_spring(double stiffness, double damping) {
  Scene scene = swinging_body();
  Body bob;
  bob.name = "bob";
  bob.mass = 1;
  bob.inertia = Vector3(0.1, 0.1, 0.1).asDiagonal();
  bob.position = {0, 3, 0};
  scene.bodies.push_back(bob);
  Spring spring;
  spring.i = 0;
  spring.j = 1;
  spring.s_i = {0, 1, 0};
  spring.stiffness = stiffness;
  spring.damping = damping;
  spring.length = 1;
  scene.forces.push_back(spring);
  return scene;
}

std::vector<std::string> picked(const Outcome& outcome) {
  std::vector<std::string> names;
  for (const MethodWork& work : outcome.statistics.methods) names.emplace_back(work.integrator);
  return names;
}

std::int64_t work(const Statistics& statistics) {
  return statistics.factorizations + statistics.solves;
}

TEST(AutoIntegrator, IsTheDefaultAndTakesAPendulumToItsTolerance) {
  Settings settings;
  EXPECT_TRUE(integrators().require(settings.integrator).picks);
  settings.end = settings.every = 5;
  for (const FormulationEntry& formulation : formulations()) {
    settings.formulation = formulation.name;
    const Recorded r = run(swinging_body(), settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    // θ from +y: (m l² + I) θ̈ = −m g l cos θ
    const double theta = runge_kutta<2>({0, 0}, 5, 200000, [](const Eigen::Vector2d& x) {
      return Eigen::Vector2d(x[1], -2 * 9.81 * std::cos(x[0]) / 2.6);
    })[0];
    EXPECT_LT((r.samples.back().bodies[0].r - Vector3(0, std::cos(theta), std::sin(theta))).norm(), 1e-7);
    EXPECT_THAT(picked(r.outcome), ::testing::ElementsAre("dop853")) << formulation.name;
    EXPECT_EQ(r.outcome.statistics.methods[0].steps, r.outcome.statistics.steps);
    EXPECT_THAT(r.outcome.notices, IsEmpty());
  }
}

TEST(AutoIntegrator, GoesOnWithTheImplicitMethodWhereTheMotionIsStiff) {
  const Scene scene = with_spring(1e8, 1e5);
  Settings settings;
  settings.end = 1;
  settings.every = 0.1;
  Settings tight = settings;
  tight.integrator = "radau5";
  tight.rtol = 1e-10;
  const Recorded exact = run(scene, tight);
  for (const FormulationEntry& formulation : formulations()) {
    settings.formulation = formulation.name;
    const Recorded r = run(scene, settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    ASSERT_THAT(picked(r.outcome), ::testing::ElementsAre("dop853", "radau5"));
    const auto& [first, second] = std::tie(r.outcome.statistics.methods[0], r.outcome.statistics.methods[1]);
    EXPECT_EQ(first.from, 0);
    EXPECT_EQ(first.to, second.from);
    EXPECT_EQ(second.to, 1);
    EXPECT_LT(first.to, 0.05);
    EXPECT_EQ(first.steps + second.steps, r.outcome.statistics.steps);
    EXPECT_LT(r.outcome.statistics.steps, 1000);
    EXPECT_LT(distance(r.samples, exact.samples).r, 1e-6) << formulation.name;
    EXPECT_LE(r.samples.size(), 11u);
  }
}

// Of the motions with the spring, one that swings on it as fast as it can: no step is longer than its period allows.
TEST(AutoIntegrator, StaysExplicitWhereAccuracyHoldsTheSteps) {
  Scene scene = with_spring(1e4, 0);
  scene.bodies[1].velocity = {0, 2, 0};
  Settings settings;
  settings.end = settings.every = 1;
  const Recorded r = run(scene, settings);
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_THAT(picked(r.outcome), ::testing::ElementsAre("dop853"));
}

// Critically damped: dop853's steps are half of 1/|λ| long for the sake of accuracy, far within its stability.
TEST(AutoIntegrator, TriesTheImplicitMethodWhereAccuracyHoldsTheStepsForNothing) {
  const Scene scene = with_spring(1e6, 2e3);
  Settings settings;
  settings.end = settings.every = 5;
  const Recorded r = run(scene, settings);
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_THAT(picked(r.outcome), ::testing::ElementsAre("dop853", "radau5"));
  EXPECT_LT(r.outcome.statistics.methods[0].steps, 50);
  settings.integrator = "radau5";
  const Recorded stiff = run(scene, settings);
  EXPECT_LT(distance(r.samples, stiff.samples).r, 1e-6);
  settings.integrator = "dop853";
  EXPECT_GT(work(run(scene, settings).outcome.statistics), 10 * work(stiff.outcome.statistics));
}

// Against radau5 at the loosest tolerance that takes positions to 1e-6 of the motion, which is what `poinsot advise`
// recommends for these scenes. A solve of the explicit method counts as much as one of radau5, three times its size.
TEST(AutoIntegrator, TakesNoMoreThanThreeTimesTheCheapestWayToAMillionth) {
  struct Stiff {
    double stiffness, damping, end;
  };
  for (const Stiff& one : {Stiff{1e6, 2e3, 1}, {1e6, 2e3, 5}, {1e7, 2e4, 2}, {1e8, 1e5, 2}}) {
    SCOPED_TRACE(::testing::Message() << one.stiffness << " N/m, " << one.damping << " N s/m, " << one.end << " s");
    const Scene scene = with_spring(one.stiffness, one.damping);
    Settings settings;
    settings.end = one.end;
    settings.every = one.end / 20;
    const Statistics chosen = run(scene, settings).outcome.statistics;
    settings.integrator = "radau5";
    settings.rtol = 1e-10;
    const Recorded exact = run(scene, settings);
    std::int64_t least = 0;
    for (const double rtol : {1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8}) {
      settings.rtol = rtol;
      const Recorded r = run(scene, settings);
      if (distance(r.samples, exact.samples).r > 1e-6) continue;
      least = work(r.outcome.statistics);
      break;
    }
    EXPECT_GT(least, 0);
    EXPECT_LT(work(chosen), 3 * least);
  }
}

TEST(AutoIntegrator, GoesBackFromATrialThatDidNotPay) {
  Settings settings;
  settings.end = settings.every = 30;
  const Recorded r = run(swinging_body(), settings);
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  ASSERT_THAT(picked(r.outcome), ::testing::ElementsAre("dop853", "radau5", "dop853"));
  EXPECT_EQ(r.outcome.statistics.methods[1].steps, 6);
  settings.integrator = "dop853";
  EXPECT_LT(distance(r.samples, run(swinging_body(), settings).samples).r, 1e-6);
}

TEST(AutoIntegrator, ExplicitMethodsSayThatAMotionIsStiff) {
  Settings settings;
  settings.end = settings.every = 0.02;
  settings.rtol = 1e-6;
  for (const auto& [integrator, formulation] : {std::pair("dopri5", "rA"),
                                                {"dopri5", "rp"},
                                                {"dopri5", "reps"},
                                                {"dop853", "rA"},
                                                {"dop853", "rp"},
                                                {"dop853", "reps"}}) {
    settings.integrator = integrator;
    settings.formulation = formulation;
    std::vector<std::string> told;
    const Outcome outcome =
        simulate(with_spring(1e8, 1e5), settings, {}, [&](const std::string& n) { told.push_back(n); });
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
    ASSERT_EQ(outcome.notices.size(), 1u) << integrator << ' ' << formulation;
    EXPECT_EQ(told, outcome.notices);
    EXPECT_THAT(outcome.notices[0], HasSubstr("stiff"));
    EXPECT_THAT(outcome.notices[0], HasSubstr("radau5"));
    EXPECT_THAT(simulate(swinging_body(), settings, {}).notices, IsEmpty());
  }
}

// A steady rotation, about which next to nothing swings as fast as the body turns: the steps of an implicit method
// would be no longer.
TEST(AutoIntegrator, StaysExplicitWhereABodyTurnsSteadily) {
  struct Spin {
    Vector3 inertia, w;
  };
  for (const auto& [inertia, w] : {Spin{{1, 1, 1.0001}, {1e-3, 0, 1000}},
                                   {{1, 1.1, 2}, {0, 1e-6, 100}},
                                   {{2, 2.001, 1}, {0, 1e-6, 100}},
                                   {{1, 1.00001, 1.00002}, {0, 1e-6, 100}}}) {
    Scene scene;
    Body body;
    body.name = "body", body.mass = 1, body.inertia = inertia.asDiagonal(), body.angular_velocity = w;
    scene.bodies.push_back(body);
    for (const char* integrator : {"dopri5", "dop853", "auto"})
      for (const FormulationEntry& formulation : formulations()) {
        SCOPED_TRACE(fmt::format("{} {} {}", inertia.z(), integrator, formulation.name));
        Settings settings;
        settings.integrator = integrator, settings.formulation = formulation.name;
        settings.end = settings.every = 10 * 100 / w.z();
        const Outcome outcome = simulate(scene, settings, {});
        ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
        EXPECT_THAT(outcome.notices, Each(Not(HasSubstr("stiff"))));
        if (integrator == std::string_view("auto")) {
          settings.integrator = "dop853";
          const Outcome alone = simulate(scene, settings, {});
          EXPECT_LT(static_cast<double>(work(outcome.statistics)), 1.5 * static_cast<double>(work(alone.statistics)));
        }
      }
  }
}

// Every model with no options, against a method of another kind.
TEST(AutoIntegrator, ReachesAMillionthOnEveryModel) {
  int compared = 0;
  for (const std::string& model : model_names()) {
    const Scene scene = scene_of(model);
    SCOPED_TRACE(model);
    Settings settings;
    settings.end = model == "andrews" ? 0.02 : 1;
    settings.every = settings.end / 10;
    const Recorded r = run(scene, settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    Settings tight = settings;
    tight.integrator = "radau5";
    tight.formulation = "rp";
    tight.rtol = 1e-11;
    Recorded exact = run(scene, tight);
    if (!exact.outcome.status.ok()) {  // at a singular position
      tight.integrator = "dopri5";
      tight.rtol = 1e-10;
      exact = run(scene, tight);
    }
    ASSERT_TRUE(exact.outcome.status.ok()) << exact.outcome.status.message;
    const Distance d = distance(r.samples, exact.samples);
    EXPECT_LT(std::max(d.r, d.A), 1e-6) << d;
    ++compared;
  }
  EXPECT_GT(compared, 15);
}

}  // namespace
}  // namespace poinsot::test
