// Mechanisms that the absolute tolerance swallows are told, and the atol that is offered brings their accuracy back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::IsEmpty;

// All are of this length and move alike, whatever it is, where their bodies are the only ones.
Scene body_of(double length) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "small", body.mass = 1, body.inertia = length * length * Vector3(0.1, 0.1, 0.1).asDiagonal();
  body.position = {1.7 * length, 0, 0};
  return scene;
}

Scene on_a_spring(double length) {
  Scene scene = body_of(length);
  scene.bodies[0].velocity = {0, 3 * length, 0};
  Spring spring;
  spring.i = kGround, spring.j = 0, spring.stiffness = 100, spring.length = length;
  scene.forces.push_back(spring);
  return scene;
}

Scene on_a_rod(double length) {
  Scene scene = body_of(length);
  scene.gravity = {0, 0, -9.81 * length};
  Constraint rod;
  rod.type = ConstraintType::D, rod.i = kGround, rod.j = 0, rod.f = Expression(std::pow(1.7 * length, 2));
  scene.constraints.push_back(rod);
  return scene;
}

Scene on_a_hinge(double length) {
  Scene scene = body_of(length);
  scene.gravity = {0, 0, -9.81 * length};
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = Vector3::UnitY();
  scene.joints.push_back(hinge);
  return scene;
}

Settings to_tolerance(const char* integrator, double rtol) {
  Settings settings = dynamics("rp", 1e-3, 2, 0.1);
  settings.integrator = integrator, settings.rtol = rtol;
  return settings;
}

// Of positions, in lengths.
double error(const Recorded& run, double length, const std::vector<Snapshot>& exact) {
  double most = 0;
  for (std::size_t k = 0; k < exact.size(); ++k)
    most = std::max(most, (run.samples.at(k).bodies[0].r / length - exact[k].bodies[0].r).norm());
  return most;
}

TEST(SmallMechanisms, are_told_where_atol_swallows_them) {
  int told = 0, silent = 0;
  for (const auto& scene_of_length : {on_a_spring, on_a_rod, on_a_hinge}) {
    const std::vector<Snapshot> exact = motion(scene_of_length(1), to_tolerance("dop853", 1e-13));
    for (const char* integrator : {"dop853", "radau5", "dopri5", "ida"})
      for (const double length : {1.0, 1e-3, 1e-4, 1e-6, 1e-9}) {
        SCOPED_TRACE(fmt::format("{} {}", integrator, length));
        Settings settings = to_tolerance(integrator, 1e-8);
        const Recorded coarse = run(scene_of_length(length), settings);
        ASSERT_TRUE(coarse.outcome.status.ok()) << coarse.outcome.status.message;
        const double off = error(coarse, length, exact);
        if (coarse.outcome.notices.empty()) {
          ++silent;
          EXPECT_LT(off, 2e3 * settings.rtol);
          continue;
        }
        ++told;
        EXPECT_GT(off, 100 * settings.rtol);
        std::smatch found;
        ASSERT_TRUE(std::regex_search(
            coarse.outcome.notices[0], found,
            std::regex("the mechanism of body 'small' .* measures .*; --atol ([0-9.e-]+) serves it")));
        settings.atol = std::stod(found[1]);
        const Recorded fine = run(scene_of_length(length), settings);
        ASSERT_TRUE(fine.outcome.status.ok()) << fine.outcome.status.message;
        EXPECT_THAT(fine.outcome.notices, IsEmpty());
        EXPECT_LT(error(fine, length, exact), 150 * settings.rtol);
      }
  }
  EXPECT_EQ(told, 2 * 4 * 2);
  EXPECT_EQ(silent, 4 * (5 + 3 + 3));
}

// Nor small ones whose size says nothing of how far they go.
TEST(SmallMechanisms, are_let_be_where_they_go_far) {
  Scene thrown = body_of(1e-6);
  thrown.bodies[0].velocity = {3, 0, 4}, thrown.gravity = {0, 0, -9.81};
  Scene heavy = on_a_spring(1e-6);  // 0.1 m
  heavy.gravity = {0, 0, -9.81};
  Scene fast = on_a_spring(1e-6);  // 0.3 m
  fast.bodies[0].velocity = {3, 0, 0};
  Scene far = on_a_spring(1e-6);
  far.bodies[0].position.y() = 1, std::get<Spring>(far.forces[0]).s_i = {0, 1, 0};
  for (const Scene& scene : {thrown, heavy, fast, far})
    EXPECT_THAT(run(scene, to_tolerance("dop853", 1e-8)).outcome.notices, IsEmpty());
  Settings fixed = dynamics("rA", 1e-3, 0.1);
  fixed.integrator = "rattle";
  EXPECT_THAT(run(on_a_spring(1e-6), fixed).outcome.notices, IsEmpty());
}

// Beside a large one that rests such an atol would ask for rounding to be resolved.
TEST(SmallMechanisms, are_sent_to_a_scene_of_their_own) {
  Scene scene = on_a_spring(1e-9);
  Scene large = on_a_spring(1);
  large.bodies[0].velocity.setZero(), large.bodies[0].position.x() = 1, large.bodies[0].name = "large";
  scene.bodies.push_back(large.bodies[0]);
  Spring spring = std::get<Spring>(large.forces[0]);
  spring.j = 1;
  scene.forces.push_back(spring);
  const std::vector<std::string> notices = run(scene, to_tolerance("dop853", 1e-8)).outcome.notices;
  ASSERT_FALSE(notices.empty());
  EXPECT_THAT(notices.back(), ::testing::HasSubstr("; in a scene of its own --atol 2e-19 serves it"));
}

}  // namespace
}  // namespace poinsot::test
