// Springs that are stiff beside the step: its equations have a solution on either side of no length, and only that is
// taken to which the ends' velocities lead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene_reader.h"
#include "integrators/stepping/turned_in_steps.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kStep = 1e-2;

// A bob at 1 + `out` m from where a spring of 1 m is held, (h ω)² = `stiff`, at a speed along it, m/s; free, or on a
// rail.
Scene on_a_spring(double stiff, double out, double speed, bool rail, const char* law = nullptr) {
  Scene scene;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = Vector3(1, 1, 1).asDiagonal();
  bob.position = {1 + out, 0, 0}, bob.velocity = {speed, 0, 0};
  if (rail) {
    Joint& joint = scene.joints.emplace_back();
    joint.name = "rail", joint.type = JointType::translational, joint.i = kGround, joint.j = 0, joint.axis = {1, 0, 0};
  }
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0, spring.length = 1;
  spring.stiffness = stiff / (kStep * kStep);
  if (law) spring.law = Expression::parse_law(law), spring.stiffness = 0;
  scene.forces.emplace_back(spring);
  return scene;
}

double nearest(const Recorded& r) {
  double least = HUGE_VAL;
  for (const Snapshot& at : r.samples) least = std::min(least, at.bodies[0].r.x());
  return least;
}

TEST(SpringSides, StiffSpringsStayOnTheirs) {
  for (const char* integrator : {"implicit_euler", "generalized_alpha"})
    for (const FormulationEntry& formulation : formulations())
      for (const bool rail : {true, false})
        for (const double stiff : {25.0, 100.0, 1e4}) {
          // of undamped ones the vibration goes on, and its own velocities lead over in a step
          if (stiff > 25 && std::string_view(integrator) != "implicit_euler") continue;
          SCOPED_TRACE(fmt::format("{} {} {} {}", integrator, formulation.name, rail, stiff));
          Settings settings;
          settings.integrator = integrator, settings.formulation = formulation.name;
          settings.step = kStep, settings.end = 5 * kStep;
          const Recorded r = run(on_a_spring(stiff, 0.1, 0, rail), settings);
          EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
          EXPECT_GT(nearest(r), 0);
        }
}

// Where steps may not be divided the run stops, and with the step it names it goes on.
TEST(SpringSides, AStepThatDoesNotStopsTheRun) {
  const Scene scenes[] = {on_a_spring(25, 0.1, 0, true), on_a_spring(0, 0.1, 0, true, "250000*x")};
  for (const Scene& scene : scenes)
    for (const char* integrator : {"implicit_euler", "generalized_alpha", "generalized_alpha_i2"}) {
      SCOPED_TRACE(integrator);
      Settings settings;
      settings.integrator = integrator, settings.step = kStep, settings.end = 5 * kStep, settings.retry = false;
      const Recorded r = run(scene, settings);
      EXPECT_EQ(r.outcome.status.failure, Failure::not_converged);
      EXPECT_THAT(r.outcome.status.message,
                  AllOf(HasSubstr("spring 'spring'"), HasSubstr("through no length to the other side")));
      EXPECT_EQ(r.samples.size(), 1u);
      ASSERT_GT(r.outcome.status.step, 0);
      settings.step = r.outcome.status.step;
      EXPECT_GT(nearest(run(scene, settings)), 0);
    }
}

// Ends that go through no length by their velocities are none of it.
TEST(SpringSides, WhatVelocitiesLeadToIsLeftAlone) {
  const Scene scenes[] = {on_a_spring(1e-4, -0.9, -20, true), on_a_spring(0.01, -0.99, -30, false)};
  for (const Scene& scene : scenes)
    for (const char* integrator : {"implicit_euler", "rattle", "generalized_alpha"}) {
      Settings settings;
      settings.integrator = integrator, settings.step = kStep, settings.end = 5 * kStep;
      const Recorded r = run(scene, settings);
      EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_LT(nearest(r), 0) << integrator;
      EXPECT_THAT(r.outcome.notices, Each(Not(HasSubstr("done in parts"))));
    }
}

// Short stiff springs that hold bodies together like pins: coarse steps go over no length of theirs to and fro.
TEST(SpringSides, PinsHaveNone) {
  const Scene scene = read_scene(POINSOT_SOURCE_DIR "/tests/scenes/bushings.json");
  for (const char* integrator : {"implicit_euler", "generalized_alpha", "generalized_alpha_i2"}) {
    Settings settings;
    settings.integrator = integrator, settings.step = 0.02, settings.end = 1;
    const Recorded r = run(scene, settings);
    EXPECT_TRUE(r.outcome.status.ok()) << integrator << ": " << r.outcome.status.message;
    EXPECT_THAT(r.outcome.notices, Each(Not(HasSubstr("done in parts"))));
  }
}

}  // namespace
}  // namespace poinsot::test
