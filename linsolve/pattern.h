// The structure of a square linear system as its assembler sees it: small dense blocks at known corners.
//
// The assembler lists the blocks once, in the order in which it will write them. A linear solver answers with slots:
// the c-th column of a block starts at values()[slot] and its rows follow one after the other, so that values go
// straight to their place. Blocks may overlap or repeat; then their values add up.
#pragma once

#include <vector>

namespace poinsot {

struct Block {
  int row, col;    // upper left corner, scalar indices
  int rows, cols;  // shape, at least 1 × 1

  bool operator==(const Block&) const = default;
};

struct Pattern {
  int n = 0;                  // number of unknowns
  std::vector<Block> blocks;  // in writing order
  std::vector<int> node;      // size n: the body or the group of constraints an unknown belongs to, from 0

  bool operator==(const Pattern&) const = default;
};

}  // namespace poinsot
