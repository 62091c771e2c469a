// Whether a mechanism that stands in a singular position has regular ones beside it, where a run could start.
//
// Constraints can meet without crossing: a bar exactly as long as the planes are apart in which its ends move, the two
// diagonals of a flat square, an angle's cosine of 1. All positions that satisfy them are singular then, and what the
// constraints forbid shows in no gradient. Bodies are moved a little at random and closed again, a few times over.
#pragma once

#include <memory>
#include <span>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

// False where all positions found are singular. Where nothing is to be known of it, because drivers move the mechanism
// on or it is too large to be closed, that there are regular ones is assumed.
bool has_regular_positions_beside(const std::shared_ptr<const Model>& model, std::span<const BodyState> states);

}  // namespace poinsot
