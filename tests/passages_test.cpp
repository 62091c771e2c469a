// Singular positions, passed on the branch that the velocities lead to: posts in a row with couplers, all in one line
// where a run starts, beside it, or on the way.
#include "tests/support/passages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

class Passages : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, Passages, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Passages, OfErrorControl) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
    for (const Passage& passage : passages()) {
      for (const double rtol : {1e-6, 1e-8, 1e-10}) {
        SCOPED_TRACE(::testing::Message() << integrator.name << ' ' << rtol << ' ' << passage);
        const Recorded r = run(passage.scene(), controlled(integrator.name, GetParam(), rtol, kPassed, kPassed));
        ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
        EXPECT_LT(passage.off(r.samples.back().bodies[0]), 10 * rtol);
      }
    }
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      SCOPED_TRACE(::testing::Message() << integrator.name << ' ' << rtol << ", a folding crank");
      const Recorded r = run(folding_crank(0.1), controlled(integrator.name, GetParam(), rtol, kPassed, kPassed));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      const auto& bodies = r.samples.back().bodies;
      EXPECT_NEAR(bodies[2].r.x(), 4 * bodies[0].r.x(), 1e-9);
      EXPECT_LT(bodies[2].r.x(), -0.5);
    }
  }
}

// Of many loops at once, all singular in the same instant.
TEST_P(Passages, OfTenAndFortyLoops) {
  for (const Passage& passage : {Passage{10, 0.05, true}, Passage{10, 0.05, false}, Passage{40, 0.05, false}}) {
    for (const char* integrator : {"dop853", "radau5"}) {
      if (passage.loops == 40 && integrator == std::string("radau5")) continue;
      SCOPED_TRACE(::testing::Message() << integrator << ' ' << passage);
      const Recorded r = run(passage.scene(), controlled(integrator, GetParam(), 1e-6, kPassed, kPassed));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_LT(passage.off(r.samples.back().bodies[0]), 1e-5);
    }
  }
}

// Output times 1e-3 to 1e-7 rad beside the position: what is given out there is the branch's, though rounding alone
// would make velocities of ε/σ² and accelerations of ε/σ³.
TEST_P(Passages, SamplesBesideThePositionAreThoseOfTheBranch) {
  constexpr double kBefore = 0.05, kRtol = 1e-9;
  const Passage passage{1, kBefore, false};
  double flat = 0.016;  // s, when the posts lie flat
  for (int k = 0; k < 40; ++k) flat += swung(1, kBefore, kSpin, flat) / -kSpin;
  for (const double beside : {1e-3, 1e-5, 1e-7}) {
    const double every = flat + beside / -kSpin;
    for (const char* integrator : {"dop853", "radau5"}) {
      SCOPED_TRACE(::testing::Message() << integrator << ' ' << beside);
      const Recorded r = run(passage.scene(), controlled(integrator, GetParam(), kRtol, 2 * every, every));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      const auto& bodies = r.samples[1].bodies;
      EXPECT_NEAR(bodies[0].w.z(), bodies[1].w.z(), 1e-6);
      EXPECT_NEAR(bodies[2].w.z(), 0, 1e-6);
      EXPECT_NEAR(bodies[0].wd.z(), bodies[1].wd.z(), 1e-4);
      EXPECT_NEAR(bodies[2].wd.z(), 0, 1e-4);
    }
  }
}

// Steps of another method than the one that was asked for are told.
TEST_P(Passages, SayWhoseStepsTheyAre) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
    const bool by_another = integrator.name == "radau5" || integrator.name == "ida";
    const Recorded r =
        run(Passage{1, 0.05, false}.scene(), controlled(integrator.name, GetParam(), 1e-8, kPassed, kPassed));
    const auto told = testing::Contains(testing::HasSubstr("those of dop853"));
    if (by_another)
      EXPECT_THAT(r.outcome.notices, told);
    else
      EXPECT_THAT(r.outcome.notices, testing::Not(told));
  }
}

