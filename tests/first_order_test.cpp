// Rows that follow from others to the first order of a motion only: positions beside show it hardly, those farther off
// do. No run begins where velocities do not say how the motion goes on, but where that keeps to them by itself, and
// then it is told.
#include <gmock/gmock.h>

#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/support/course.h"
#include "tests/support/paradoxic.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A platform on four cables of the same length that hang down: it swings on any three of them as on all, and turns, but
// not both.
Scene cables(int first, const Vector3& swing, double turn) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& platform = scene.bodies.emplace_back();
  platform.name = "platform";
  platform.mass = 5;
  platform.inertia = Vector3(0.5, 0.6, 0.9).asDiagonal();
  platform.position = -Vector3::UnitZ();
  platform.velocity = swing;
  platform.angular_velocity = turn * Vector3::UnitZ();
  for (int k = 0; k < 4; ++k) {
    const int at = (first + k) % 4;
    Constraint& cable = scene.constraints.emplace_back();
    cable.name = fmt::format("cable{}", at);
    cable.type = ConstraintType::D;
    cable.j = 0;
    cable.s_i = cable.s_j = {at % 2 == 0 ? 0.5 : -0.5, at < 2 ? 0.3 : -0.3, 0};
    cable.f = Expression::parse("1");
  }
  return scene;
}

// Hinges about x and y in turn that close a loop.
Scene crosswise(const std::vector<Axis>& axes, Frames frames) {
  Paradoxic made("crosswise", {frames});
  made.loop(axes, {});
  return made.scene();
}
std::vector<Axis> eight() {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  return {{{0, 0, 0}, x},        {{0, 0.05, 0.1}, y},  {{0.2, 0.05, 0.5}, y}, {{0, 0.1, 0.9}, x},
          {{0.1, 0.4, 0.95}, x}, {{0.2, 0.5, 0.5}, y}, {{0.05, 0.5, 0.2}, y}, {{0, 0.5, 0}, x}};
}
// The legs of a biped that stands upright, its trunk between them.
std::vector<Axis> legs() {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  return {{{0, 0.1, 0}, x},    {{0, 0.1, 0.05}, y},  {{0, 0.1, 0.45}, y},  {{0, 0.1, 0.85}, y},  {{0, 0.1, 0.9}, x},
          {{0, -0.1, 0.9}, x}, {{0, -0.1, 0.85}, y}, {{0, -0.1, 0.45}, y}, {{0, -0.1, 0.05}, y}, {{0, -0.1, 0}, x}};
}

RankAnalysis rank_at_start(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  return analyze_rank(model, given_state(*model), RankNames::all);
}

enum class Follows { to_first_order, keeps_to_them };

void expect_told(const Scene& scene, int degrees_of_freedom, Follows follows = Follows::to_first_order) {
  const RankAnalysis rank = rank_at_start(scene);
  EXPECT_TRUE(rank.singular_position());
  EXPECT_TRUE(rank.to_first_order);
  EXPECT_FALSE(rank.moves_on);
  EXPECT_EQ(rank.degrees_of_freedom(), degrees_of_freedom);
  EXPECT_TRUE(rank.aside.empty());
  for (const char* integrator : {"auto", "rattle"}) {
    Settings settings = dynamics("rA", 1e-3, 0.1);
    settings.integrator = integrator;
    const Course course = move(scene, settings);
    if (follows == Follows::keeps_to_them) {
      EXPECT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
      EXPECT_THAT(course.outcome.notices, Contains(HasSubstr("from others to the first order only")));
      continue;
    }
    EXPECT_EQ(course.outcome.status.failure, Failure::singular_position) << integrator;
    EXPECT_THAT(course.outcome.status.message, HasSubstr("to the first order"));
  }
}

TEST(RowsThatFollowToTheFirstOrder, OfFourCablesAreToldWhicheverComesFirst) {
  for (const int first : {0, 1, 2, 3}) {
    SCOPED_TRACE(first);
    expect_told(cables(first, Vector3::UnitX(), 1), 2);
    expect_told(cables(first, Vector3::UnitX(), 0), 2, Follows::keeps_to_them);
    expect_told(cables(first, Vector3::Zero(), 0), 2, Follows::keeps_to_them);
  }
}

TEST(RowsThatFollowToTheFirstOrder, OfSpatialLoopsAreTold) {
  for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
    SCOPED_TRACE(static_cast<int>(frames));
    expect_told(crosswise(eight(), frames), 2);
    expect_told(crosswise(legs(), frames), 4, Follows::keeps_to_them);
  }
}

// Parallel cables that swing only, and what is redundant wherever it stands.
TEST(RowsThatFollowToTheFirstOrder, AreNotSeenWhereTheyFollowEverywhere) {
  Scene planar = cables(0, Vector3::UnitX(), 0);
  Constraint& upright = planar.constraints.emplace_back();
  upright.name = "upright", upright.type = ConstraintType::DP1, upright.j = 0;
  upright.a_i = Vector3::UnitY(), upright.a_j = Vector3::UnitX();
  const RankAnalysis rank = rank_at_start(planar);
  EXPECT_FALSE(rank.singular_position());
  EXPECT_EQ(rank.degrees_of_freedom(), 2);
  Settings settings = dynamics("rA", 1e-3, 0.5);
  settings.integrator = "dop853";
  const Course course = move(planar, settings);
  ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
  for (const Snapshot& sample : course.samples)
    for (const Constraint& cable : planar.constraints) {
      if (cable.type != ConstraintType::D) continue;
      const BodyState& at = sample.bodies[0];
      EXPECT_NEAR((at.r + at.A * cable.s_j - cable.s_i).norm(), 1, 1e-8);
    }
}

}  // namespace
}  // namespace poinsot::test
