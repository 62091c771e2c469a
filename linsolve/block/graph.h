// The graph on which the block solver orders its elimination: atoms, small sets of unknowns that are eliminated
// together.
//
// A body's unknowns fall apart into atoms where its own matrix does: r and x in rA (M is block diagonal), r and p with
// its normalization row in rp. The rows of a group of constraints fall apart by the unknowns they act on (DP1 rows do
// not see r). An atom of a body is regular by itself; an atom of constraints has a zero block on the diagonal and can
// be a pivot only after bodies it acts on. Where a body is not regular by itself (a point mass with a free orientation,
// a rod without inertia about its axis) it is fused with a group of its constraints to one atom.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "linsolve/csc_layout.h"
#include "linsolve/lists.h"

namespace poinsot::block {

// Which groups act on which bodies, by the nodes of the pattern: fused groups included.
struct Incidence {
  std::vector<char> is_group;   // by node
  Lists bodies;                 // by node of constraints: the nodes of bodies it acts on
  Lists groups;                 // by node of a body: the nodes of constraints on it
  std::vector<int> fused_with;  // by node of constraints: the body it is fused with, or −1

  // A body with so many groups that they would not all share a front (order.h).
  bool is_hub(int of_node) const { return groups[of_node].size() > kHub; }
  // `fused[g]` is the body node that takes in node g, or −1.
  void find(const CscLayout& layout, std::span<const int> node_of, std::span<const int> fused);

  static constexpr std::size_t kHub = 32;  // with fewer a full front costs no more
};

struct Graph : Incidence {
  Lists unknowns, neighbours;    // by atom
  std::vector<char> constraint;  // by atom
  std::vector<int> node;         // by atom
  std::vector<int> body_atoms;   // by node: how many atoms of bodies it has

  int atoms() const { return unknowns.size(); }
  void build(const CscLayout& layout, std::span<const int> node_of, std::span<const int> fused);
};

// Share of the entries (i, j) of a pattern that have a mirror entry (j, i).
double symmetry(const CscLayout& layout);

}  // namespace poinsot::block
