// Rows whose two forces are not in balance by themselves: a CD or a pfaffian row between two moving bodies.
//
// Its forces act at two points along a line that is not the one through them, and have a moment d × λc that the bodies'
// other rows have to lead to the ground: the row depends on how both bodies stand, not on how they stand to one
// another. Where loops are told apart it joins the ground as well. All other rows do not change when both bodies move
// as one, so that what they do to both adds up to nothing.
//
// Where three CD rows keep the two points in one place, as in most joints, d = 0 and there is no moment.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

// Places in `rows`, which are rows of the model; ascending.
std::vector<int> grounded_rows(const Model& model, std::span<const int> rows);

}  // namespace poinsot
