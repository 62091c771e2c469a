#include "integrators/step_system.h"

#include <fmt/format.h>

namespace poinsot {

StepSystem::StepSystem(Problem& problem, LinearSolver& solver, MatrixKind kind, Statistics& statistics,
                       PhaseClock& clock)
    : problem_(problem), solver_(solver), kind_(kind), statistics_(statistics), clock_(clock) {}

Status StepSystem::prepare() {
  const LinearStatus status = solver_.analyze(problem_.pattern(kind_));
  return status.ok() ? Status{} : explain(problem_, 0, status);
}

Status StepSystem::refresh(double t, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                           std::span<const double> lambda) {
  clock_.lap(Phase::other);
  problem_.assemble(kind_, scale, dq, a, lambda, solver_.slots(), solver_.values());
  ++statistics_.jacobian_evaluations;
  clock_.lap(Phase::assembly);
  const LinearStatus status = solver_.factor();
  ++statistics_.factorizations;
  clock_.lap(Phase::factor);
  return status.ok() ? Status{} : explain(problem_, t, status);
}

Status StepSystem::solve(double t, std::span<double> b) {
  clock_.lap(Phase::other);
  const LinearStatus status = solver_.solve(b);
  ++statistics_.solves;
  clock_.lap(Phase::solve);
  return status.ok() ? Status{} : explain(problem_, t, status);
}

Status explain(const Problem& problem, double t, const LinearStatus& status) {
  if (status.failure == LinearFailure::not_finite) {
    return {Failure::not_finite, t,
            fmt::format("at t = {:.9g} s the matrix or the solution is not finite; try a smaller step", t)};
  }
  std::string where;
  if (status.unknown >= 0) where = fmt::format(" near {}", problem.describe_unknown(status.unknown));
  if (status.failure == LinearFailure::refused) return {Failure::refused, t, status.message + where};
  return {Failure::singular_matrix, t,
          fmt::format("at t = {:.9g} s the linear system is singular{} ({}); a singular position of the mechanism, "
                      "dependent constraints or a body without inertia: `poinsot check` names them, a smaller step may "
                      "pass a singular position",
                      t, where, status.message)};
}

}  // namespace poinsot
