// How gladly rows of a block (row_blocks.h) are set aside: by what their parts in null vectors of Gᵀ are multiplied
// before rows are chosen by them.
//
// A block that no row holds to the ground turns as a whole. Rows with axes on bodies turn with it, and what is
// redundant stays so; a row along an axis at rest (CD) does not: the direction that is redundant turns away from it.
// There CD rows are set aside only where others would leave much larger coefficients. In a block on the ground nothing
// tells them apart: in planes that do not turn, CD rows last, too.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/model.h"

namespace poinsot {

// `rows`: of the model, those of a block. By row, above 0.
inline std::vector<double> aside_weights(const Model& model, std::span<const int> rows) {
  constexpr double kAtRest = 0.3;  // a judgement: small beside 1, and yet no reason for choices with large coefficients
  const auto row = [&](int k) -> const Row& { return model.rows[index(k)]; };
  const bool carried = std::ranges::none_of(rows, [&](int k) { return row(k).i == kGround || row(k).j == kGround; });
  std::vector<double> weights;
  weights.reserve(rows.size());
  for (const int k : rows) weights.push_back(carried && row(k).type == RowType::CD ? kAtRest : 1.0);
  return weights;
}

}  // namespace poinsot
