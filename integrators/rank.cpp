#include "integrators/rank.h"

#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/check.h"
#include "formulations/gradient.h"
#include "formulations/registry.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Gᵀ at (t, q) with unit columns, in rA: its variations are regular everywhere.
Sparse transposed_gradient(Problem& problem, std::span<const double> q, Eigen::VectorXd& lengths) {
  const std::vector<double> at_rest(static_cast<std::size_t>(problem.nv()), 0.0);
  problem.set_position(0, q);
  problem.set_velocity(at_rest);
  const std::vector<Eigen::Triplet<double>> entries = gradient(problem);
  Sparse G(problem.nc(), problem.nv());
  G.setFromTriplets(entries.begin(), entries.end());
  Sparse Gt = G.transpose();
  lengths.setOnes(Gt.cols());
  for (Eigen::Index k = 0; k < Gt.cols(); ++k) {
    const double norm = Gt.col(k).norm();
    if (norm > 0) Gt.col(k) /= lengths[k] = norm;
  }
  Gt.makeCompressed();
  return Gt;
}

using Decomposition = Eigen::SparseQR<Sparse, Eigen::NaturalOrdering<int>>;

// Columns have unit length: what is left of a dependent one is rounding, far below this. A row that keeps less than
// this of its length is not told from a dependent one.
constexpr double kRankTolerance = 1e-9;

std::vector<Dependency> dependencies(const Decomposition& qr, Eigen::Index columns) {
  const Eigen::Index rank = qr.rank();
  const auto& order = qr.colsPermutation().indices();
  const Eigen::MatrixXd last = Eigen::MatrixXd(Sparse(qr.matrixR()).topRows(rank).rightCols(columns - rank));
  const Sparse R = Sparse(qr.matrixR()).topLeftCorner(rank, rank);
  std::vector<Dependency> found;
  for (Eigen::Index k = rank; k < columns; ++k) {
    Dependency dependency{order[k], {}};
    if (rank > 0) {
      const Eigen::VectorXd combination = R.triangularView<Eigen::Upper>().solve(last.col(k - rank));
      for (Eigen::Index l = 0; l < rank; ++l) {
        if (std::abs(combination[l]) > 1e-6) dependency.others.push_back(order[l]);
      }
    }
    std::sort(dependency.others.begin(), dependency.others.end());
    found.push_back(dependency);
  }
  std::sort(found.begin(), found.end(), [](const Dependency& x, const Dependency& y) { return x.row < y.row; });
  return found;
}

// A small free motion from q, projected back onto the constraints (least squares, so dependent rows do no harm).
bool neighbour(Problem& problem, const std::vector<double>& start, std::vector<double>& q) {
  constexpr double kStep = 1e-2;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd move(problem.nv());
  for (double& x : move) x = normal(random);
  const auto row_space_part = [](const Sparse& Gt, const Eigen::VectorXd& x) {
    return Eigen::MatrixXd(Gt.transpose()).completeOrthogonalDecomposition().solve(Gt.transpose() * x).eval();
  };
  Eigen::VectorXd lengths;
  Sparse Gt = transposed_gradient(problem, start, lengths);
  move -= row_space_part(Gt, move);
  if (move.norm() < 1e-6) return false;
  move *= kStep / move.norm();
  q = start;
  std::vector<double> next(q.size());
  Eigen::VectorXd Phi(problem.nc());
  const auto span = [](Eigen::VectorXd& x) { return std::span<double>(x.data(), static_cast<std::size_t>(x.size())); };
  for (int k = 0; k < 8; ++k) {
    problem.retract(q, span(move), next);
    q.swap(next);
    Gt = transposed_gradient(problem, q, lengths);
    problem.position_residual(span(Phi));
    Phi.array() /= lengths.array();
    move = Eigen::MatrixXd(Gt.transpose()).completeOrthogonalDecomposition().solve(-Phi);
  }
  return Phi.norm() < 1e-8;
}

}  // namespace

std::vector<int> RankAnalysis::dependent_rows() const {
  std::vector<int> rows;
  for (const Dependency& d : dependent) rows.push_back(d.row);
  return rows;
}

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  const std::unique_ptr<Problem> problem = find_formulation("rA")->make(model, {});
  std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
  check(problem->from_bodies(states, q, v).ok(), "rA represents every orientation");

  RankAnalysis analysis;
  analysis.variables = problem->nv();
  if (problem->nc() == 0) return analysis;
  const auto decompose = [&](const std::vector<double>& at, Decomposition& qr) {
    qr.setPivotThreshold(kRankTolerance);
    Eigen::VectorXd lengths;
    qr.compute(transposed_gradient(*problem, at, lengths));
    return static_cast<int>(qr.rank());
  };
  Decomposition here;
  analysis.rank = analysis.rank_here = decompose(q, here);
  if (analysis.rank == problem->nc()) return analysis;
  analysis.dependent = dependencies(here, problem->nc());

  // Only mechanisms that can move have neighbours; the dense projections bound the size for which they are looked at.
  constexpr int kLargest = 1500;
  std::vector<double> beside;
  if (problem->nv() <= kLargest && neighbour(*problem, q, beside)) {
    Decomposition there;
    const int rank = decompose(beside, there);
    if (rank > analysis.rank) {
      analysis.rank = rank;
      analysis.dependent = rank == problem->nc() ? std::vector<Dependency>() : dependencies(there, problem->nc());
    }
  }
  return analysis;
}

}  // namespace poinsot
