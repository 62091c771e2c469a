#include "integrators/stepping/consistent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/stepping/step_system.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

constexpr int kProjections = 30;
constexpr double kSmall = 1e-14;  // a correction of this relative size is rounding

double largest(std::span<const double> x) {
  double m = 0;
  for (double e : x) m = std::isfinite(e) ? std::max(m, std::abs(e)) : INFINITY;
  return m;
}

}  // namespace

Consistent::Consistent(const Problem& problem, std::string_view linear_solver)
    : solver_(linear_solvers().require(linear_solver).make()),
      rhs_(static_cast<std::size_t>(problem.nv() + problem.nc())),
      zeros_(rhs_.size(), 0.0) {
  analyzed_ = solver_->analyze(problem.pattern(MatrixKind::consistent));
}

Status Consistent::factor(Problem& problem, double t) {
  if (!analyzed_.ok()) return explain(problem, t, analyzed_);
  problem.assemble(MatrixKind::consistent, {}, {}, zeros_, zeros_, solver_->slots(), solver_->values());
  const LinearStatus status = solver_->factor();
  return status.ok() ? Status{} : explain(problem, t, status);
}

Status Consistent::accelerations(Problem& problem, double t, std::span<double> a, std::span<double> lambda) {
  if (Status status = factor(problem, t); !status.ok()) return status;
  const std::size_t nv = a.size(), nc = lambda.size();
  const std::span<double> rhs(rhs_);
  problem.equations_of_motion(std::span(zeros_).first(nv), std::span(zeros_).first(nc), rhs.first(nv));
  for (std::size_t k = 0; k < nv; ++k) rhs_[k] = -rhs_[k];
  problem.gamma(rhs.subspan(nv));
  if (LinearStatus status = solver_->solve(rhs); !status.ok()) return explain(problem, t, status);
  std::copy_n(rhs_.begin(), nv, a.begin());
  std::copy_n(rhs_.begin() + static_cast<std::ptrdiff_t>(nv), nc, lambda.begin());
  return {};
}

Status Consistent::solve(Problem& problem, double t, std::span<double> b) {
  if (Status status = factor(problem, t); !status.ok()) return status;
  const LinearStatus status = solver_->solve(b);
  return status.ok() ? Status{} : explain(problem, t, status);
}

Status Consistent::project_position(Problem& problem, double t, std::vector<double>& q) {
  const std::size_t nv = static_cast<std::size_t>(problem.nv());
  const std::span<double> rhs(rhs_);
  std::vector<double> next(q.size()), at_rest(nv, 0.0);
  double before = INFINITY;
  for (int k = 0; k < kProjections; ++k) {
    problem.set_position(t, q);
    problem.set_velocity(at_rest);
    if (Status status = factor(problem, t); !status.ok()) return status;
    std::fill_n(rhs_.begin(), nv, 0.0);
    problem.position_residual(rhs.subspan(nv));
    for (double& x : rhs.subspan(nv)) x = -x;
    if (LinearStatus status = solver_->solve(rhs); !status.ok()) return explain(problem, t, status);
    const double correction = largest(rhs.first(nv));
    if (!std::isfinite(correction)) break;
    problem.retract(q, rhs.first(nv), next);
    q.swap(next);
    problem.set_position(t, q);
    // quadratic convergence: done where the correction is rounding, or has stopped to shrink at a small size
    const double scale = std::max(1.0, largest(q));
    if (correction <= kSmall * scale || (correction < 1e-9 * scale && correction >= 0.5 * before)) return {};
    before = correction;
  }
  return {Failure::inconsistent_state, t,
          fmt::format("at t = {:.9g} s no position near the given one satisfies the constraints", t)};
}

Status Consistent::project_velocity(Problem& problem, double t, std::vector<double>& v) {
  const std::size_t nv = v.size();
  const std::span<double> rhs(rhs_);
  if (Status status = factor(problem, t); !status.ok()) return status;
  for (int k = 0; k < 2; ++k) {  // the second pass takes out the rounding of large corrections
    std::fill_n(rhs_.begin(), nv, 0.0);
    problem.velocity_residual(rhs.subspan(nv));
    for (double& x : rhs.subspan(nv)) x = -x;
    if (LinearStatus status = solver_->solve(rhs); !status.ok()) return explain(problem, t, status);
    for (std::size_t i = 0; i < nv; ++i) v[i] += rhs_[i];
    problem.set_velocity(v);
  }
  return {};
}

}  // namespace poinsot
