// Null vectors of A combined until each has a column of its own, where it is 1 and all others are 0: without those
// columns, the pivots, the others of A are independent. They are the more so the smaller the entries are: with none
// much above 1 the columns left span nearly the largest volume (C.-T. Pan, On the existence and computation of
// rank-revealing LU factorizations, 2000).
//
// Vectors that are too long together to be combined keep the column they end with.
#pragma once

#include <span>
#include <vector>

#include "linsolve/front_qr.h"

namespace poinsot {

// An entry larger than that takes the place of the pivot.
inline constexpr double kFlat = 1.5, kGathered = 6;

// No entry is above kFlat. Returns the pivots, by vector.
std::vector<int> separate(std::vector<SparseEntries>&& vectors);

// By column: its group, and the turn of that among those that could have as many pivots.
struct Grouped {
  std::vector<int> group, turn;
};

// Pivots of as few groups as are enough: no entry is above kGathered.
std::vector<int> gather(std::vector<SparseEntries>&& vectors, const Grouped& columns);

// The vectors have their pivots, and entries that have grown since. Others take the place of as few of them as lead
// back to entries of at most `most` in the pivots' groups, at most `of_all` in all.
void repair(std::vector<SparseEntries>&& vectors, std::vector<int>& pivots, const Grouped& columns, double most,
            double of_all);

// The parts that are negligible beside the largest entry are left out.
double largest(const SparseEntries& z);
void drop_nothing(SparseEntries& z);
// x − factor y without entry `gone`, which is 0. `gained`: the columns that x does not have are added.
SparseEntries subtract(const SparseEntries& x, double factor, const SparseEntries& y, int gone,
                       std::vector<int>* gained = nullptr);

}  // namespace poinsot
