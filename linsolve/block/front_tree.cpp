#include "linsolve/block/front_tree.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "linsolve/lanes.h"
#include "linsolve/lists.h"

namespace poinsot::block {
namespace {

// Estimated cycles of a front: a fixed part, its arithmetic, the traffic of its update matrix.
double cost(int p, int m) {
  constexpr double kFixed = 120, kFlop = 0.5, kTraffic = 1;
  const double pp = p, mm = m;
  return kFixed + kFlop * (0.7 * pp * pp * pp + 2 * pp * pp * mm + 2 * pp * mm * mm) + kTraffic * (pp + mm) * (pp + mm);
}

}  // namespace

FrontTree::FrontTree(const CscLayout& layout, const Graph& graph, std::span<const int> order, Fronts kind)
    : nodes_(order.size()), place_(index(layout.n)), owner_(index(layout.n)) {
  unknown_.reserve(place_.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    nodes_[k].first = count(unknown_);
    for (const int u : graph.unknowns[order[k]]) {
      place_[index(u)] = count(unknown_);
      owner_[index(count(unknown_))] = static_cast<int>(k);
      unknown_.push_back(u);
    }
    nodes_[k].pivots = count(unknown_) - nodes_[k].first;
  }
  find_structure(layout);
  amalgamate(graph, order, kind);
  order_children();
}

// The others of every node: entries of the matrix beside its pivots, and what its children leave to it.
void FrontTree::find_structure(const CscLayout& layout) {
  const Lists beside = Lists::collect(size(), [&](auto&& emit) {
    int last_owner = -1, last_place = -1;
    for (int j = 0; j < layout.n; ++j)
      for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) {
        const auto [first, second] = std::minmax(place_[index(j)], place_[index(layout.row[index(k)])]);
        const int owner = owner_[index(first)];
        if (owner == owner_[index(second)] || (owner == last_owner && second == last_place)) continue;
        last_owner = owner, last_place = second;
        emit(owner, second);
      }
  });
  std::vector<int> all;
  for (int k = 0; k < size(); ++k) {
    Node& node = nodes_[index(k)];
    all.assign(beside[k].begin(), beside[k].end());
    for (int c = node.child; c >= 0; c = nodes_[index(c)].sibling)
      for (const int place : others(nodes_[index(c)]))
        if (owner_[index(place)] != k) all.push_back(place);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    node.list = count(other_), node.others = count(all);
    other_.insert(other_.end(), all.begin(), all.end());
    node.head = k;
    if (all.empty()) continue;
    node.parent = owner_[index(all[0])];
    adopt(nodes_[index(node.parent)], k, k);
  }
}

// Appends the siblings `first` to `last` to the children.
void FrontTree::adopt(Node& parent, int first, int last) {
  (parent.child < 0 ? parent.child : nodes_[index(parent.last_child)].sibling) = first;
  parent.last_child = last;
}

// A child goes into its parent where one larger front is cheaper than two, or for calm not much dearer if it is a
// body's rotation and the parent holds rows of constraints.
void FrontTree::amalgamate(const Graph& graph, std::span<const int> order, Fronts kind) {
  constexpr int kMostPivots = 8;  // as far as kernels of fixed size go
  constexpr int kRotation = 3;    // a body's atoms with so many unknowns
  constexpr double kDearer = 1.3;
  for (int k = 0; k < size(); ++k) {
    Node& node = nodes_[index(k)];
    const bool rows = kind == Fronts::calm && graph.constraint[index(order[index(k)])];
    int before = -1;
    for (int c = node.child; c >= 0;) {
      Node& child = nodes_[index(c)];
      const int p = child.pivots + node.pivots, m = node.others;
      const bool of_body = !graph.constraint[index(order[index(c)])];
      const double dearer = rows && of_body && child.pivots >= kRotation ? kDearer : 1;
      if (p > kMostPivots || cost(p, m) > dearer * (cost(child.pivots, child.others) + cost(node.pivots, m))) {
        before = std::exchange(c, child.sibling);
        continue;
      }
      node.pivots = p;
      child.next = std::exchange(node.head, child.head);
      if (child.child >= 0) adopt(node, child.child, child.last_child);
      c = (before < 0 ? node.child : nodes_[index(before)].sibling) = child.sibling;
      if (c < 0) node.last_child = before;
      child.pivots = 0;
    }
  }
}

// So that few update matrices wait on the stack at a time: first what takes most room beyond what it leaves (J. W. H.
// Liu, ACM TOMS 12 (1986)). Along a ladder, whose fronts have leaves beside the rest of it, the stack would grow with
// its length otherwise.
void FrontTree::order_children() {
  std::vector<std::int64_t> most(nodes_.size());  // room for everything below a node
  std::vector<int> children;
  const auto room = [&](int k) { return std::int64_t{padded(nodes_[index(k)].others)} * nodes_[index(k)].others; };
  for (int k = 0; k < size(); ++k) {
    Node& node = nodes_[index(k)];
    if (node.pivots == 0) continue;
    children.clear();
    for (int c = node.child; c >= 0; c = nodes_[index(c)].sibling) children.push_back(c);
    std::ranges::stable_sort(children, std::ranges::greater(), [&](int c) { return most[index(c)] - room(c); });
    node.child = node.last_child = -1;
    std::int64_t waiting = 0;
    for (const int c : children) {
      nodes_[index(c)].sibling = -1;
      adopt(node, c, c);
      most[index(k)] = std::max(most[index(k)], waiting + most[index(c)]);
      waiting += room(c);
    }
    most[index(k)] = std::max(most[index(k)], room(k));
  }
}

std::vector<int> FrontTree::postorder() const {
  std::vector<int> order, stack;
  for (int k = 0; k < size(); ++k)
    if (nodes_[index(k)].parent < 0 && nodes_[index(k)].pivots > 0) stack.push_back(k);
  std::vector<char> open(nodes_.size(), 0);
  while (!stack.empty()) {
    const int k = stack.back();
    if (!open[index(k)]) {
      open[index(k)] = 1;
      const auto from = static_cast<std::ptrdiff_t>(stack.size());
      for (int c = nodes_[index(k)].child; c >= 0; c = nodes_[index(c)].sibling) stack.push_back(c);
      std::reverse(stack.begin() + from, stack.end());
      continue;
    }
    stack.pop_back();
    order.push_back(k);
  }
  return order;
}

}  // namespace poinsot::block