// A torque that sets in just before, in and just after the position: states on the other side are not of the same
// motion.
TEST_P(Passages, OfAForceThatIsSwitchedBeside) {
  constexpr double kTorque = 50, kEnd = 0.05, kJ = 2 * (0.1 + 0.25) + 1, kM = 2 * 0.5 + 1;
  for (const double from : {0.0150, 0.0160, 0.0162, 0.0164, 0.0180}) {
    Scene scene = posts(1, 0.05, kSpin, false);
    Torque& torque = scene.forces.emplace_back().emplace<Torque>();
    torque.body = 0;
    torque.torque[2] = Expression::parse(fmt::format("{}*step(t-{})", kTorque, from));
    double phi = 0.05, w = kSpin;
    constexpr int kSteps = 50000;  // of 1e-6 s
    const auto rate = [&](double at, double t) { return ((t >= from ? kTorque : 0) - kM * 9.81 * std::cos(at)) / kJ; };
    for (int n = 0; n < kSteps; ++n) {
      constexpr double kStep = kEnd / kSteps;
      const double middle = (n + 0.5) * kStep, half = w + 0.5 * kStep * rate(phi, middle);
      const double a = rate(phi + 0.5 * kStep * w, middle);
      phi += kStep * half;
      w += kStep * a;
    }
    for (const char* integrator : {"dop853", "radau5"}) {
      SCOPED_TRACE(::testing::Message() << integrator << ' ' << from);
      const Recorded r = run(scene, controlled(integrator, GetParam(), 1e-8, kEnd, kEnd));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_NEAR(r.samples.back().bodies[0].w.z(), w, 1e-6);
    }
  }
}

// A long motion through five such positions, by every method to the same end.
TEST_P(Passages, OfADoubleFourBar) {
  const Recorded reference = run(scene_of("double_four_bar"), controlled("dop853", "rA", 1e-11, 10, 10));
  ASSERT_TRUE(reference.outcome.status.ok()) << reference.outcome.status.message;
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
    for (const double rtol : {1e-6, 1e-8}) {
      SCOPED_TRACE(::testing::Message() << integrator.name << ' ' << rtol);
      const Recorded r = run(scene_of("double_four_bar"), controlled(integrator.name, GetParam(), rtol, 10, 10));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      double apart = 0;
      for (std::size_t b = 0; b < 5; ++b)
        apart = std::max(apart, (r.samples.back().bodies[b].r - reference.samples.back().bodies[b].r).norm());
      EXPECT_LT(apart, 2000 * rtol);
    }
  }
}

// A rod turned about z by its direction's cosine alone, which says nothing of its rate at a quarter turn: an instant of
// the grid and an output time. What is given out is right, and so is what comes after, or the run stops.
TEST_P(Passages, OfADirectionThatTurnsRoundAtAStepsEnd) {
  for (const double off_centre : {0.0, 1.0}) {
    Scene scene;
    scene.gravity = {0, -9.81 * off_centre, 0};
    Body& rod = scene.bodies.emplace_back();
    rod.name = "rod", rod.mass = 1, rod.inertia = Matrix3::Identity(), rod.angular_velocity = {0, 0, 1};
    rod.position = {off_centre, 0, 0}, rod.velocity = {0, off_centre, 0};
    Joint& hinge = scene.joints.emplace_back();
    hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
    Constraint& sine = scene.constraints.emplace_back();
    sine.name = "sine", sine.type = ConstraintType::DP1, sine.i = kGround, sine.j = 0;
    sine.a_i = {0, 1, 0}, sine.a_j = {1, 0, 0}, sine.f = Expression::parse("sin(t)");
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
      for (const int steps : {10, 16}) {
        SCOPED_TRACE(::testing::Message() << integrator.name << ", a quarter turn in " << steps);
        const double h = std::numbers::pi / 2 / steps;
        Settings settings = controlled(integrator.name, GetParam(), 1e-6, std::numbers::pi, h);
        settings.step = h;
        const Recorded r = run(scene, settings);
        for (const Snapshot& s : r.samples) {
          EXPECT_LT((s.bodies[0].A.col(0) - Vector3(std::cos(s.t), std::sin(s.t), 0)).norm(), 0.02) << s.t;
          EXPECT_NEAR(s.bodies[0].w.z(), 1, 0.02) << s.t;
        }
      }
    }
  }
}

// Steps that creep up to it can come to where rounding chooses the branch: such a run stops.
TEST_P(Passages, NoneIsLeftToRounding) {
  int ended = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
    for (const double before : {0.1, 0.03}) {
      for (const double rtol : {1e-4, 1e-6}) {
        SCOPED_TRACE(::testing::Message() << integrator.name << ' ' << before << ' ' << rtol);
        const Recorded r = run(folding_crank(before), controlled(integrator.name, GetParam(), rtol, kPassed, kPassed));
        if (!r.outcome.status.ok()) continue;
        ++ended;
        const auto& bodies = r.samples.back().bodies;
        EXPECT_LT(bodies[2].r.x(), -0.5);
        EXPECT_NEAR(bodies[2].r.x(), 4 * bodies[0].r.x(), 1e-6);
      }
    }
  }
  EXPECT_GE(ended, 8);
}

}  // namespace
}  // namespace poinsot::test
