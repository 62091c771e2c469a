#include "integrators/stepping/singular_position.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "formulations/gradient.h"
#include "integrators/stepping/unit_rows.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// Whether drivers bar the position (t, q), where the problem stands and `row` all but depends on others. What they ask
// for is measured by what they asked for before: a driver that comes to rest with the mechanism bars nothing. Where
// drivers of other rows are much faster it is not seen.
bool bars(Problem& problem, const UnitRows& rows, Eigen::Index row, double t, std::span<const double> q) {
  constexpr double kNone = 0.01, kTimesShare = 10;  // a regular position has a part as small as the share
  constexpr int kTimes = 16;
  Eigen::VectorXd nu(problem.nc()), usual = Eigen::VectorXd::Zero(problem.nc());
  for (int k = 0; k <= kTimes; ++k) {
    problem.set_position(t * k / kTimes, q);  // the last one is t
    problem.nu(span(nu));
    usual = usual.cwiseMax(nu.cwiseAbs());
  }
  const Eigen::VectorXd mu = rows.dependence(row);
  return std::abs(mu.dot(nu.cwiseQuotient(rows.lengths()))) >
         (kNone + kTimesShare * rows.shares()[row]) * mu.norm() * usual.cwiseQuotient(rows.lengths()).norm();
}

// Of one body at least. The problem stands at the state.
std::string most_accelerated(const Problem& problem, const State& state) {
  std::vector<BodyState> bodies(index(problem.bodies()));
  problem.to_bodies(state.a(), bodies);
  const auto most = std::ranges::max_element(
      bodies, {}, [](const BodyState& body) { return body.rdd.squaredNorm() + body.wd.squaredNorm(); });
  return fmt::format("body '{}' is accelerated most, by {:.3g} m/s^2 and {:.3g} rad/s^2",
                     problem.model().bodies[index(static_cast<int>(most - bodies.begin()))].name, most->rdd.norm(),
                     most->wd.norm());
}

// Of a distance where the scene starts, m.
double start_length(const Model& model, const Row& row) {
  return (initial_point(model, row.j, row.s_j) - initial_point(model, row.i, row.s_i)).norm();
}

// What a distance is short beside, m: its arms in bodies, the length it starts with. Not its place on the ground, which
// is as far off as somebody put the origin.
double about_distance(const Model& model, const Row& row) {
  const double i = row.i == kGround ? 0 : row.s_i.norm(), j = row.j == kGround ? 0 : row.s_j.norm();
  return std::max({i, j, start_length(model, row)});
}

// Where the problem stands.
Eigen::VectorXd shares_of(Problem& problem, const UnitRows& here, int rows) {
  Eigen::VectorXd shares = here.shares().head(rows);
  // A DP1 row between parallel directions vanishes: of unit vectors, it is shorter than 1 by that alone.
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(problem.nc());
  for (const Eigen::Triplet<double>& entry : gradient(problem)) squares[entry.row()] += entry.value() * entry.value();
  for (int k = 0; k < rows; ++k) {
    const int of = problem.model_rows()[static_cast<std::size_t>(k)];
    if (problem.model().rows[static_cast<std::size_t>(of)].type == RowType::DP1)
      shares[k] *= std::min(1.0, std::sqrt(squares[k]));
  }
  return shares;
}

}  // namespace

Eigen::VectorXd independent_shares(Problem& problem, int rows, double t, std::span<const double> q) {
  if (rows < 1 || !UnitRows::has(problem)) return {};
  return shares_of(problem, UnitRows(problem, t, q), rows);
}

DependentRow most_dependent_row(Problem& problem, int rows, double t, std::span<const double> q) {
  if (rows < 1 || !UnitRows::has(problem)) return {};
  Eigen::Index row = 0;
  const UnitRows here(problem, t, q);
  const double share = shares_of(problem, here, rows).minCoeff(&row);
  return {static_cast<int>(row), share, bars(problem, here, row, t, q)};
}

