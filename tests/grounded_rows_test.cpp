// Rows whose two forces have a moment together, CD and pfaffian between moving bodies: what depends on what is found
// through the ground.
#include "integrators/start/grounded_rows.h"

#include <gmock/gmock.h>

#include <numeric>

#include "integrators/start/row_blocks.h"
#include "integrators/start/row_choice.h"
#include "tests/support/grounded_scenes.h"

namespace poinsot::test::grounded {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::vector<int> all_of(const Model& model) {
  std::vector<int> rows(model.rows.size());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(GroundedRows, AreThoseBetweenMovingBodiesAtTwoPoints) {
  const auto found = [](const Scene& scene) {
    const Model model = compile(scene);
    return grounded_rows(model, all_of(model));
  };
  for (const ConstraintType type : {ConstraintType::CD, ConstraintType::pfaffian}) {
    Scene scene = welded(type);
    EXPECT_THAT(found(scene), ElementsAre(0));
    scene.constraints[0].i = kGround;
    EXPECT_THAT(found(scene), IsEmpty());
  }
  Scene hand_made = welded(ConstraintType::CD);  // spherical joint
  hand_made.constraints.clear();
  for (const Vector3& c : {Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 0, 2)})
    add_row(hand_made, ConstraintType::CD, 0, 1, {1, 0, 0}, Vector3::Zero(), c);
  EXPECT_THAT(found(hand_made), IsEmpty());
  hand_made.constraints[1].f = Expression::parse("t");
  EXPECT_THAT(found(hand_made), ElementsAre(0, 1, 2));
}

TEST(GroundedRows, AreOfOneLoopWithAllThatLeadsToTheGround) {
  const auto sizes = [](const Scene& scene) {
    const Model model = compile(scene);
    const Lists blocks = row_blocks(model, all_of(model));
    std::vector<std::size_t> of;
    for (int b = 0; b < blocks.size(); ++b) of.push_back(blocks[b].size());
    return of;
  };
  Scene scene = welded(ConstraintType::CD);
  EXPECT_THAT(sizes(scene), ElementsAre(13));
  scene.constraints[0].s_i = {1, 0, 0};
  EXPECT_THAT(sizes(scene), ElementsAre(13));  // where the points happen to meet, too
  scene.constraints.clear();
  EXPECT_THAT(sizes(scene), UnorderedElementsAre(6, 6));
}

// What is redundant is decided as by a dense decomposition of all rows, and so is what is left without the rows chosen.
TEST(GroundedRows, HaveTheRankOfTheWholeMatrix) {
  for_random_scenes([](const Scene&, const Analyzed& a) {
    EXPECT_EQ(a.rank.rank, a.dense.rank);
    const std::vector<int> kept = all_but(a.model->rows.size(), a.rank.aside);
    Eigen::MatrixXd G_t(a.dense.G_t.rows(), static_cast<Eigen::Index>(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) G_t.col(static_cast<Eigen::Index>(k)) = a.dense.G_t.col(kept[k]);
    EXPECT_EQ(Dense::of(std::move(G_t)).rank, a.dense.rank);
  });
}

TEST(GroundedRows, HaveNullVectorsInBalance) {
  for_random_scenes([](const Scene&, const Analyzed& a) {
    RowChoice choice(a.model, loop_rows(a.model, 0, a.states), a.rank.aside);
    const std::vector<SparseEntries> vectors = choice.null_vectors(0, a.states);
    ASSERT_EQ(vectors.size(), a.rank.aside.size());
    Eigen::MatrixXd N = Eigen::MatrixXd::Zero(a.dense.G_t.cols(), static_cast<Eigen::Index>(vectors.size()));
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      for (const auto& [row, value] : vectors[k])
        N(row, column) = value * a.all.lengths()[static_cast<std::size_t>(row)];
      N.col(column).normalize();
    }
    EXPECT_LT((a.dense.G_t * N).norm(), 1e-10);
  });
}

// A row that is no combination of those kept has no null vector, and none is made up.
TEST(GroundedRows, IndependentRowsHaveNoNullVectors) {
  Scene scene = welded(ConstraintType::CD);
  scene.constraints.clear();
  const auto model = std::make_shared<const Model>(compile(scene));
  const std::vector<BodyState> states = given_state(*model);
  RowChoice choice(model, all_of(*model), {8});
  EXPECT_THAT(choice.null_vectors(0, states), IsEmpty());
  EXPECT_TRUE(choice.has_null_vectors());
}

}  // namespace
}  // namespace poinsot::test::grounded
