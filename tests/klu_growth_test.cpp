// Growth in klu's factors with kept pivots is seen, though it is not looked at each time.
#include <gtest/gtest.h>

#include <array>

#include "linsolve/back_ends.h"

namespace poinsot {
namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;  // by column

// klu eliminates a full matrix as it stands. The pivots of the second one, 0.02, 0.1, 0.5, 0.5, are within a hundred
// times those of the first, and no entry is above 1, but U has 150.5.
constexpr Matrix4 kUnit{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
constexpr Matrix4 kGrown{{{0.02, 1, 1, 1}, {0, 0.1, 0.4, 0}, {0, 0, 0.5, -0.165}, {1, 0, 0.5, 0.835}}};

void factor(LinearSolver& solver, const Matrix4& columns) {
  for (std::size_t j = 0; j < 4; ++j) std::ranges::copy(columns[j], solver.values().begin() + solver.slots()[j]);
  EXPECT_TRUE(solver.factor().ok());
}

// Refactorizations of kGrown after `calm` of the unit matrix until pivots are chosen afresh; 0 where they never are.
int seen_after(int calm) {
  constexpr int kMost = 8;
  const std::unique_ptr<LinearSolver> solver = make_klu();
  EXPECT_TRUE(solver->analyze({4, {{0, 0, 4, 4}}, {0, 1, 2, 3}}).ok());
  for (int k = 0; k <= calm; ++k) factor(*solver, kUnit);
  const std::int64_t before = solver->statistics().factorizations;
  for (int k = 1; k <= kMost; ++k) {
    factor(*solver, kGrown);
    if (solver->statistics().factorizations > before) return k;
  }
  return 0;
}

TEST(KluGrowth, IsSeenAtOnceAfterFreshPivotsAndWithinEightLater) {
  EXPECT_EQ(seen_after(0), 1);
  for (const int calm : {1, 2, 5, 8, 9, 20}) EXPECT_GT(seen_after(calm), 0) << calm;
}

}  // namespace
}  // namespace poinsot
