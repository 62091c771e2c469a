#include "integrators/stepping/step_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/index.h"

namespace poinsot {
namespace {

// The body whose velocity or position has no finite size or, of finite ones, the largest: whose motion grows.
std::string of_fastest(const Problem& problem) {
  if (problem.bodies() == 0) return {};
  std::vector<BodyState> states(index(problem.bodies()));
  problem.to_bodies(std::vector<double>(index(problem.nv()), 0.0), states);
  const auto size = [](const BodyState& state) {
    const double speed = state.rd.norm() + state.w.norm(), sum = speed + state.r.norm();
    return std::isfinite(sum) ? speed : HUGE_VAL;
  };
  const auto body = std::ranges::max_element(states, {}, size);
  return fmt::format(" (body '{}' moves at {:.3g} m/s and {:.3g} rad/s)",
                     problem.model().bodies[index(static_cast<int>(body - states.begin()))].name, body->rd.norm(),
                     body->w.norm());
}

}  // namespace

TimedSystem::TimedSystem(const Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock)
    : problem_(problem), linear_(linear), statistics_(statistics), clock_(clock) {}

Status TimedSystem::prepare(Pattern pattern, std::vector<int> unknowns) {
  unknowns_ = std::move(unknowns);
  return explained(0, linear_.analyze(std::move(pattern)));
}

Status TimedSystem::factor(double t, Ahead ahead) {
  ++statistics_.jacobian_evaluations;
  clock_.lap(Phase::assembly);
  LinearStatus status = linear_.factor(ahead);
  ++statistics_.factorizations;
  clock_.lap(Phase::factor);
  if (status.ok()) [[likely]]
    return {};
  return explained(t, std::move(status));
}

Status TimedSystem::solve(double t, std::span<double> b) {
  clock_.lap(Phase::other);
  LinearStatus status = linear_.solve(b);
  ++statistics_.solves;
  clock_.lap(Phase::solve);
  if (status.ok()) [[likely]]
    return {};
  return explained(t, std::move(status));
}

Status TimedSystem::explained(double t, LinearStatus status) const {
  if (status.ok()) return {};
  if (status.unknown >= 0 && !unknowns_.empty()) status.unknown = unknowns_[static_cast<std::size_t>(status.unknown)];
  return explain(problem_, t, status);
}

Status explain(const Problem& problem, double t, const LinearStatus& status) {
  if (status.failure == LinearFailure::not_finite) {
    return with_settings(
        {Failure::not_finite, t,
         fmt::format("at t = {:.9g} s the matrix or the solution is not finite{}", t, of_fastest(problem))},
        "try a smaller step, or an integrator with error control");
  }
  std::string where;
  if (status.unknown >= 0) where = fmt::format(" near {}", problem.describe_unknown(status.unknown));
  if (status.failure == LinearFailure::refused || status.failure == LinearFailure::out_of_memory) {
    return with_settings(
        {Failure::refused, t, fmt::format("at t = {:.9g} s the linear solver refuses{}: {}", t, where, status.message)},
        "try another one, as auto");
  }
  return with_settings(
      {Failure::singular_matrix, t,
       fmt::format("at t = {:.9g} s the linear system is singular{} ({}); a singular position of the mechanism, "
                   "dependent constraints or a body without inertia: `poinsot check` names them",
                   t, where, status.message)},
      "a smaller step may pass a singular position");
}

}  // namespace poinsot
