#include "linsolve/block_order.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>

namespace poinsot {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

// What of the mechanism is eliminated, as connected components of bodies.
class Eliminated {
 public:
  explicit Eliminated(const BlockGraph& graph)
      : graph_(graph),
        left_(graph.body_atoms),
        in_(left_.size(), 0),
        missing_(left_.size(), 0),
        parent_(left_.size()),
        component_(left_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  void add(const Atom& atom) {
    if (atom.constraint) return add_group(atom.node);
    if (--left_[at(atom.node)] > 0) return;
    const int body = atom.node;
    in_[at(body)] = 1;
    for (const int g : graph_.groups[at(body)])
      if (in_[at(g)]) {
        for (const int other : graph_.bodies[at(g)])
          if (other != body && in_[at(other)]) {
            join(body, other);
            break;
          }
        if (--missing_[at(g)] == 0) --component_[at(find(body))].half;
      }
    for (const int g : graph_.groups[at(body)])
      if (graph_.fused_with[at(g)] == body) add_group(g);
  }

  bool may_be_pivot(const Atom& atom) {
    if (!atom.constraint) return true;
    const int g = atom.node;
    const auto& bodies = graph_.bodies[at(g)];
    const bool half = in_[at(g)] && missing_[at(g)] > 0;
    bool some = false, whole = true, floating = true;
    for (const int b : bodies) {
      if (!in_[at(b)]) {
        whole = false;
        continue;
      }
      some = true;
      const Component& c = component_[at(find(b))];
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

  int find(int k) {
    while (parent_[at(k)] != k) k = parent_[at(k)] = parent_[at(parent_[at(k)])];
    return k;
  }

  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a == b) {
      component_[at(a)].cyclic = true;
      return;
    }
    parent_[at(a)] = b;
    component_[at(b)].half += component_[at(a)].half;
    component_[at(b)].grounded |= component_[at(a)].grounded;
    component_[at(b)].cyclic |= component_[at(a)].cyclic;
  }

  void add_group(int g) {
    if (in_[at(g)]) return;
    in_[at(g)] = 1;
    const auto& bodies = graph_.bodies[at(g)];
    int first = -1;
    for (const int b : bodies) {
      if (!in_[at(b)])
        ++missing_[at(g)];
      else if (first < 0)
        first = b;
      else
        join(first, b);
    }
    if (first < 0) return;
    if (bodies.size() == 1) component_[at(find(first))].grounded = true;
    if (missing_[at(g)] > 0) ++component_[at(find(first))].half;
  }

  const BlockGraph& graph_;
  std::vector<int> left_;  // atoms of a body not eliminated yet
  std::vector<char> in_;   // node eliminated: all of a body, some of a group
  std::vector<int> missing_, parent_;
  std::vector<Component> component_;
};

// Quotient graph: what was eliminated is kept as elements, each the set of atoms its elimination coupled.
class MinimumDegree {
 public:
  explicit MinimumDegree(const BlockGraph& graph)
      : graph_(graph),
        eliminated_(graph),
        neighbours_(graph.atoms.size()),
        elements_(graph.atoms.size()),
        members_(graph.atoms.size()),
        weight_(graph.atoms.size()),
        degree_(graph.atoms.size(), -1),
        mark_(graph.atoms.size(), 0),
        done_(graph.atoms.size(), 0) {
    for (std::size_t a = 0; a < weight_.size(); ++a) {
      neighbours_[a] = graph.atoms[a].neighbours;
      weight_[a] = static_cast<int>(graph.atoms[a].unknowns.size());
    }
    for (std::size_t a = 0; a < weight_.size(); ++a) push(static_cast<int>(a));
  }

  std::vector<int> order() {
    std::vector<int> result;
    result.reserve(done_.size());
    while (result.size() < done_.size()) {
      const int a = next();
      eliminate(a);
      result.push_back(a);
    }
    return result;
  }

 private:
  using Entry = std::tuple<int, int>;  // degree, atom
  static constexpr std::size_t kHub = 256;

  void push(int a) {
    degree_[at(a)] = degree(a);
    queue_.push({degree_[at(a)], a});
  }

  // Unknowns outside a that its elimination couples. Exact while a sees little, an upper bound for hubs.
  int degree(int a) {
    constexpr std::size_t kExact = 64;
    // What a hub saw at first has only become less; its list is not searched again and again.
    if (neighbours_[at(a)].size() > kHub && degree_[at(a)] >= 0) return degree_[at(a)];
    ++stamp_;
    mark_[at(a)] = stamp_;
    int sum = 0;
    for (const int b : neighbours_[at(a)])
      if (!done_[at(b)] && mark_[at(b)] != stamp_) mark_[at(b)] = stamp_, sum += weight_[at(b)];
    const bool exact = elements_[at(a)].size() <= kExact;
    for (const int e : elements_[at(a)]) {
      if (exact) {
        for (const int b : members_[at(e)])
          if (mark_[at(b)] != stamp_) mark_[at(b)] = stamp_, sum += weight_[at(b)];
      } else {
        sum += size_of(e) - weight_[at(a)];
      }
    }
    return sum;
  }

  int size_of(int element) const {
    int sum = 0;
    for (const int b : members_[at(element)]) sum += weight_[at(b)];
    return sum;
  }

  int next() {
    while (!queue_.empty()) {
      const auto [degree, a] = queue_.top();
      queue_.pop();
      if (done_[at(a)] || degree != degree_[at(a)]) continue;
      if (eliminated_.may_be_pivot(graph_.atoms[at(a)])) return a;
      degree_[at(a)] = -1;  // comes back when something next to it is eliminated
    }
    // Constraints on nothing but constraints: numbers will tell.
    return static_cast<int>(std::ranges::find(done_, 0) - done_.begin());
  }

  void eliminate(int a) {
    ++stamp_;
    mark_[at(a)] = stamp_;
    std::vector<int>& front = members_[at(a)];
    const auto take = [&](int b) {
      if (!done_[at(b)] && mark_[at(b)] != stamp_) mark_[at(b)] = stamp_, front.push_back(b);
    };
    for (const int b : neighbours_[at(a)]) take(b);
    for (const int e : elements_[at(a)])
      for (const int b : members_[at(e)]) take(b);
    for (const int e : elements_[at(a)]) std::vector<int>().swap(members_[at(e)]);
    done_[at(a)] = 1;
    eliminated_.add(graph_.atoms[at(a)]);

    for (const int b : front) {
      auto& elements = elements_[at(b)];
      std::erase_if(elements, [&](int e) { return members_[at(e)].empty(); });
      elements.push_back(a);
      auto& neighbours = neighbours_[at(b)];
      if (neighbours.size() <= kHub)
        std::erase_if(neighbours, [&](int c) { return done_[at(c)] || mark_[at(c)] == stamp_; });
    }
    std::vector<int>().swap(neighbours_[at(a)]);
    std::vector<int>().swap(elements_[at(a)]);
    if (front.size() == 1) {  // couples nothing any more, only its atom may have become free to go
      std::erase(elements_[at(front[0])], a);
    }
    const std::vector<int> touched = front;
    for (const int b : touched) push(b);
  }

  const BlockGraph& graph_;
  Eliminated eliminated_;
  std::vector<std::vector<int>> neighbours_, elements_, members_;
  std::vector<int> weight_, degree_, mark_;
  std::vector<char> done_;
  int stamp_ = 0;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::vector<int> elimination_order(const BlockGraph& graph) {
  return MinimumDegree(graph).order();
}

}  // namespace poinsot
