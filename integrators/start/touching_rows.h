// Constraints that meet without crossing, or that cross where the motion does not go, and that it keeps by itself.
//
// A platform on four parallel rods of one length swings without turning. A fourth rod's gradient follows from those of
// three wherever it swings, so that no pose is a regular one; to turn is forbidden to the second order or a higher one
// alone, which no multiplier can enforce. Where the loads and velocities do not turn it, the motion is that of three
// rods, and the fourth is set aside and watched (aside_watch.h) as rows are that are redundant.
#pragma once

#include <memory>
#include <span>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/settings.h"
#include "integrators/start/rank.h"

namespace poinsot {

// Of a singular position: whether the motion that begins there without the singular rows keeps them for a tenth of the
// bodies' sizes, and they are singular where that leads. What rests keeps them where all positions beside are singular.
bool keeps_touching_rows(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                         const RankAnalysis& rank, const Settings& settings);

// The singular rows are touching ones from now on, and aside.
void set_aside_touching(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                        RankAnalysis& rank);

}  // namespace poinsot
