// The tree of fronts of a block elimination (linsolve/block/schedule.h): which unknowns are eliminated together, and in
// which order, by the matrix's structure and estimated costs.
//
// Where numbers are to stay calm, a body's rotation shares a front with rows that act on it though that is dearer. In a
// frame that is turned against a slender body its inertia is nearly singular in a direction that no row or column
// shows. Eliminated alone it leaves numbers larger by the ratio of the moments, which cancel when the rows of its joint
// follow, and residuals of 1e-14; in one front pivots are chosen among the entries of both, and 3e-16 is left. A ladder
// whose bodies need none of that would take 12 % more instructions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/index.h"
#include "linsolve/block/graph.h"
#include "linsolve/block/schedule.h"
#include "linsolve/csc_layout.h"

namespace poinsot::block {

inline int count(const std::vector<int>& v) {
  return static_cast<int>(v.size());
}

class FrontTree {
 public:
  // A front, one for each atom at first; unknowns by their place in the order of atoms. Fronts that went into others
  // have no pivots.
  struct Node {
    int first = 0, pivots = 0;  // its own pivots come last, those of fronts that went into it before
    int others = 0, list = 0;   // number and start of its other unknowns
    int parent = -1, child = -1, last_child = -1, sibling = -1;
    int head = -1, next = -1;  // of the chain of fronts whose pivots are its own, and the one after this one there
  };

  // Atoms in the order of their elimination.
  FrontTree(const CscLayout& layout, const Graph& graph, std::span<const int> order, Fronts kind);

  int size() const { return static_cast<int>(nodes_.size()); }
  const Node& operator[](int k) const { return nodes_[index(k)]; }
  // Places, ascending.
  std::span<const int> others(const Node& node) const { return {other_.data() + node.list, index(node.others)}; }
  int unknown(int place) const { return unknown_[index(place)]; }
  // Those that have pivots, children before their parent.
  std::vector<int> postorder() const;
  // visit(unknown) for the pivots.
  template <class Visit>
  void pivots(const Node& node, Visit&& visit) const {
    for (int part = node.head; part >= 0; part = nodes_[index(part)].next) {
      const int end = part + 1 < size() ? nodes_[index(part + 1)].first : static_cast<int>(unknown_.size());
      for (int place = nodes_[index(part)].first; place < end; ++place) visit(unknown(place));
    }
  }

 private:
  void find_structure(const CscLayout& layout);
  void amalgamate(const Graph& graph, std::span<const int> order, Fronts kind);
  void order_children();
  void adopt(Node& parent, int first, int last);

  std::vector<Node> nodes_;
  std::vector<int> unknown_;        // by place
  std::vector<int> place_, owner_;  // by unknown, by place
  std::vector<int> other_;          // by node: its other unknowns, ascending
};

}  // namespace poinsot::block
