// A parallelogram of three bodies that passes its flat position over and over: rounding that steps towards it have
// gathered, and steps that only look for it, must not stop it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kStartAngle = 1;  // rad, of both cranks, which are 0.5 m long

// One of its hinges lets the coupler slide.
Scene flat_passing(double spin) {
  const double c = std::cos(kStartAngle), s = std::sin(kStartAngle);
  const auto crank = [&](const char* name, double foot) {
    return fmt::format(R"j({{"name": "{}", "mass": 1, "inertia": [0.02, 0.02, 0.02],
        "position": [{:.17g}, 0, {:.17g}], "velocity": [{:.17g}, 0, {:.17g}], "angular_velocity": [0, {:.17g}, 0]}})j",
                       name, foot + 0.25 * c, 0.25 * s, -0.25 * s * spin, 0.25 * c * spin, -spin);
  };
  const auto hinge = [](const char* type, const char* i, const char* j, double x, double z) {
    return fmt::format(R"j({{"type": "{}", "bodies": ["{}", "{}"], "point": [{:.17g}, 0, {:.17g}],
        "axis": [0, 1, 0]}})j",
                       type, i, j, x, z);
  };
  return parse_scene(
      fmt::format(R"j({{"scene": 1, "gravity": [0, 0, -9.81], "bodies": [{}, {}, {{"name": "coupler", "mass": 2,
      "inertia": [0.1, 0.1, 0.1], "position": [{:.17g}, 0, {:.17g}], "velocity": [{:.17g}, 0, {:.17g}]}}],
      "joints": [{}, {}, {}, {}]}})j",
                  crank("a", 0), crank("b", 1), 0.5 + 0.5 * c, 0.5 * s, -0.5 * s * spin, 0.5 * c * spin,
                  hinge("revolute", "ground", "a", 0, 0), hinge("revolute", "a", "coupler", 0.5 * c, 0.5 * s),
                  hinge("revolute", "ground", "b", 1, 0), hinge("cylindrical", "b", "coupler", 1 + 0.5 * c, 0.5 * s)),
      "parallelogram");
}

// Kinetic and potential energy by the coupler alone, which all of it moves with, J.
double energy_of(const BodyState& coupler) {
  constexpr double kInertia = 2 * (0.02 + 0.25 * 0.25) + 2 * 0.5 * 0.5, kMoment = 2 * 0.25 + 2 * 0.5;
  return 0.5 * kInertia * coupler.rd.squaredNorm() / 0.25 + kMoment * 9.81 * coupler.r.z() / 0.5;
}

struct Turning {
  const char* formulation;
  double spin, rtol;
};

class RepeatedPassages : public ::testing::TestWithParam<Turning> {};
INSTANTIATE_TEST_SUITE_P(All, RepeatedPassages,
                         ::testing::Values(Turning{"rA", 12, 1e-8}, Turning{"rA", 6, 1e-9}, Turning{"rp", 12, 1e-8},
                                           Turning{"rp", 6, 1e-10}, Turning{"reps", 12, 1e-8},
                                           Turning{"reps", 6, 1e-10}));

TEST_P(RepeatedPassages, GoOn) {
  const Turning& of = GetParam();
  SCOPED_TRACE(fmt::format("{} {} {}", of.formulation, of.spin, of.rtol));
  const Scene scene = flat_passing(of.spin);
  const Recorded r = run(scene, controlled("auto", of.formulation, of.rtol, 20, 0.5));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  const double energy = energy_of(r.samples.front().bodies[2]);
  for (const Snapshot& at : r.samples) {
    EXPECT_NEAR(energy_of(at.bodies[2]), energy, 1e-6 * energy) << at.t;
    EXPECT_NEAR((at.bodies[2].A - Matrix3::Identity()).norm(), 0, 1e-8) << at.t;
  }
}

}  // namespace
}  // namespace poinsot::test
