#include "integrators/start/first_state.h"

#include "integrators/start/singular_start.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

Status find_first_state(const InitialState& initial, const Settings& settings, Problem& problem, State& state) {
  if (Status status = problem.from_bodies(initial.bodies, span(state.q), span(state.v)); !status.ok()) return status;
  if (settings.analysis == Analysis::kinematics) return {};  // which finds everything but q itself
  Consistent consistent(problem, settings.linear());
  consistent.stand(state);
  bool rewritten = false;
  if (Status status = accept(problem, state, rewritten); !status.ok()) return status;
  if (initial.rank.singular_position()) return limit_accelerations(problem, initial.rank, settings, state);
  return consistent.accelerations(state.t, span(state.z));
}

}  // namespace poinsot
