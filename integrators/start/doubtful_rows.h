// Rows that are kept as independent, but only just: of the length of their gradient next to nothing is left beside the
// others' gradients, or of its terms where they cancel.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "integrators/start/row_space.h"

namespace poinsot {

struct Doubt {
  int row = -1;  // of the model; none
  // The power of ten below which a part is left of it beside the others, kIndependent at most but for `few_digits`, or
  // of a gradient that vanishes the part itself.
  double part = 0;
  bool vanishing = false;   // its gradient is as small a part of its terms: by itself, not beside the others
  bool few_digits = false;  // part is above kIndependent, as numbers of few digits make it
};

// The row whose gradient has vanished most, if not surely.
Doubt vanishing_row(const RowSpace& space);

// A row that follows from others but for less than `most` of its length, where the columns `surely`, ascending, do all
// but for `least`. There is one.
Doubt barely_independent_row(const RowSpace& space, const Eigen::SparseMatrix<double>& columns,
                             const std::vector<int>& surely, double most, double least);

// Where axes and points are written with few digits, rows that follow from others are off that by as much: the
// mechanism is locked, or constrained once more than is meant. `redundant`: how many rows follow. Of mechanisms of a
// few hundred rows; in longer ones independent rows come as near.
Doubt row_of_few_digits(const RowSpace& space, std::size_t redundant);

}  // namespace poinsot
