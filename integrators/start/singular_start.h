// Accelerations and multipliers of a start in a singular position that the velocities lead through.
//
// There G has lost rank: rows that are independent on either side leave accelerations open. On the branch of the motion
// these are smooth; they are found as the limit of accelerations beside,
//
//   a(0) = (4 ā(τ) − ā(2τ))/3 + O(τ⁴),   ā(s) = ½ (a(s) + a(−s)),   at q ⊞ (±s v) put back onto Φ = 0,
//
// and the multipliers, which may grow without bound towards the position, as those of the rows independent in it that
// fit M a + Gᵀλ = Q.
#pragma once

#include "integrators/settings.h"
#include "integrators/start/rank.h"
#include "integrators/state.h"

namespace poinsot {

// The problem stands at (q, v) of `state`, whose z is written.
Status limit_accelerations(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state);

}  // namespace poinsot
