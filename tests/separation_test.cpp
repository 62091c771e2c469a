// Columns to be left out: independent of one another, of few groups, and exchanged within their group.
#include "linsolve/separation.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <random>

namespace poinsot {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

std::vector<SparseEntries> vectors_of(const Eigen::MatrixXd& Z) {
  std::vector<SparseEntries> vectors(static_cast<std::size_t>(Z.cols()));
  for (Eigen::Index k = 0; k < Z.cols(); ++k)
    for (Eigen::Index i = 0; i < Z.rows(); ++i)
      if (Z(i, k) != 0) vectors[static_cast<std::size_t>(k)].emplace_back(static_cast<int>(i), Z(i, k));
  return vectors;
}

// The largest entry once the vectors are 1 at their pivots and 0 at those of the others.
double largest_entry(const Eigen::MatrixXd& Z, const std::vector<int>& pivots) {
  const Eigen::MatrixXd at = Z(pivots, Eigen::all);
  return (Z * at.inverse()).cwiseAbs().maxCoeff();
}

TEST(Separation, KeepsEntriesSmall) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 50; ++k) {
    const Eigen::MatrixXd Z = Eigen::MatrixXd::NullaryExpr(30, 6, [&] { return normal(random); });
    Grouped columns{std::vector<int>(30), std::vector<int>(30)};
    for (std::size_t i = 0; i < 30; ++i) columns.group[i] = static_cast<int>(i) / 5;
    EXPECT_LE(largest_entry(Z, separate(vectors_of(Z))), kFlat + 1e-9);
    EXPECT_LE(largest_entry(Z, gather(vectors_of(Z), columns)), kGathered + 1e-9);
  }
}

// Three groups of three columns could each have both pivots.
TEST(Separation, GathersInOneGroup) {
  Eigen::MatrixXd Z(9, 2);
  Z << 0.9, 0.3, 0.2, 0.7, 0.5, 0.1, /**/ 1, 0, 0.2, 1, 0.3, 0.1, /**/ 0.4, 0.8, 0.9, 0.2, 0.1, 0.3;
  Grouped columns{{0, 0, 0, 1, 1, 1, 2, 2, 2}, {2, 2, 2, 1, 1, 1, 3, 3, 3}};
  EXPECT_THAT(gather(vectors_of(Z), columns), UnorderedElementsAre(3, 4));
  columns.turn = {2, 2, 2, 3, 3, 3, 1, 1, 1};
  EXPECT_THAT(gather(vectors_of(Z), columns), UnorderedElementsAre(6, 7));
}

TEST(Separation, RepairsWithinTheGroup) {
  const Grouped columns{{0, 0, 1, 1}, std::vector<int>(4)};
  const auto repaired = [&](std::vector<double> entries, double most, double of_all = kGathered) {
    SparseEntries vector;
    for (int k = 0; k < 4; ++k) vector.emplace_back(k, entries[static_cast<std::size_t>(k)]);
    std::vector<int> pivots{1};
    repair({vector}, pivots, columns, most, of_all);
    return pivots.front();
  };
  EXPECT_EQ(repaired({1.6, 1, 3, 0.5}, 3), 1);    // nothing has grown to more than it may
  EXPECT_EQ(repaired({1.6, 1, 3, 0.5}, 1.5), 0);  // of the own group
  EXPECT_EQ(repaired({1.6, 1, 9, 0.5}, 3), 0);
  EXPECT_EQ(repaired({1.2, 1, 9, 0.5}, 3), 2);  // 9/1.2 would be too large again
  EXPECT_EQ(repaired({1.2, 1, 5, 0.5}, 3), 1);  // in another group
  EXPECT_EQ(repaired({1.2, 1, 5, 0.5}, 3, 4), 2);
}

}  // namespace
}  // namespace poinsot
