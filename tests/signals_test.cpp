// Signals against what is known otherwise: closed forms, statics, and the balance of energy.
#include "integrators/signals.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "tests/support/controlled_ways.h"
#include "tests/support/signals.h"

namespace poinsot::test {
namespace {

Scene scene_from(const std::string& rest, const char* gravity = "[0, 0, -9.81]") {
  return parse_scene(
      R"json({"scene": 1, "name": "signals", "gravity": )json" + std::string(gravity) + ", " + rest + "}", "test");
}

// A rod turned about x by a motor: M = (J + m l²) φ̈ + m g l cos φ, φ from the horizontal.
TEST(Signals, ADrivenPendulumNeedsTheTorqueOfTheClosedForm) {
  const Scene scene =
      scene_from(R"json("bodies": [{"name": "rod", "mass": 3, "inertia": [1, 0.01, 1], "position": [0, 1, 0]}],
    "joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
    "drivers": [{"type": "angle", "name": "motor", "bodies": ["ground", "rod"], "axis": [1, 0, 0], "angle": "4*t^2"}])json");
  for (const char* formulation : {"rA", "rp", "reps"}) {
    Columns c = signals_of(scene, controlled("dop853", formulation, 1e-11, 2, 0.1));
    for (std::size_t n = 0; n < c["t"].size(); ++n) {
      const double t = c["t"][n], phi = 4 * t * t, rate = 8 * t;
      const double moment = 4 * 8 + 3 * 9.81 * std::cos(phi);
      EXPECT_NEAR(c["hinge.angle"][n], phi, 1e-8)
          << formulation << " at " << t;  // sixteen radians: the turns are counted
      EXPECT_NEAR(c["hinge.angle_rate"][n], rate, 1e-8) << formulation << " at " << t;
      EXPECT_NEAR(c["motor.value"][n], phi, 1e-12) << formulation << " at " << t;
      EXPECT_NEAR(c["motor.effort"][n], moment, 1e-6) << formulation << " at " << t;
      EXPECT_NEAR(c["motor.power"][n], moment * rate, 1e-5) << formulation << " at " << t;
      EXPECT_NEAR(c["kinetic"][n], 0.5 * 4 * rate * rate, 1e-6) << formulation << " at " << t;
      EXPECT_NEAR(c["potential"][n], 3 * 9.81 * std::sin(phi), 1e-6) << formulation << " at " << t;
      EXPECT_NEAR(c["Lx"][n], 4 * rate, 1e-7) << formulation << " at " << t;
      EXPECT_NEAR(c["py"][n], -3 * std::sin(phi) * rate, 1e-7) << formulation << " at " << t;
    }
  }
}

TEST(Signals, KinematicsFindsTheSameEffort) {
  const Scene scene =
      scene_from(R"json("bodies": [{"name": "rod", "mass": 3, "inertia": [1, 0.01, 1], "position": [0, 1, 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
    "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [1, 0, 0], "angle": "4*t^2"}])json");
  Columns c = signals_of(scene, kinematics("rA", 1e-2, 1, 0.1));
  for (std::size_t n = 0; n < c["t"].size(); ++n) {
    const double t = c["t"][n];
    EXPECT_NEAR(c["angle1.effort"][n], 4 * 8 + 3 * 9.81 * std::cos(4 * t * t), 1e-9) << t;
  }
}

// At a sample where ḟ or a law of time jumps, all is of the side that the state is of, which comes after.
TEST(Signals, AtAKinkAreThoseOfOneSide) {
  const Scene driven =
      scene_from(R"json("bodies": [{"name": "wheel", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "wheel"], "axis": [0, 0, 1], "point": [0, 0, 0]}],
    "drivers": [{"type": "angle", "name": "motor", "bodies": ["ground", "wheel"], "axis": [0, 0, 1],
                 "angle": "t + max(0, t - 0.5)"}],
    "forces": [{"type": "linear_drag", "body": "wheel", "rotational": 2}])json");
  const Scene pulled =
      scene_from(R"json("bodies": [{"name": "block", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
    "joints": [{"type": "translational", "bodies": ["ground", "block"], "axis": [1, 0, 0], "point": [0, 0, 0]}],
    "forces": [{"type": "spring", "name": "s", "bodies": ["ground", "block"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "length": 0, "law": "3*sign(t - 0.5)"}])json");
  for (const ControlledWay& way : controlled_ways()) {
    SCOPED_TRACE(way.integrator + " " + way.formulation);
    Columns c = signals_of(driven, controlled(way.integrator, way.formulation, 1e-8, 1, 0.25));
    EXPECT_DOUBLE_EQ(c["t"][2], 0.5);
    EXPECT_NEAR(c["motor.effort"][2], 4, 1e-6);
    EXPECT_NEAR(c["motor.power"][2], 8, 1e-6);
    c = signals_of(pulled, controlled(way.integrator, way.formulation, 1e-8, 1, 0.25));
    EXPECT_DOUBLE_EQ(c["t"][2], 0.5);
    EXPECT_DOUBLE_EQ(c["s.force"][2], 3);
  }
}

// dE = ∫ (driver power − dissipation) dt, by Simpson's rule over every step.
TEST(Signals, EnergyIsWhatDriversGiveAndDampersTake) {
  const Scene scene = scene_from(R"json("bodies": [
      {"name": "cart", "mass": 2, "inertia": [1, 1, 1], "position": [0, 0, 0]},
      {"name": "bob", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 1, -1]}],
    "joints": [{"type": "translational", "name": "slide", "bodies": ["ground", "cart"], "point": [0, 0, 0], "axis": [0, 1, 0]},
               {"type": "universal", "name": "cross", "bodies": ["cart", "bob"], "point": [0, 0, -0.2], "axis_i": [1, 0, 0], "axis_j": [0, 1, 0]}],
    "drivers": [{"type": "distance", "name": "ram", "bodies": ["ground", "cart"], "s_i": [0, -2, 0], "s_j": [0, 0, 0], "length": "2 + 0.3*sin(3*t)"}],
    "forces": [{"type": "spring", "name": "damper", "bodies": ["ground", "bob"], "s_i": [1, 1, -1], "s_j": [0, 0, 0], "stiffness": 20, "damping": 2, "length": 0.5},
               {"type": "torsion_spring", "name": "twist", "bodies": ["cart", "bob"], "axis": [1, 0, 0], "stiffness": 5, "damping": 0.3}])json");
  Columns c = signals_of(scene, controlled("dop853", "rA", 1e-11, 1, 0.005));
  const auto net = [&](std::size_t n) {
    return c["ram.power"][n] - 2 * c["damper.rate"][n] * c["damper.rate"][n] -
           0.3 * c["twist.rate"][n] * c["twist.rate"][n];
  };
  double sum = c["energy"][0];
  for (std::size_t n = 2; n < c["t"].size(); n += 2) {
    sum += (c["t"][n] - c["t"][n - 2]) / 6 * (net(n - 2) + 4 * net(n - 1) + net(n));
    EXPECT_NEAR(c["energy"][n], sum, 1e-6) << c["t"][n];
  }
  EXPECT_GT(std::abs(c["energy"].back() - c["energy"].front()), 0.1);
  for (std::size_t n = 0; n < c["t"].size(); ++n) {
    const double t = c["t"][n];
    EXPECT_NEAR(c["slide.slide"][n], 0.3 * std::sin(3 * t), 1e-9);
    EXPECT_NEAR(c["slide.slide_rate"][n], 0.9 * std::cos(3 * t), 1e-8);
    EXPECT_NEAR(c["ram.tension"][n], -c["ram.effort"][n], 1e-9);
    EXPECT_NEAR(c["damper.force"][n], 20 * (c["damper.length"][n] - 0.5) + 2 * c["damper.rate"][n], 1e-9);
    EXPECT_NEAR(c["twist.torque"][n], 5 * c["twist.angle"][n] + 0.3 * c["twist.rate"][n], 1e-9);
  }
  // Rates are the derivatives of what they are rates of.
  const double h = 0.005;
  for (const char* name : {"cross.angle_i", "cross.angle_j", "damper.length", "twist.angle", "slide.slide"}) {
    const std::string of = name;
    const std::vector<double>& rates =
        c.contains(of + "_rate") ? c[of + "_rate"] : c[of.substr(0, of.find('.')) + ".rate"];
    for (std::size_t n = 2; n + 2 < c["t"].size(); ++n) {
      const double slope = (c[of][n - 2] - 8 * c[of][n - 1] + 8 * c[of][n + 1] - c[of][n + 2]) / (12 * h);
      ASSERT_NEAR(rates[n], slope, 1e-4) << name << " at " << c["t"][n];
    }
  }
}

// A weight on two lines at 30 degrees to the horizontal: each pulls with m g.
TEST(Signals, TensionsOfStatics) {
  const Scene scene =
      scene_from(R"json("bodies": [{"name": "weight", "mass": 2, "inertia": [1, 1, 1], "position": [0, 0, -1]}],
    "constraints": [
      {"type": "D", "name": "left", "bodies": ["ground", "weight"], "s_i": ["-sqrt(3)", 0, 0], "s_j": [0, 0, 0], "f": 4},
      {"type": "D", "name": "right", "bodies": ["weight", "ground"], "s_i": [0, 0, 0], "s_j": ["sqrt(3)", 0, 0], "f": 4},
      {"type": "CD", "name": "plane", "bodies": ["ground", "weight"], "c": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0]}])json");
  Columns c = signals_of(scene, controlled("dopri5", "rA", 1e-9, 0.1, 0.05));
  for (const char* line : {"left.tension", "right.tension"})
    for (const double tension : c[line]) EXPECT_NEAR(tension, 2 * 9.81, 1e-9) << line;
}

