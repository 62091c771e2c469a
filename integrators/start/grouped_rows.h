// Rows by their joint or constraint, of which as few as possible give rows to be set aside (linsolve/separation.h).
//
// A loop is opened where rows are set aside, and how long its matrices take depends on where. Of joints that could give
// as many rows those come first that meet most others at their bodies: a loop on a body that carries it is opened
// there, the cells of a ladder between each other. Among those it is the joint farthest from the ground; joints on the
// ground come last. Factorizations in rA, of loops of four to eight links beside those without redundancy: carried,
// [M Gᵀ; G 0] takes 0.63 to 0.69 times as long opened at the body that carries them, 0.77 to 1.05 elsewhere; on the
// ground the Newton matrix of implicit Euler 0.71 to 0.83 at the joint taken, 0.98 to 1.07 at the first joint on the
// ground but 0.61 to 0.77 at the last, [M Gᵀ; G 0] 0.96 to 1.13 anywhere. Of a carried ladder of 30 cells: 0.70 and
// 0.99, chosen by coefficients alone 1.09 and 1.11.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"
#include "linsolve/separation.h"

namespace poinsot {

// By group of the model, each another.
std::vector<int> opening_turns(const Model& model);

// `rows`: of the model.
Grouped grouped_rows(const Model& model, std::span<const int> turns, std::span<const int> rows);

}  // namespace poinsot
