// The formulations' matrices and vectors: which entries are stored, whose they are, and what dropped rows leave.
#include "tests/support/standing.h"

namespace poinsot::test {
namespace {

// The three rows of a point act on a position by the identity: its zeros are not stored, but those of rows along any
// direction are numbers like all others.
TEST(Formulations, APointOnAPointStoresNoZeros) {
  Random random(1);
  Model point = random_bodies(random, 2), rows = random_bodies(random, 2);
  add_coincidence(point, 0, 1, random);
  for (int k = 0; k < 3; ++k) add_row(rows, RowType::CD, 0, 1, random);
  for (const FormulationEntry& entry : formulations()) {
    const auto entries = [&](const Model& model) {
      int sum = 0;
      for (const Block& b : make_problem(entry.name, model)->pattern(MatrixKind::kinematic).blocks) {
        sum += b.rows * b.cols;
      }
      return sum;
    };
    EXPECT_EQ(entries(rows) - entries(point), 2 * (9 - 3)) << entry.name;
  }
}

// Blocks lie within the matrix, and each body's and row's unknowns belong to one node.
TEST(Formulations, PatternsFitTheMatrix) {
  Random random(6);
  const Model model = random_model(random, 4);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    const auto problem = make_problem(entry.name, model);
    for (MatrixKind kind : {MatrixKind::kinematic, MatrixKind::rates, MatrixKind::consistent, MatrixKind::simplified,
                            MatrixKind::exact}) {
      const Pattern pattern = problem->pattern(kind);
      const bool rows_only = kind == MatrixKind::kinematic || kind == MatrixKind::rates;
      EXPECT_EQ(pattern.node.size(), static_cast<std::size_t>(pattern.n));
      EXPECT_EQ(pattern.n, rows_only ? std::max(problem->nv(), problem->nc()) : problem->nv() + problem->nc());
      for (const Block& block : pattern.blocks) {
        EXPECT_TRUE(block.row >= 0 && block.col >= 0 && block.rows > 0 && block.cols > 0);
        EXPECT_TRUE(block.row + block.rows <= pattern.n && block.col + block.cols <= pattern.n);
      }
    }
  }
}

// Rows left out move the others up; everything else is that of the model without them.
TEST(Formulations, DroppedRowsTakeNoPart) {
  Random random(7);
  const Model model = solvable_model(random);
  const std::vector<BodyState> states = random_states(random, 3);
  const std::vector<int> dropped{1, 4};
  Model without = model;
  without.rows.erase(without.rows.begin() + 4);
  without.rows.erase(without.rows.begin() + 1);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    Standing some(entry.name, model, states, 0.2), all(entry.name, without, states, 0.2);
    some.problem = entry.make(std::make_shared<const Model>(model), dropped);
    some.stand(0.2);
    EXPECT_EQ(some.problem->model_rows(), (std::vector<int>{0, 2, 3, 5, 6}));
    some.solve(), all.solve();
    EXPECT_EQ((some.a - all.a).norm(), 0);
    EXPECT_EQ((some.lambda - all.lambda).norm(), 0);
    Vector3 force, moment;
    some.problem->reaction(1, view(some.lambda), force, moment);
    EXPECT_EQ(force.norm() + moment.norm(), 0);
  }
}

}  // namespace
}  // namespace poinsot::test
