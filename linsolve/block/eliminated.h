// Which atoms an elimination may take next without looking at a number: the rules of linsolve/block/order.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "core/index.h"
#include "linsolve/block/graph.h"

namespace poinsot::block {

// What of the mechanism is eliminated, as connected components of bodies. Hubs are places that do not move, but for
// constraints between hubs alone.
class Eliminated {
 public:
  explicit Eliminated(const Graph& graph)
      : graph_(graph),
        left_(graph.body_atoms),
        in_(left_.size(), 0),
        missing_(left_.size(), 0),
        parent_(left_.size()),
        component_(left_.size()),
        among_hubs_(left_.size(), 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int g = 0; g < static_cast<int>(left_.size()); ++g)
      for (const int b : graph.bodies[g])
        if (!graph.is_hub(b)) among_hubs_[index(g)] = 0;
  }

  void add(int atom) {
    const int body = graph_.node[index(atom)];
    if (graph_.constraint[index(atom)]) return add_group(body);
    if (--left_[index(body)] > 0) return;
    in_[index(body)] = 1;
    for (const int g : graph_.groups[body])
      if (in_[index(g)] && counts(body, g)) {
        for (const int other : graph_.bodies[g])
          if (other != body && in_[index(other)] && counts(other, g)) {
            join(body, other);
            break;
          }
        if (--missing_[index(g)] == 0) --component_[index(find(body))].half;
      }
    for (const int g : graph_.groups[body])
      if (graph_.fused_with[index(g)] == body) add_group(g);
  }

  // Whether its group would go before one of the group's bodies.
  bool is_early(int atom) const {
    const int g = graph_.node[index(atom)];
    if (!graph_.constraint[index(atom)] || in_[index(g)]) return false;
    return std::ranges::any_of(graph_.bodies[g], [&](int b) { return counts(b, g) && !in_[index(b)]; });
  }

  // Whether none of a body's groups would find all its bodies eliminated after it.
  bool leads_to_none(int atom) const {
    const int body = graph_.node[index(atom)];
    if (graph_.constraint[index(atom)]) return false;
    return std::ranges::none_of(graph_.groups[body], [&](int g) {
      return !in_[index(g)] &&
             std::ranges::all_of(graph_.bodies[g], [&](int b) { return b == body || in_[index(b)] || !counts(b, g); });
    });
  }

  bool may_be_pivot(int atom) {
    if (!graph_.constraint[index(atom)]) return true;
    const int g = graph_.node[index(atom)];
    const std::span<const int> bodies = graph_.bodies[g];
    const bool half = in_[index(g)] && missing_[index(g)] > 0;
    bool some = false, whole = true, floating = true;
    for (const int b : bodies) {
      if (!counts(b, g)) continue;
      if (!in_[index(b)]) {
        whole = false;
        continue;
      }
      some = true;
      const Component& c = component_[index(find(b))];
      if (c.half > (half ? 1 : 0)) return false;
      floating = floating && !c.grounded && !c.cyclic;
    }
    return some && (whole || floating);
  }

 private:
  struct Component {
    int half = 0;  // groups eliminated before one of their bodies
    bool grounded = false, cyclic = false;
  };

  // Whether a body of a group is more to it than such a place.
  bool counts(int body, int g) const { return !graph_.is_hub(body) || among_hubs_[index(g)]; }

  int find(int k) {
    while (parent_[index(k)] != k) k = parent_[index(k)] = parent_[index(parent_[index(k)])];
    return k;
  }

  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a == b) {
      component_[index(a)].cyclic = true;
      return;
    }
    parent_[index(a)] = b;
    component_[index(b)].half += component_[index(a)].half;
    component_[index(b)].grounded |= component_[index(a)].grounded;
    component_[index(b)].cyclic |= component_[index(a)].cyclic;
  }

  void add_group(int g) {
    if (in_[index(g)]) return;
    in_[index(g)] = 1;
    const std::span<const int> bodies = graph_.bodies[g];
    int first = -1, count = 0;
    for (const int b : bodies) {
      if (!counts(b, g)) continue;
      ++count;
      if (!in_[index(b)])
        ++missing_[index(g)];
      else if (first < 0)
        first = b;
      else
        join(first, b);
    }
    if (first < 0) return;
    if (count == 1) component_[index(find(first))].grounded = true;
    if (missing_[index(g)] > 0) ++component_[index(find(first))].half;
  }

  const Graph& graph_;
  std::vector<int> left_;  // atoms of a body not eliminated yet
  std::vector<char> in_;   // node eliminated: all of a body, some of a group
  std::vector<int> missing_, parent_;
  std::vector<Component> component_;
  std::vector<char> among_hubs_;  // by group
};

}  // namespace poinsot::block
