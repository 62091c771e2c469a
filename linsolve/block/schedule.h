// Everything about a block elimination that does not depend on values, as a straight list of small dense operations.
//
// The matrix is permuted symmetrically into the order of elimination and cut into fronts, one for each atom or few:
//
//   [ D  U ]  p pivots          L ← L D⁻¹,  W ← W − L U;  W (the update matrix) goes into the parent front
//   [ L  W ]  m other unknowns
//
// Fronts are numbered so that children come before their parent (postorder). Factors of a front lie together in
// `store`: U (p × m), D (p × p), L (rows × p, rows = m padded to full vectors of the machine), columns one after the
// other: those that a solution is found with on the way back come first. W is rows × m and waits at a fixed place of a
// stack.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linsolve/block/graph.h"
#include "linsolve/csc_layout.h"

namespace poinsot::block {

struct Front {
  int pivots, others, rows;  // p, m, m padded
  int first;                 // position of the first pivot in the order of elimination
  int list;                  // where its entries of `other` start
  int inner;                 // how many of the m unknowns are pivots of the parent: they come first
  int first_stretch, first_outer_stretch, last_stretch;  // of its update in the parent: pivots there, others there, end
  // Ends of its strips of length 1, 2, 3, 4 and others; they start where those of the front before end.
  std::array<int, 5> strips;
  int children;         // end of its children, likewise
  std::int64_t update;  // of W on the stack
};

// `length` values from `source` on go to `target` in the store of the front.
struct Strip {
  int source;
  std::uint32_t target : 24, length : 8;
};
static_assert(sizeof(Strip) == 8);

// `length` of a front's other unknowns from `from` on follow one after the other in the parent, too: from `to` on among
// its pivots or among its others.
struct Stretch {
  std::uint16_t from, to, length;
};

// What decides whether fronts become one: their cost, or also that numbers do not grow (front_tree.h).
enum class Fronts { cheap, calm };

struct Schedule {
  int n = 0;
  std::vector<Front> fronts;
  std::vector<int> unknown;  // by position in the order of elimination
  // Of each front the positions of its m other unknowns, ascending, and of as many of its pivots by turns as `rows` are
  // more: what the padding rows of L, which are zero, take from them is nothing. By turns, or one would wait for
  // another.
  std::vector<int> other;
  std::vector<Stretch> stretches;
  std::vector<Strip> strips;
  std::vector<int> children;
  std::int64_t store_size = 0, stack_size = 0, factor_nonzeros = 0;
  int largest_update = 0, largest_pivots = 0, largest_rows = 0;

  // false where a front is too large for the store's addressing; such a matrix is dense, not a mechanism.
  bool build(const CscLayout& layout, const Graph& graph, std::span<const int> order, Fronts kind);
};

}  // namespace poinsot::block
