#include "integrators/start/first_state.h"

#include <algorithm>

#include "formulations/registry.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

Status find_first_state(const InitialState& initial, const Settings& settings, Problem& problem, State& state) {
  if (Status status = problem.from_bodies(initial.bodies, span(state.q), span(state.v)); !status.ok()) return status;
  if (settings.analysis == Analysis::kinematics) return {};  // which finds everything but q itself
  const bool discrete = problem.has_discrete_state();
  if (problem.formulation() == intrinsic_formulation().name && !initial.z.empty() && !discrete) {
    std::ranges::copy(initial.z, state.z.begin());
    return {};
  }
  Consistent consistent(problem, settings.linear());
  consistent.stand(state);
  if (discrete && problem.accept(state.t, span(state.q), span(state.v), state.a())) consistent.stand(state);
  return consistent.accelerations(state.t, span(state.z));
}

}  // namespace poinsot