// Turns are followed through the run, not from row to row.
TEST(Signals, TurnsAreCountedBetweenRows) {
  const Scene scene = scene_from(
      R"json("bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0], "angular_velocity": [0, 0, -40]}],
    "joints": [{"type": "cylindrical", "name": "bearing", "bodies": ["rotor", "ground"], "point": [0, 0, 0], "axis": [0, 0, 1]}])json",
      "[0, 0, 0]");
  Columns c = signals_of(scene, dynamics("rA", 1e-2, 2, 1));
  EXPECT_NEAR(c["bearing.angle"].back(), 80, 1e-9);  // of the ground relative to the rotor
  EXPECT_NEAR(c["bearing.slide"].back(), 0, 1e-12);
}

// Nor from step to step: error control would turn by sixty radians in one.
TEST(Signals, TurnsAreCountedInStepsOfErrorControl) {
  const Scene scene = scene_from(
      R"json("bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0], "angular_velocity": [0, 0, 60]},
      {"name": "other", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 1], "angular_velocity": [0, 0, -40]}],
    "joints": [{"type": "revolute", "name": "bearing", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"type": "cylindrical", "name": "shaft", "bodies": ["rotor", "other"], "point": [0, 0, 0], "axis": [0, 0, 1]}])json",
      "[0, 0, 0]");
  for (const IntegratorEntry& integrator : integrators())
    for (const char* formulation : {"rA", "rp", "reps"}) {
      if (!integrator.controls_error || refusal_of(integrator, formulation)) continue;
      Columns c = signals_of(scene, controlled(integrator.name, formulation, 1e-8, 1, 1));
      EXPECT_NEAR(c["bearing.angle"].back(), 60, 1e-4) << integrator.name << ' ' << formulation;
      EXPECT_NEAR(c["shaft.angle"].back(), -100, 1e-4) << integrator.name << ' ' << formulation;
    }
}

