// Generated scenes: what they promise, and that writing and reading returns the same scene.
#include "core/scene_generator.h"

#include <gtest/gtest.h>

#include "core/model.h"
#include "core/scene_reader.h"
#include "core/scene_writer.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"

namespace poinsot {
namespace {

class Generator : public testing::TestWithParam<SceneGenerator> {};

TEST_P(Generator, MakesAtLeastTheBodiesAskedForAndOneCellMoreAtMost) {
  for (const int bodies : {1, 2, 3, 7, 20}) {
    const int made = static_cast<int>(GetParam().make(bodies).bodies.size());
    EXPECT_GE(made, bodies);
    EXPECT_LT(made, bodies + 3);
  }
}

TEST_P(Generator, StartsOnItsConstraintsWithoutDependentRows) {
  const auto model = std::make_shared<const Model>(compile(GetParam().make(20)));
  const Violation start = violation(model, given_state(*model));
  EXPECT_LT(start.position, 1e-13);
  EXPECT_LT(start.velocity, 1e-13);
  const RankAnalysis rank = analyze_rank(model, given_state(*model), RankNames::none);
  EXPECT_TRUE(rank.dependent.empty());
  EXPECT_GT(rank.degrees_of_freedom(), 0);
}

TEST_P(Generator, IsReadBackFromItsFileToTheLastBit) {
  const Scene made = GetParam().make(5);
  const std::string text = to_json(made);
  const Scene read = parse_scene(text, "generated.json");
  EXPECT_EQ(to_json(read), text);
  ASSERT_EQ(read.bodies.size(), made.bodies.size());
  for (std::size_t k = 0; k < made.bodies.size(); ++k) {
    EXPECT_EQ(read.bodies[k].position, made.bodies[k].position);
    EXPECT_EQ(read.bodies[k].orientation, made.bodies[k].orientation);
    EXPECT_EQ(read.bodies[k].angular_velocity, made.bodies[k].angular_velocity);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Generator, testing::ValuesIn(scene_generators().begin(), scene_generators().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace poinsot
