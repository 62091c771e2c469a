#include "integrators/stepping/unit_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/body_sizes.h"
#include "core/index.h"
#include "formulations/gradient.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kMostPairs = 4e6;  // of rows on one body, all bodies together: entries of G Gᵀ, at least

// The diagonal of (L D Lᵀ)⁻¹. L without its diagonal of ones, its rows ascending in every column.
Eigen::VectorXd inverse_diagonal(const Sparse& L, const Eigen::VectorXd& D) {
  const int* begin = L.outerIndexPtr();
  const int* rows = L.innerIndexPtr();
  const double* l = L.valuePtr();
  std::vector<double> Z(index(static_cast<int>(L.nonZeros())));
  Eigen::VectorXd diagonal(D.size());
  const auto z = [&](int i, int k) {  // L has an entry there where it has some for both in a column before
    if (i == k) return diagonal[i];
    const int row = std::max(i, k), column = std::min(i, k);
    return Z[index(static_cast<int>(std::lower_bound(rows + begin[column], rows + begin[column + 1], row) - rows))];
  };
  for (int j = static_cast<int>(D.size()) - 1; j >= 0; --j) {
    double sum = 0;
    for (int i = begin[j]; i < begin[j + 1]; ++i) {
      double of_row = 0;
      for (int k = begin[j]; k < begin[j + 1]; ++k) of_row -= z(rows[i], rows[k]) * l[k];
      Z[index(i)] = of_row;
      sum += l[i] * of_row;
    }
    diagonal[j] = 1 / D[j] - sum;
  }
  return diagonal;
}

}  // namespace

bool UnitRows::has(const Problem& problem) {
  std::vector<double> on(problem.model().bodies.size(), problem.nc() > static_cast<int>(problem.model_rows().size()));
  for (const int k : problem.model_rows()) {
    const Row& row = problem.model().rows[index(k)];
    for (const int body : {row.i, row.j})
      if (body != kGround) ++on[index(body)];
  }
  double pairs = 0;
  for (const double rows : on) pairs += rows * rows;
  return pairs <= kMostPairs;
}

UnitRows::UnitRows(Problem& problem, double t, std::span<const double> q) {
  problem.set_position(t, q);
  problem.set_velocity(std::vector<double>(index(problem.nv()), 0.0));
  const std::vector<Eigen::Triplet<double>> entries = gradient(problem);
  Sparse G(problem.nc(), problem.nv());
  G.setFromTriplets(entries.begin(), entries.end());
  const std::vector<double> sizes = body_sizes(problem.model());
  const Eigen::Index per_body = problem.bodies() > 0 ? problem.nv() / problem.bodies() : 0;
  for (Eigen::Index j = 0; j < G.outerSize(); ++j)
    if (j % per_body >= 3) G.col(j) /= sizes[index(static_cast<int>(j / per_body))];
  lengths_ = Eigen::VectorXd::Zero(G.rows());
  for (Eigen::Index j = 0; j < G.outerSize(); ++j)
    for (Sparse::InnerIterator it(G, j); it; ++it) lengths_[it.row()] += it.value() * it.value();
  lengths_ = lengths_.cwiseSqrt();
  G = lengths_.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; }).asDiagonal() * G;
  square_.setShift(8 * std::numeric_limits<double>::epsilon());  // regular where a row depends altogether
  square_.compute(G * G.transpose());
  const Eigen::VectorXd inverse =
      square_.permutationPinv() * inverse_diagonal(square_.matrixL().nestedExpression(), square_.vectorD());
  shares_ = inverse.cwiseAbs().cwiseSqrt().cwiseInverse();  // rounding may make such a row's negative
}

Eigen::VectorXd UnitRows::dependence(Eigen::Index row) const {
  return square_.solve(Eigen::VectorXd::Unit(lengths_.size(), row));
}

}  // namespace poinsot
