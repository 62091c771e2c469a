// Jumps of laws that a motion passes, as friction where a spring turns it round: every method comes over them, though
// an implicit step may have no solution there, and steps of fixed length say that they go over one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "integrators/settings_table.h"
#include "tests/support/every_way.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kStart = 1, kSpeed = 1, kSpring = 20, kFriction = 3, kSlideMass = 2;

// A slide and a wheel, each with a spring and dry friction.
Scene rubbing(const char* law) {
  return parse_scene(fmt::format(R"json({{"scene": 1, "name": "rubbing", "gravity": [0, 0, -9.81], "bodies": [
    {{"name": "slide", "mass": 2, "inertia": [1, 1, 1], "position": [1, 0, 0], "velocity": [1, 0, 0]}},
    {{"name": "wheel", "mass": 1, "inertia": [1, 1, 2], "position": [0, 0, 0], "angular_velocity": [0, 0, 1]}}],
    "joints": [{{"type": "translational", "bodies": ["ground", "slide"], "point": [1, 0, 0], "axis": [1, 0, 0]}},
    {{"type": "revolute", "bodies": ["ground", "wheel"], "point": [0, 0, 0], "axis": [0, 0, 1]}}],
    "forces": [{{"type": "spring", "name": "rail", "bodies": ["ground", "slide"], "s_i": [-5, 0, 0], "s_j": [0, 0, 0],
    "length": 5, "law": "{0}"}}, {{"type": "torsion_spring", "name": "brake", "bodies": ["ground", "wheel"],
    "axis": [0, 0, 1], "angle": -1, "law": "{0}"}}]}})json",
                                 law),
                     "test");
}

// x of either at a time, by arcs of cosines about ∓ kFriction / kSpring.
double exact(double t) {
  const double w = std::sqrt(kSpring / kSlideMass);
  double side = 1, middle = -kFriction / kSpring;
  double amplitude = std::hypot(kStart - middle, kSpeed / w), turns = std::atan2(kSpeed / w, kStart - middle) / w;
  for (double since = turns; t > turns; side = -side, since = turns) {
    const double furthest = middle + side * amplitude;
    middle = -middle;
    amplitude = std::abs(furthest - middle);
    turns = since + std::numbers::pi / w;
  }
  return middle + side * amplitude * std::cos(w * (t - turns));
}

TEST(LawJumps, ArePassedByEveryMethod) {
  const Scene scene = rubbing("3*sign(v) + 20*x");
  for (const double step : {1e-2, 1e-3}) {
    const int ways = in_every_way(step, 2.5, [&](Settings settings) {
      SCOPED_TRACE(step);
      const bool controls = chooses_steps(settings);
      settings.rtol = 1e-6;
      const Recorded r = run(scene, settings);
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      const double x = exact(settings.end), asked = controls ? 1e-5 : 6 * step;
      const std::vector<BodyState>& bodies = r.samples.back().bodies;
      EXPECT_NEAR(bodies[0].r.x(), x, asked);
      EXPECT_NEAR(std::remainder(std::atan2(bodies[1].A(1, 0), bodies[1].A(0, 0)) + 1 - x, 2 * std::numbers::pi), 0,
                  asked);
      const auto told = std::ranges::count_if(r.outcome.notices, [](const std::string& notice) {
        return notice.find("jumps: steps of fixed length go over it") != std::string::npos;
      });
      EXPECT_EQ(told, controls ? 0 : 1);
    });
    EXPECT_GT(ways, 20);
  }
}

// One side leads to the jump only by what damps there, and the motion stays beside it.
TEST(LawJumps, BesideWhichAMotionComesToRestAreNoneToStickTo) {
  in_every_way(1e-3, 2, [&](const Settings& settings) {
    const Recorded r = run(rubbing("50*step(v) + 2*v"), settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_NEAR(r.samples.back().bodies[0].r.x(), 1.02, 0.03);
  });
}

TEST(LawJumps, AreNotToldWhereNoneIsPassed) {
  Settings settings = dynamics("rA", 1e-3, 0.08);
  settings.integrator = "implicit_euler";
  const Recorded r = run(rubbing("3*sign(v) + 20*x"), settings);
  ASSERT_TRUE(r.outcome.status.ok());
  EXPECT_THAT(r.outcome.notices, ::testing::Not(Contains(HasSubstr("jumps"))));
}

// Nor where a sign is passed at which another factor is zero.
TEST(LawJumps, AreNoneOfContinuousLaws) {
  in_every_way(1e-2, 2.5, [&](const Settings& settings) {
    const Recorded r = run(rubbing("3*sign(v)*min(1, abs(v)/0.2) + 20*x"), settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_THAT(r.outcome.notices, ::testing::Not(Contains(HasSubstr("jumps"))));
  });
}

}  // namespace
}  // namespace poinsot::test
