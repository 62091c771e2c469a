#include "integrators/stepping/consistent_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr int kCorrections = 6;
constexpr double kRounding = 1e-15;    // product of two corrections that leaves nothing to correct
constexpr double kNegligible = 1e-14;  // a correction of this size is the rounding of the coordinates

double largest(std::span<const double> x) {
  double m = 0;
  for (double e : x) m = std::isfinite(e) ? std::max(m, std::abs(e)) : HUGE_VAL;
  return m;
}

}  // namespace

ConsistentPoints::ConsistentPoints(Problem& problem, LinearSolver& solver, Statistics& statistics, PhaseClock& clock)
    : problem_(problem),
      system_(problem, solver, MatrixKind::consistent, statistics, clock),
      nv_(static_cast<std::size_t>(problem.nv())),
      nc_(static_cast<std::size_t>(problem.nc())),
      rhs_(problem.nv() + problem.nc()),
      zeros_(Eigen::VectorXd::Zero(problem.nv() + problem.nc())),
      rows_(problem.nc()),
      q_moved_(problem.nq()) {}

Point ConsistentPoints::make() const {
  return {0, Eigen::VectorXd::Zero(problem_.nq()), Eigen::VectorXd::Zero(problem_.nv()),
          Eigen::VectorXd::Zero(problem_.nv() + problem_.nc())};
}

Point ConsistentPoints::make(double t, const State& state) const {
  Point at = make();
  at.t = t;
  std::ranges::copy(state.q, at.q.begin());
  std::ranges::copy(state.v, at.v.begin());
  std::ranges::copy(state.a, at.z.begin());
  std::ranges::copy(state.lambda, at.z.begin() + problem_.nv());
  return at;
}

void ConsistentPoints::give(const Point& at, State& state) const {
  std::ranges::copy(at.q, state.q.begin());
  std::ranges::copy(at.v, state.v.begin());
  std::ranges::copy(a(at), state.a.begin());
  std::ranges::copy(lambda(at), state.lambda.begin());
}

void ConsistentPoints::stand(const Point& at) {
  problem_.set_position(at.t, span(at.q));
  problem_.set_velocity(span(at.v));
}

Status ConsistentPoints::accelerations(Point& at) {
  stand(at);
  const std::span<const double> zeros = span(zeros_);
  if (Status status = system_.refresh(at.t, {}, {}, zeros.first(nv_), zeros.subspan(nv_)); !status.ok()) return status;
  problem_.equations_of_motion(zeros.first(nv_), zeros.subspan(nv_), span(at.z).first(nv_));
  at.z.head(problem_.nv()) = -at.z.head(problem_.nv());
  problem_.gamma(span(at.z).subspan(nv_));
  return system_.solve(at.t, span(at.z));
}

Status ConsistentPoints::project(Point& at, bool& moved) {
  moved = false;
  double first = 0, before = HUGE_VAL;
  for (int k = 0;; ++k) {
    rhs_.head(problem_.nv()).setZero();
    problem_.position_residual(rows());
    for (double& x : rows()) x = -x;
    if (Status status = system_.solve(at.t, span(rhs_)); !status.ok()) return status;
    const double correction = largest(rates());
    if (k == 0 && correction <= kNegligible) break;
    if (k == kCorrections || !(correction < before)) {
      return {Failure::inconsistent_state, at.t,
              fmt::format(
                  "at t = {:.9g} s the step leads too far from the constraints to be projected onto them; try smaller "
                  "tolerances",
                  at.t)};
    }
    problem_.retract(span(at.q), rates(), span(q_moved_));
    at.q.swap(q_moved_);
    stand(at);
    moved = true;
    first = std::max(first, correction);
    if (first * correction <= kRounding) break;
    before = correction;
  }
  for (int k = 0; k < kCorrections; ++k) {
    rhs_.head(problem_.nv()).setZero();
    problem_.velocity_residual(rows());
    for (double& x : rows()) x = -x;
    if (Status status = system_.solve(at.t, span(rhs_)); !status.ok()) return status;
    const double correction = largest(rates());
    if (correction <= kNegligible * std::max(1.0, largest(span(at.v)))) break;
    at.v += rhs_.head(problem_.nv());
    problem_.set_velocity(span(at.v));
    moved = true;
    if (first * correction <= kRounding) break;
  }
  return {};
}

void ConsistentPoints::residual(const Point& at, std::span<double> out) {
  problem_.equations_of_motion(a(at), lambda(at), out.first(nv_));
  const std::span<double> rows = out.subspan(nv_);
  problem_.set_velocity(a(at));
  problem_.velocity_residual(rows);  // G a − ν
  problem_.set_velocity(span(at.v));
  problem_.nu(span(rows_));
  for (std::size_t k = 0; k < nc_; ++k) rows[k] += span(rows_)[k];
  problem_.gamma(span(rows_));
  for (std::size_t k = 0; k < nc_; ++k) rows[k] -= span(rows_)[k];
}

Status ConsistentPoints::refine(Point& at) {
  residual(at, span(rhs_));
  if (Status status = system_.solve(at.t, span(rhs_)); !status.ok()) return status;
  at.z -= rhs_;
  return {};
}

Status ConsistentPoints::complete(Point& at) {
  if (Status status = accelerations(at); !status.ok()) return status;
  bool moved = false;
  if (Status status = project(at, moved); !status.ok()) return status;
  return moved ? refine(at) : Status{};
}

}  // namespace poinsot
