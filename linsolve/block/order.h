// The order in which the atoms of a saddle point are eliminated: minimum degree, as far as a saddle point lets one.
//
// The diagonal block of constraints G_g is zero until bodies it acts on are eliminated; then it is −G_g K⁻¹ G_gᵀ with K
// the matrix of what was eliminated. That block is regular, without looking at a number, in two cases:
//   whole      all bodies of the group are eliminated, and so are all bodies of every constraint eliminated with them:
//              the block is a pivot of the Schur complement G M⁻¹ Gᵀ, definite for a regular system;
//   floating   some of its bodies are not eliminated yet, but those that are belong to trees of bodies that hang on
//              nothing else: such a body can move in every way, so the group's rows stay independent on it.
// Leaf to root along a tree this is the articulated-body recursion; in loops the last rows wait for the whole loop.
//
// A hub, a body with dozens of groups, would have all that waits for it in one front. These groups are taken as if it
// did not move, and it last, against both rules: rows that are independent stay so but for as many as a body can move,
// six. The groups of these are found by numbers and wait for the hub after all (solver.cpp).
//
// A group taken before one of its bodies keeps others beside it waiting for that body. Where it saves no more than one
// entry a row it goes later, in small systems if the whole order is cheaper for it: factors of a ladder of thirty cells
// on a moving body have 8 % less entries.
//
// Around a loop that stands on the ground bodies are as cheap to take one after the other from both ends, each with the
// joint it leads to, as in any order; then no body of the loop stands alone for long (front_tree.h). In small systems a
// body that no constraint could follow goes later, if the whole order is not dearer for it.
//
// No library's minimum degree can be told which vertex may be taken when. AMD's order of the same atoms has as little
// fill, and takes 253 of the 400 atoms of constraints of a chain of 100 bodies before the rules let it, 421 of the 510
// of a ladder. A mechanism may violate what the rules take for granted (a body without inertia); pivots are checked by
// numbers later.
#pragma once

#include <vector>

#include "linsolve/block/graph.h"

namespace poinsot::block {

// Atoms in the order of their elimination.
std::vector<int> elimination_order(const Graph& graph);

}  // namespace poinsot::block
