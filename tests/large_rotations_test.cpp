// What a step turns a body by is measured; where a method cannot follow, the run says so or stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr const char* kAllFormulations[] = {"rA", "rp", "reps"};

Scene spinning(double rate, const Vector3& inertia = {1, 2, 3}) {
  Scene scene;
  Body body;
  body.name = "body", body.mass = 1, body.inertia = inertia.asDiagonal();
  body.angular_velocity = rate * Vector3(0.3, 0.9, 0.3).normalized();
  scene.bodies.push_back(body);
  return scene;
}

// About the fixed axis z, with a torsion spring so soft that it turns `rate` rad and back over pi seconds.
Scene torsional(double rate) {
  Scene scene;
  Body wheel;
  wheel.name = "wheel", wheel.mass = 1, wheel.inertia = Vector3(1, 1, 1).asDiagonal();
  wheel.angular_velocity = {0, 0, rate};
  scene.bodies.push_back(wheel);
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  TorsionSpring spring;
  spring.name = "soft", spring.i = kGround, spring.j = 0, spring.axis = {0, 0, 1}, spring.stiffness = 1;
  scene.forces.push_back(spring);
  return scene;
}

Settings with(std::string_view integrator, std::string_view formulation, double step, double end) {
  Settings s;
  s.integrator = integrator, s.formulation = formulation, s.step = step, s.end = end;
  s.tolerance = 1e-8;
  return s;
}

double energy_change(const Recorded& r, const Scene& scene) {
  const auto energy = [&](const Snapshot& s) { return s.bodies[0].w.dot(scene.bodies[0].inertia * s.bodies[0].w); };
  return energy(r.samples.back()) / energy(r.samples.front()) - 1;
}

TEST(LargeRotations, are_measured_and_warned_of_where_the_pair_is_wrong) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const FormulationEntry& formulation : formulations()) {
      const double wrong = integrator.rotations.in(formulation.space).wrong;
      if (!std::isfinite(wrong)) continue;
      const std::string where = fmt::format("{} {}", integrator.name, formulation.name);
      for (double part : {0.5, 1.4}) {
        const Recorded r = run(spinning(1), with(integrator.name, formulation.name, part * wrong, 20 * part * wrong));
        if (!r.outcome.status.ok()) {
          EXPECT_GT(part, 1) << where << r.outcome.status.message;
          continue;
        }
        double largest = 0;
        for (const Snapshot& at : r.samples) largest = std::max(largest, part * wrong * at.bodies[0].w.norm());
        EXPECT_NEAR(r.outcome.statistics.largest_rotation, largest, 1e-2 * largest)
            << where;  // Newton saw it last before a correction
        EXPECT_EQ(std::ranges::count_if(r.outcome.notices,
                                        [](const std::string& notice) {
                                          return notice.find("rad in a step: from") != std::string::npos;
                                        }),
                  part > 1 ? 1 : 0)
            << where;
      }
    }
  }
}

// In rA and reps rotation about an axis that stays is right up to half a turn a step, which alone is refused; in space
// it is lost long before, and that is told.
TEST(LargeRotations, nothing_is_lost_in_silence) {
  const double turn = 2 * std::numbers::pi;
  int lost = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const char* formulation : kAllFormulations) {
      for (const Vector3& inertia : {Vector3(1, 1, 1), Vector3(1, 1, 2), Vector3(1, 2, 3), Vector3(0.5, 1, 1)}) {
        for (const int steps : {700, 300, 100, 50, 20, 10, 5, 3, 2}) {
          SCOPED_TRACE(fmt::format("{} {}: {} steps a turn", integrator.name, formulation, steps));
          const Scene scene = spinning(1, inertia);
          const Recorded r = run(scene, with(integrator.name, formulation, turn / steps, turn));
          if (!r.outcome.status.ok()) {
            EXPECT_LT(steps, 50) << r.outcome.status.message;
            continue;
          }
          const double off = std::abs(std::sqrt(1 + energy_change(r, scene)) - 1);
          if (!(off > 0.05)) continue;
          ++lost;
          EXPECT_THAT(r.outcome.notices, testing::Contains(testing::HasSubstr("of a free body's rotation"))) << off;
        }
      }
    }
  }
  EXPECT_GT(lost, 50);
}

