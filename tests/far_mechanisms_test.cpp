// Mechanisms some thousands of kilometres from the origin, as in the coordinates of a map, where points are known to
// nanometres: rank and motion are what they are near it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/support/large_scenes.h"
#include "tests/support/scene_transform.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kFar[] = {1e5, 1e6, 5e6, 1e7};

Scene moved(const Scene& scene, double away) {
  Transform by;
  by.t = away * Vector3(0.6, 0.7, 0.4);
  return by.apply(scene);
}

RankAnalysis rank_of(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  return analyze_rank(model, given_state(*model), RankNames::none);
}

TEST(FarMechanisms, HaveTheRankTheyHaveNear) {
  for (const LargeKind& kind : kLargeKinds) {
    const Scene scene = kind.make(300);
    const RankAnalysis near = rank_of(scene);
    for (const double away : kFar) {
      const RankAnalysis far = rank_of(moved(scene, away));
      EXPECT_EQ(far.rank, near.rank) << kind.name << ' ' << away;
      EXPECT_EQ(far.rank_here, near.rank_here) << kind.name << ' ' << away;
      EXPECT_EQ(far.doubt.part, near.doubt.part) << kind.name << ' ' << away;
      EXPECT_EQ(far.conflicts.size(), near.conflicts.size()) << kind.name << ' ' << away;
    }
  }
}

// Where they lie flat.
TEST(FarMechanisms, AreSingularWhereTheyAreSingularNear) {
  Rods parallelogram;
  const Vector3 x = Vector3::UnitX();
  const int crank = parallelogram.rod(Vector3::Zero(), x), rocker = parallelogram.rod(2 * x, 3 * x),
            coupler = parallelogram.rod(x, 3 * x);
  parallelogram.join(kGround, crank, Vector3::Zero());
  parallelogram.join(kGround, rocker, 2 * x);
  parallelogram.join(crank, coupler, x);
  parallelogram.join(rocker, coupler, 3 * x);
  for (const double away : kFar) {
    const RankAnalysis flat = rank_of(moved(parallelogram.scene, away));
    EXPECT_EQ(flat.rank, 17) << away;
    EXPECT_EQ(flat.rank_here, 16) << away;
  }
}

class FarMechanismsOf : public ::testing::TestWithParam<LargeKind> {};

TEST_P(FarMechanismsOf, MoveAsTheyDoNear) {
  Scene scene = GetParam().make(60);
  scene.gravity = {1, -9.81, 2};
  for (const char* integrator : {"auto", "radau5", "rattle", "implicit_euler"}) {
    std::vector<BodyState> near(scene.bodies.size()), end(near);
    for (const double away : {0.0, 5e6, 1e7}) {
      SCOPED_TRACE(fmt::format("{} at {}", integrator, away));
      Settings settings = dynamics("rA", 1e-3, 0.05);
      settings.integrator = integrator;
      const Scene there = moved(scene, away);
      const Vector3 origin = there.bodies[0].position - scene.bodies[0].position;
      const Outcome outcome =
          simulate(there, settings, [&](const Sample& sample) { sample.problem.to_bodies(sample.a, end); });
      ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
      if (away == 0) near = end;
      double apart = 0;
      for (std::size_t b = 0; b < end.size(); ++b) apart = std::max(apart, (end[b].r - origin - near[b].r).norm());
      EXPECT_LT(apart, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FarMechanismsOf, ::testing::ValuesIn(kLargeKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace poinsot::test