NearSingular near_singular_position(Problem& problem, int rows, std::span<const double> q_start, double t,
                                    std::span<const double> q) {
  constexpr double kNear = 0.05, kThere = 1e-5;
  if (rows < 2 || !UnitRows::has(problem)) return {};
  const Eigen::VectorXd before = UnitRows(problem, 0, q_start).shares();
  const UnitRows here(problem, t, q);
  const Eigen::VectorXd now = here.shares();
  Eigen::Index row = 0;
  const double share = now.cwiseQuotient(before).head(rows).minCoeff(&row);
  if (!(share < kNear)) return {};
  const std::string where = fmt::format(
      "it stopped beside a singular position of the mechanism, where the gradient of {} is a combination of the other "
      "constraints' but for {:.1g} of its length (at the start for {:.1g})",
      problem.describe_unknown(problem.nv() + static_cast<int>(row)), now[row], before[row]);
  if (bars(problem, here, row, t, q)) return {where + "; " + (now[row] < kThere ? kBarred : kSeemsBarred), true, true};
  const bool driven = std::ranges::any_of(problem.model().rows, [](const Row& r) { return !r.f.is_constant(); });
  return {where + (driven ? std::string("; ") + kMayBeBarred : ""), false, driven};
}

Status never_beyond(const Problem& problem, const State& at, double limit) {
  return with_remedy(
      Failure::step_size_too_small, at.t,
      fmt::format(
          "at t = {:.9g} s steps get shorter and shorter, so that they never come beyond about t = {:.4g} s: {}, "
          "and the motion grows without bound",
          at.t, limit, most_accelerated(problem, at)),
      "end before it");
}

std::string growing_motion(const Problem& problem, const State& state) {
  if (problem.bodies() == 0) return {};
  return most_accelerated(problem, state) + ": " +
         (problem.model_rows().empty() ? ""
                                       : "the mechanism comes to a singular position, near which accelerations are "
                                         "lost to rounding, or ") +
         "the tolerances ask for more than the arithmetic has (where a body is at rest, atol alone does), or "
         "the motion jumps or grows without bound here";
}

std::string vanished_gradient(Problem& problem, const State& state) {
  constexpr double kVanished = 1e-3, kShorter = 0.5;
  const Model& model = problem.model();
  problem.set_position(state.t, span(state.q));
  problem.set_velocity(span(state.v));
  std::vector<BodyState> bodies(model.bodies.size());
  problem.to_bodies(state.a(), bodies);
  const auto point = [&](int body, const Vector3& s) -> Vector3 {
    return body == kGround ? s : bodies[index(body)].r + bodies[index(body)].A * s;
  };
  const auto direction = [&](int body, const Vector3& a) -> Vector3 {
    return (body == kGround ? a : Vector3(bodies[index(body)].A * a)).normalized();
  };
  for (const int k : problem.model_rows()) {
    const Row& row = model.rows[index(k)];
    if (row.type == RowType::DP1 && !row.f.is_constant() && !row.alternate) {
      const double sine = direction(row.i, row.a_i).cross(direction(row.j, row.a_j)).norm();
      if (!(sine < kVanished)) continue;
      return fmt::format(
          "the directions of {} have come to {:.2g} rad of one another's line: in it its gradient vanishes, and it "
          "does "
          "not say to which side they turn; an angle driver in its place does",
          describe_row(model, k), sine);
    }
    if (row.type != RowType::D) continue;
    const double length = (point(row.j, row.s_j) - point(row.i, row.s_i)).norm();
    if (!(length < kVanished * about_distance(model, row)) || !(length < kShorter * start_length(model, row))) continue;
    return fmt::format(
        "{} has come to a length of {:.2g} m: at 0 its gradient vanishes, and it does not say in which direction the "
        "points come together or part; three CD constraints in its place, one for each axis, do",
        describe_row(model, k), length);
  }
  return {};
}

}  // namespace poinsot
