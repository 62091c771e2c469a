// Rows by the loops they belong to: parts of a mechanism that share no more than one body with each other.
//
// These are the biconnected components of the graph whose vertices are the bodies and the ground and whose edges are
// the pairs that rows act on; a row whose forces have a moment together acts on the ground as well (grounded_rows.h).
// Rows that depend on one another do so within such a part: a null vector of Gᵀ is a set of forces that leaves every
// body in balance; those of a part balance all of its bodies but the one it shares, and, as actions and reactions, that
// one too. Found in linear time (J. Hopcroft, R. Tarjan, Efficient algorithms for graph manipulation, 1973).
#pragma once

#include <span>

#include "core/model.h"
#include "linsolve/lists.h"

namespace poinsot {

// By part: places in `rows`, which are rows of the model.
Lists row_blocks(const Model& model, std::span<const int> rows);

}  // namespace poinsot
