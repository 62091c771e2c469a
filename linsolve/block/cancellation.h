// Which pivots of a block elimination are mostly rounding.
//
// Beside every number of the elimination its size without cancellation is carried along: |a|, and |W| + |L||U|. A pivot
// that is a small part of its own size came about by cancellation, and so did its relative error: the block it belongs
// to is not regular, or one before it was not. The measure does not depend on the units of rows and columns.
#pragma once

#include <span>
#include <vector>

#include "linsolve/block/schedule.h"

namespace poinsot::block {

struct Cancelled {
  std::vector<int> pivots;  // places in the order of elimination, ascending
  double least = 1;         // part of its size that any pivot is
};

// The pivots that are no more than `part` of their size; later ones are judged as if these were good. Pivots are chosen
// in the units of rows, `weight` by unknown. An elimination on its own, at leisure.
Cancelled cancelled_pivots(const Schedule& schedule, std::span<const double> values, std::span<const double> weight,
                           double part);

}  // namespace poinsot::block
