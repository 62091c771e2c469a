// Dependent columns of sparse matrices against a dense decomposition that goes through them in their order.
#include "linsolve/column_dependencies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <random>

#include "tests/scale.h"

namespace poinsot {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kTolerance = 1e-9;

// Column by column: what is left of it beside the independent columns before, and the combination that makes it.
std::vector<ColumnDependency> in_order(const Sparse& A) {
  const Eigen::MatrixXd dense(A);
  std::vector<ColumnDependency> found;
  std::vector<int> independent;
  for (int k = 0; k < dense.cols(); ++k) {
    Eigen::VectorXd x(0), rest = dense.col(k);
    if (!independent.empty()) {
      const Eigen::MatrixXd before = dense(Eigen::all, independent);
      x = before.householderQr().solve(dense.col(k));
      rest -= before * x;
    }
    if (rest.norm() > kTolerance) {
      independent.push_back(k);
      continue;
    }
    found.push_back({k, {}});
    for (std::size_t l = 0; l < independent.size(); ++l)
      if (std::abs(x[static_cast<Eigen::Index>(l)]) > 1e-6) found.back().others.push_back(independent[l]);
  }
  return found;
}

void expect_same_as_dense(const Sparse& A) {
  const ColumnDependencies found = column_dependencies(A, kTolerance);
  const std::vector<ColumnDependency> expected = in_order(A);
  EXPECT_TRUE(found.named);
  ASSERT_EQ(found.columns.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(found.columns[k].column, expected[k].column);
    EXPECT_EQ(found.columns[k].others, expected[k].others) << "of column " << expected[k].column;
  }
  // Without the dependent columns of the other function the rest has the same rank.
  const std::vector<int> dependent = dependent_columns(A, kTolerance);
  EXPECT_EQ(dependent.size(), expected.size());
  EXPECT_TRUE(std::is_sorted(dependent.begin(), dependent.end()));
  std::vector<int> rest;
  for (int k = 0; k < A.cols(); ++k)
    if (!std::binary_search(dependent.begin(), dependent.end(), k)) rest.push_back(k);
  const Eigen::MatrixXd dense(A);
  EXPECT_THAT(in_order(Eigen::MatrixXd(dense(Eigen::all, rest)).sparseView()), IsEmpty());
}

// Each column reaches a few rows near one another, as joints reach two bodies; some are sums of others.
Sparse random_matrix(std::mt19937& random, int rows, int columns, int reach) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> row(0, rows - 1), entries(1, reach), percent(0, 99);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, columns);
  for (int k = 0; k < columns; ++k) {
    std::uniform_int_distribution<int> before(0, std::max(0, k - 1));
    if (k > 2 && percent(random) < 30) {
      A.col(k) = normal(random) * A.col(before(random)) + normal(random) * A.col(before(random));
    } else if (percent(random) < 95) {  // the others stay zero
      const int first = row(random);
      for (int l = entries(random); l > 0; --l) A((first + l) % rows, k) = normal(random);
    }
    if (A.col(k).norm() > 1e-3)
      A.col(k).normalize();
    else
      A.col(k).setZero();
  }
  return A.sparseView();
}

TEST(ColumnDependencies, OfRandomMatrices) {
  for (int seed = 0; seed < scaled(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    const Sparse A = random_matrix(random, 5 + seed % 30, 4 + seed % 41, 1 + seed % 7);
    expect_same_as_dense(A);
  }
}

// A row that all columns reach: more of them than a front is made for.
TEST(ColumnDependencies, WithRowsThatReachEverything) {
  for (int seed = 0; seed < scaled(2); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    Eigen::MatrixXd A(random_matrix(random, 330, 310, 3));
    for (int row : {7, 100, 101}) {
      A.row(row) = Eigen::RowVectorXd::NullaryExpr(310, [&] { return normal(random); });
    }
    for (int k = 50; k < 310; k += 50) A.col(k) = A.col(k - 3) - 2 * A.col(k - 41);
    A.colwise().normalize();
    expect_same_as_dense(A.sparseView());
  }
}

TEST(ColumnDependencies, OfNothing) {
  EXPECT_THAT(column_dependencies(Sparse(6, 0), kTolerance).columns, IsEmpty());
  const std::vector<ColumnDependency> zero = column_dependencies(Sparse(6, 2), kTolerance).columns;
  ASSERT_EQ(zero.size(), 2u);
  EXPECT_THAT(zero[1].others, IsEmpty());
}

// What is left of a column is above the tolerance or below it.
TEST(ColumnDependencies, TheToleranceDecides) {
  for (const auto& [left, dependent] : {std::pair(1e-8, 0u), std::pair(1e-10, 1u)}) {
    Eigen::MatrixXd A(3, 2);
    A << 1, std::sqrt(1 - left * left), 0, left, 0, 0;
    const std::vector<ColumnDependency> found = column_dependencies(A.sparseView(), kTolerance).columns;
    EXPECT_EQ(found.size(), dependent) << left;
    for (const ColumnDependency& d : found) EXPECT_THAT(d.others, ElementsAre(0));
  }
}

}  // namespace
}  // namespace poinsot
