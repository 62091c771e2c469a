#include "integrators/start/rank.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/check.h"
#include "formulations/gradient.h"
#include "formulations/registry.h"
#include "integrators/settings.h"
#include "integrators/stepping/consistent.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Columns have unit length: what is left of a dependent one is rounding, far below this. A row that keeps less than
// this of its length is not told from a dependent one.
constexpr double kRankTolerance = 1e-9;

// What the terms have of which the row's gradient is made, where they can cancel altogether: the cross product of
// directions that are parallel, the distance of points that coincide. 0 for rows that cannot vanish.
double terms_of_gradient(const Row& row, std::span<const BodyState> states) {
  const auto place = [&](int body) { return body == kGround ? 0.0 : states[static_cast<std::size_t>(body)].r.norm(); };
  switch (row.type) {
    case RowType::DP1:
    case RowType::angle:
      return row.a_i.norm() * row.a_j.norm();
    case RowType::D: {
      const double s = std::max(row.s_i.norm(), row.s_j.norm());
      return 2 * (place(row.i) + place(row.j) + 2 * s) * std::max(1.0, s);
    }
    case RowType::DP2:
    case RowType::CD:
    case RowType::pfaffian:
      return 0;
  }
  return 0;
}

// Gᵀ at (t, q) with unit columns, in rA: its variations are regular everywhere. A column of nothing but rounding is 0.
Sparse transposed_gradient(Problem& problem, std::span<const double> q, std::span<const BodyState> states) {
  const std::vector<double> at_rest(static_cast<std::size_t>(problem.nv()), 0.0);
  problem.set_position(0, q);
  problem.set_velocity(at_rest);
  const std::vector<Eigen::Triplet<double>> entries = gradient(problem);
  Sparse G(problem.nc(), problem.nv());
  G.setFromTriplets(entries.begin(), entries.end());
  Sparse Gt = G.transpose();
  const std::vector<Row>& rows = problem.model().rows;
  for (Eigen::Index k = 0; k < Gt.cols(); ++k) {
    const double norm = Gt.col(k).norm();
    const double terms = terms_of_gradient(rows[static_cast<std::size_t>(k)], states);
    Gt.col(k) *= norm > kRankTolerance * terms ? 1 / norm : 0.0;
  }
  return Gt;
}

// A small free motion from q, projected back onto the constraints: those that are independent there, and the others
// have to follow. Bodies of unit mass and inertia, so that the moves are the shortest. False where there is none.
bool neighbour(Problem& problem, const std::vector<int>& dependent, std::span<const BodyState> states,
               std::vector<double>& q) {
  constexpr double kStep = 1e-2;
  auto model = std::make_shared<Model>(problem.model());
  for (Body& body : model->bodies) body.mass = 1, body.inertia.setIdentity();
  const auto make = [&](const std::vector<int>& without) { return intrinsic_formulation().make(model, without); };

  const std::unique_ptr<Problem> here = make(dependent);
  std::vector<double> at_rest(static_cast<std::size_t>(here->nv()), 0.0);
  here->set_position(0, q);
  here->set_velocity(at_rest);
  std::vector<double> move(static_cast<std::size_t>(here->nv() + here->nc()), 0.0);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < at_rest.size(); ++k) move[k] = normal(random);
  Consistent consistent(*here, LinearChoice());
  if (!consistent.factor(0).ok() || !consistent.solve(0, move).ok()) return false;
  move.resize(at_rest.size());
  double length = 0;
  for (const double x : move) length = std::hypot(length, x);
  if (!(length >= 1e-6)) return false;
  for (double& x : move) x *= kStep / length;
  std::vector<double> beside(q.size());
  here->retract(q, move, beside);
  const auto distance = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < q.size(); ++k) sum = std::hypot(sum, beside[k] - q[k]);
    return sum;
  };
  const double moved = distance();

  const std::unique_ptr<Problem> there =
      make(dependent_columns(transposed_gradient(problem, beside, states), kRankTolerance));
  if (!Consistent(*there, LinearChoice()).project_position(0, beside).ok()) return false;
  if (distance() < 0.5 * moved) return false;  // the constraints take it back where it was
  problem.set_position(0, beside);
  std::vector<double> Phi(static_cast<std::size_t>(problem.nc()));
  problem.position_residual(Phi);
  q = std::move(beside);
  return std::all_of(Phi.begin(), Phi.end(), [](double x) { return std::abs(x) < 1e-8; });
}

}  // namespace

std::vector<int> RankAnalysis::dependent_rows() const {
  std::vector<int> rows;
  for (const Dependency& d : dependent) rows.push_back(d.row);
  return rows;
}

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, {});
  std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
  check(problem->from_bodies(states, q, v).ok(), "rA represents every orientation");

  RankAnalysis analysis;
  analysis.variables = problem->nv();
  const auto name = [&](const Sparse& Gt) {
    ColumnDependencies found = column_dependencies(Gt, kRankTolerance);
    analysis.dependent.clear();
    for (ColumnDependency& d : found.columns) analysis.dependent.push_back({d.column, std::move(d.others)});
    analysis.named = found.named;
    analysis.rank = problem->nc() - static_cast<int>(analysis.dependent.size());
  };
  name(transposed_gradient(*problem, q, states));
  analysis.rank_here = analysis.rank;
  // Only mechanisms that can move have neighbours.
  if (analysis.dependent.empty() || analysis.degrees_of_freedom() == 0 ||
      !neighbour(*problem, analysis.dependent_rows(), states, q))
    return analysis;
  const Sparse beside = transposed_gradient(*problem, q, states);
  if (dependent_columns(beside, kRankTolerance).size() < analysis.dependent.size()) name(beside);
  return analysis;
}

}  // namespace poinsot