TEST(LargeRotations, what_is_lost_at_the_default_step_is_said) {
  Settings s;
  s.integrator = "implicit_euler";
  s.formulation = "rp";
  const Scene scene = spinning(100);
  const Recorded r = run(scene, s);
  ASSERT_TRUE(r.outcome.status.ok());
  EXPECT_LT(energy_change(r, scene), -0.5);
  EXPECT_THAT(r.outcome.notices,
              testing::ElementsAre(testing::HasSubstr("of the largest kinetic energy: nothing drives or damps it"),
                                   testing::HasSubstr("turns by up to 0.1 rad in a step")));
}

TEST(LargeRotations, beyond_what_makes_sense_stop_the_run) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const char* formulation : kAllFormulations) {
      const Recorded r = run(spinning(1), with(integrator.name, formulation, 3.3, 33));
      EXPECT_EQ(r.outcome.status.failure, Failure::rotation_too_large) << integrator.name << ' ' << formulation;
      EXPECT_THAT(r.outcome.status.message, testing::HasSubstr("body 'body'"));
    }
  }
}

TEST(TorsionSprings, are_counted_right_by_error_control_whatever_its_steps) {
  const double rate = 1000;
  for (const char* integrator : {"auto", "dopri5", "dop853", "radau5", "ida"})
    for (const char* formulation : kAllFormulations) {
      if (refusal_of(integrators().require(integrator), formulation)) continue;
      Settings s = controlled(integrator, formulation, 1e-6, 0.5, 0.1);
      for (const Snapshot& at : motion(torsional(rate), s))
        EXPECT_NEAR(at.bodies[0].w.z(), rate * std::cos(at.t), 1e-3 * rate)
            << integrator << ' ' << formulation << " t = " << at.t;
    }
}

TEST(TorsionSprings, that_turn_too_far_in_a_fixed_step_stop_the_run) {
  for (const char* integrator :
       {"implicit_euler", "half_implicit", "rattle", "generalized_alpha", "generalized_alpha_i2"})
    for (const char* formulation : kAllFormulations) {
      const Recorded r = run(torsional(100), with(integrator, formulation, 0.0305, 0.305));
      EXPECT_EQ(r.outcome.status.failure, Failure::rotation_too_large) << integrator << ' ' << formulation;
      // rp follows no body that far, with or without a spring on it.
      if (std::string_view(formulation) != "rp") {
        EXPECT_THAT(r.outcome.status.message, testing::HasSubstr("torsion spring 'soft'"));
      }
    }
}

TEST(TorsionSprings, are_counted_right_in_fixed_steps_below_that) {
  const double rate = 100;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const char* formulation : {"rA", "reps"})
      for (const double step : {0.0125, 0.02, 0.025}) {
        const Recorded r = run(torsional(rate), with(integrator.name, formulation, step, 1));
        ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
        EXPECT_NEAR(r.samples.back().bodies[0].w.z(), rate * std::cos(1), integrator.order == 1 ? rate * step : 0.01)
            << integrator.name << ' ' << formulation << " step " << step;
      }
  }
}

