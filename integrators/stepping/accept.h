// What every integrator does with an accepted step: the problem brings up to date what is discrete about it.
#pragma once

#include "integrators/state.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

// The problem stands at `at`, before and after.
inline Status accept(Problem& problem, State& at, bool& rewritten) {
  rewritten = false;
  if (!problem.has_discrete_state() && !problem.exchanges_rows()) return {};
  Status status = problem.accept(at.t, span(at.q), span(at.v), at.a(), at.lambda(), rewritten);
  if (rewritten) {
    problem.set_position(at.t, span(at.q));
    problem.set_velocity(span(at.v));
  }
  return status;
}

}  // namespace poinsot
