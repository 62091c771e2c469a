// A pattern of blocks as compressed sparse columns: the layout every general sparse library reads.
//
// Column j has the rows row[start[j]] … row[start[j+1]−1], sorted, each once: blocks that overlap share their entries.
// The rows of a block follow one after the other in every column that has them, so a block column has a slot.
#pragma once

#include <vector>

#include "linsolve/linear_solver.h"
#include "linsolve/pattern.h"

namespace poinsot {

struct CscLayout {
  int n = 0;
  std::vector<int> start;  // n + 1
  std::vector<int> row;    // nonzeros()
  std::vector<int> slots;  // one per block column, blocks in pattern order

  // Refuses what does not fit 32-bit indices.
  LinearStatus build(const Pattern& pattern);
  int nonzeros() const { return start.empty() ? 0 : start.back(); }

  // structurally_singular where no choice of values could make the matrix regular: no perfect matching of rows and
  // columns. `unknown` is a column that is left without a row.
  LinearStatus matching() const;
};

}  // namespace poinsot