// The spring's direction on body c comes to lie along its axis as the shaft tilts it by a quarter turn.
TEST(TorsionSprings, that_lose_their_angle_stop_the_run) {
  const Scene tilting = parse_scene(R"({"scene": 1, "gravity": [0, 0, -9.81], "bodies": [
      {"name": "a", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, 0]},
      {"name": "c", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, 1]}],
      "joints": [
      {"type": "revolute", "bodies": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"type": "universal", "bodies": ["a", "c"], "point": [0, 0, 0.5], "axis_i": [1, 0, 0], "axis_j": [0, 1, 0]}],
      "drivers": [{"type": "angle", "bodies": ["a", "c"], "axis": [1, 0, 0], "angle": "2*t"}],
      "forces": [{"type": "torsion_spring", "name": "soft", "bodies": ["ground", "c"], "axis": [0, 0, 1],
      "stiffness": 1, "damping": 0.1}]})",
                                    "tilting");
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const char* formulation : kAllFormulations)
      for (const double rtol : {1e-6, 1e-8}) {
        if (refusal_of(integrator, formulation)) continue;
        const Recorded r = run(tilting, controlled(integrator.name, formulation, rtol, 1, 0.25));
        EXPECT_FALSE(r.outcome.status.ok()) << integrator.name << ' ' << formulation << ' ' << rtol;
        EXPECT_THAT(r.outcome.status.message, testing::HasSubstr("torsion spring 'soft' has no angle"));
      }
  }
}

// A rod on a hinge, let go level, in steps as long as its swing.
TEST(LargeRotations, a_step_onto_another_branch_stops_the_run) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  Body rod;
  rod.name = "rod", rod.mass = 1, rod.inertia = Vector3(0.001, 1.0 / 12, 1.0 / 12).asDiagonal();
  rod.position = {0.5, 0, 0};
  scene.bodies.push_back(rod);
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  for (const char* integrator :
       {"implicit_euler", "half_implicit", "rattle", "generalized_alpha", "generalized_alpha_i2"})
    for (const char* formulation : kAllFormulations) {
      const Recorded r = run(scene, with(integrator, formulation, 0.5, 10));
      EXPECT_FALSE(r.outcome.status.ok()) << integrator << ' ' << formulation;
    }
}

// A shaft that is held half a metre from its centre of mass, which rests; a bar on two ropes, which does not turn: what
// rounding makes of the one or the other velocity is no branch.
TEST(LargeRotations, centres_that_rest_and_bodies_that_do_not_turn_are_on_no_other_branch) {
  Scene shaft, bar;
  bar.gravity = {0, 0, -9.81};
  Body body;
  body.name = "body", body.mass = 1, body.inertia = Vector3(0.02, 0.05, 0.05).asDiagonal();
  shaft.bodies.push_back(body);
  Joint bearing;
  bearing.j = 0, bearing.point = {0.5, 0, 0}, bearing.axis = {1, 0, 0};
  shaft.joints.push_back(bearing);
  Driver motor;
  motor.j = 0, motor.axis = {1, 0, 0}, motor.value = Expression::parse("3*t");
  shaft.drivers.push_back(motor);
  body.position = {0, 0, -3}, body.velocity = {0, 3, 0};
  bar.bodies.push_back(body);
  for (const double end : {-0.5, 0.5}) {
    Constraint rope;
    rope.type = ConstraintType::D, rope.j = 0;
    rope.s_i = rope.s_j = {end, 0, 0}, rope.f = Expression(9);
    bar.constraints.push_back(rope);
  }
  for (const IntegratorEntry& entry : integrators()) {
    if (entry.controls_error || entry.analysis == Analysis::kinematics) continue;
    for (const char* formulation : kAllFormulations)
      for (const Scene* scene : {&shaft, &bar}) {
        const Recorded r = run(*scene, with(entry.name, formulation, 1e-3, 2));
        EXPECT_TRUE(r.outcome.status.ok()) << entry.name << ' ' << formulation << ": " << r.outcome.status.message;
        EXPECT_THAT(r.outcome.notices, testing::Not(testing::Contains(testing::HasSubstr("certain"))));
        EXPECT_EQ(r.outcome.statistics.divided_steps, 0) << entry.name << ' ' << formulation;
      }
  }
}

}  // namespace
}  // namespace poinsot::test
