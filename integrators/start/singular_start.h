// Accelerations and multipliers of a start in a singular position that the velocities lead through.
//
// There G has lost rank: rows that are independent on either side leave accelerations open. On the branch of the motion
// these are smooth: they are the limit of those beside (stepping/passage.h). The multipliers, which may grow without
// bound towards the position, are those of the rows independent in it that fit M a + Gᵀλ = Q.
#pragma once

#include "integrators/settings.h"
#include "integrators/start/rank.h"
#include "integrators/state.h"

namespace poinsot {

// The problem stands at (q, v) of `state`, whose z is written.
Status limit_accelerations(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state);

}  // namespace poinsot
