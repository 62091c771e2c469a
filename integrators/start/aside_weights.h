// How gladly rows of a block (row_blocks.h) are set aside: by what their parts in null vectors of Gᵀ are multiplied
// before rows are chosen by them.
//
// A block that no row holds to the ground turns as a whole. Rows with axes on bodies turn with it, and what is
// redundant stays so; a row along an axis at rest (CD) does not: the direction that is redundant turns away from it.
// There CD rows are set aside only where others would leave much larger coefficients. In a block on the ground nothing
// tells them apart: in planes that do not turn, CD rows last, too.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

// `rows`: of the model, those of a block. By row, above 0.
std::vector<double> aside_weights(const Model& model, std::span<const int> rows);

}  // namespace poinsot