// In a step of fixed length that turns one by more than half a turn nobody can, though each body turns by less.
TEST(Signals, AnglesThatCannotBeCountedStopTheRun) {
  const Scene scene = scene_from(
      R"json("bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0], "angular_velocity": [0, 0, 20]},
      {"name": "other", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 1], "angular_velocity": [0, 0, -20]}],
    "joints": [{"type": "revolute", "name": "bearing", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"type": "revolute", "name": "shaft", "bodies": ["rotor", "other"], "point": [0, 0, 0], "axis": [0, 0, 1]}])json",
      "[0, 0, 0]");
  Settings settings = controlled("rattle", "rA", 1e-8, 1, 1);
  settings.step = 0.1;
  EXPECT_TRUE(simulate(scene, settings, {}).status.ok());
  settings.signals = true;
  const Outcome outcome = simulate(scene, settings, {});
  EXPECT_EQ(outcome.status.failure, Failure::rotation_too_large);
  EXPECT_THAT(outcome.status.message, testing::HasSubstr("joint 'shaft'"));
}

TEST(Signals, ASphericalJointTellsTheRelativeRotation) {
  const Scene scene = scene_from(
      R"json("bodies": [{"name": "ball", "mass": 1, "inertia": [2, 2, 2], "position": [0, 0, 0], "angular_velocity": [1, 2, 2]}],
    "joints": [{"type": "spherical", "name": "socket", "bodies": ["ground", "ball"], "point": [0, 0, 0]}])json");
  Columns c = signals_of(scene, controlled("dop853", "rA", 1e-11, 0.5, 0.1));
  for (std::size_t n = 0; n < c["t"].size(); ++n) {
    EXPECT_NEAR(c["socket.rx"][n], c["t"][n], 1e-9);
    EXPECT_NEAR(c["socket.rz"][n], 2 * c["t"][n], 1e-9);
    EXPECT_NEAR(c["socket.wy"][n], 2, 1e-9);
  }
}

TEST(Signals, NamesWhatEachJointLeavesFree) {
  EXPECT_THAT(
      Signals::names(compile(scene_of("four_link_joints"))),
      ::testing::ElementsAre("kinetic", "potential", "energy", "px", "py", "pz", "Lx", "Ly", "Lz", "revolute1.angle",
                             "revolute1.angle_rate", "universal1.angle_i", "universal1.angle_j",
                             "universal1.angle_i_rate", "universal1.angle_j_rate", "spherical1.rx", "spherical1.ry",
                             "spherical1.rz", "spherical1.wx", "spherical1.wy", "spherical1.wz", "revolute2.angle",
                             "revolute2.angle_rate", "angle1.value", "angle1.effort", "angle1.power"));
}

}  // namespace
}  // namespace poinsot::test
