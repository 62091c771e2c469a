// The initial state in a formulation's own coordinates: where a run starts.
#pragma once

#include "integrators/integrator.h"
#include "integrators/settings.h"
#include "integrators/start/initial_state.h"
#include "integrators/state.h"

namespace poinsot {

// Writes the state of the bodies into `state`, in dynamics with accelerations and multipliers; what is discrete about
// the problem is brought up to date. `initial` is good.
Status find_first_state(const InitialState& initial, const Settings& settings, Problem& problem, State& state,
                        const Tell& tell);

}  // namespace poinsot
