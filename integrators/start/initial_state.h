// From the state a scene gives to one a run can start from: redundant rows set aside, positions and velocities on the
// constraints, and told what was done.
//
// A state that satisfies the constraints is left untouched to the last bit. Others are closed first
// (integrators/start/rough_pose.h), since off the constraints rows that follow from others look independent, and then
// projected mass-orthogonally, which moves them least; velocities always, because scenes with drivers may leave them
// out. Positions that are far off are closed where the settings say so or where a joint or an angle driver is given in
// the bodies' frames: then the scene says what the mechanism is apart from the pose. Others are refused.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "core/status.h"
#include "integrators/settings.h"
#include "integrators/start/rank.h"
#include "integrators/start/violation.h"

namespace poinsot {

struct InitialState {
  Status status;
  std::vector<BodyState> bodies;
  RankAnalysis rank;
  std::vector<std::string> notices;
};

// Throws InputError where the scene asks for what cannot be: conflicting constraints, a pose far from the constraints,
// a violated state with Assembly::never, lengths whose squares overflow, for dynamics a spin that nothing determines.
// `rank`: that of the given state, where it is known already.
InitialState find_initial_state(const std::shared_ptr<const Model>& model, const Settings& settings,
                                const RankAnalysis* rank = nullptr);

}  // namespace poinsot
