// Why a run stopped, where what its method came upon does not say so: what its functions ask for at that time, and what
// is singular or rests in the position there.
#pragma once

#include <Eigen/Core>

#include "core/status.h"
#include "formulations/problem.h"
#include "integrators/settings.h"
#include "integrators/start/doubtful_rows.h"
#include "integrators/state.h"

namespace poinsot {

// By a function without a finite value, a number that overflows, or a row that no position satisfies from there on:
// these are the cause whatever it looked like to the method. Whether one was found; the status is another then.
bool explain_by_functions(Status& status, const Problem& problem, const Settings& settings);

// Adds what is to be said of the position `state` where dynamics stopped, and takes back a remedy that does not help
// there; nothing of an output time before. `rows`: constraint rows of G that are the scene's; `doubt`: of which of them
// it was where the run began. The problem stands there afterwards.
void explain_by_position(Status& status, Problem& problem, const Settings& settings, int rows, const Doubt& doubt,
                         const Eigen::VectorXd& q_start, const State& state);

}  // namespace poinsot
