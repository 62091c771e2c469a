// Which of the dependent constraint rows contradict the rows they depend on, instead of following from them.
//
// With the independent rows satisfied (positions and velocities projected onto them), a dependent row either holds,
// too, or cannot hold together with them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "integrators/start/rank.h"

namespace poinsot::study {

struct Conflict {
  int row;        // of the model
  double by;      // |Φ| or |G v − ν| where the independent rows hold
  bool position;  // of the positions, or of the velocities
};

std::vector<Conflict> find_conflicts(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                                     const RankAnalysis& analysis);

}  // namespace poinsot::study
