// Which constraint rows depend on others: the columns of Gᵀ that are combinations of earlier ones.
//
// A row is dependent when its gradient is a combination of earlier rows' gradients, in the model's order, at the given
// position; so is one whose gradient is nothing but the rounding of what it is made of. Where that is so only
// at the given position (a mechanism that lies flat), a neighbouring position of higher rank decides, and the given one
// is called singular. The cost grows with the number of rows (linsolve/column_dependencies.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

struct Dependency {
  int row;                  // model row that adds nothing
  std::vector<int> others;  // model rows it is a combination of
};

struct RankAnalysis {
  int variables = 0;                  // 6 per body
  int rank = 0;                       // of G, at the given or a neighbouring position, whichever is higher
  int rank_here = 0;                  // at the given position
  std::vector<Dependency> dependent;  // by row
  bool named = true;                  // false: too many to say what each depends on; `others` are empty
  int degrees_of_freedom() const { return variables - rank; }
  bool singular_position() const { return rank_here < rank; }
  std::vector<int> dependent_rows() const;
};

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states);

}  // namespace poinsot
