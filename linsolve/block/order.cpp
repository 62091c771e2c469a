#include "linsolve/block/order.h"

#include <algorithm>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "core/check.h"
#include "linsolve/block/eliminated.h"

namespace poinsot {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

// Quotient graph: what was eliminated is kept as elements, each the set of atoms its elimination coupled. An atom's
// neighbours and elements share the room its neighbours had at first, from both ends: an element takes the place of the
// neighbour that became it, or of an element that went into it.
class MinimumDegree {
 public:
  explicit MinimumDegree(const BlockGraph& graph)
      : graph_(graph), eliminated_(graph), begin_(1, 0), atoms_(at(graph.atoms())) {
    int top = 0;
    for (int a = 0; a < graph.atoms(); ++a) {
      const std::span<const int> neighbours = graph.neighbours[a];
      list_.insert(list_.end(), neighbours.begin(), neighbours.end());
      top += static_cast<int>(neighbours.size());
      begin_.push_back(top);
      atoms_[at(a)].neighbours = static_cast<int>(neighbours.size());
      atoms_[at(a)].weight = static_cast<int>(graph.unknowns[a].size());
    }
    for (int a = 0; a < graph.atoms(); ++a) push(a);
  }

  std::vector<int> order() {
    std::vector<int> result;
    result.reserve(atoms_.size());
    while (result.size() < atoms_.size()) {
      const int a = next();
      eliminate(a);
      result.push_back(a);
    }
    return result;
  }

 private:
  using Entry = std::tuple<int, int>;  // degree, atom
  static constexpr int kHub = 256;

  struct State {
    int neighbours = 0, elements = 0;  // lengths
    int members = 0, member = 0;       // of the element it became: length and start; none once it went into another
    int weight = 0, degree = -1, mark = 0;
    bool done = false;
  };

  std::span<const int> neighbours(int a) const { return {list_.data() + begin_[at(a)], at(atoms_[at(a)].neighbours)}; }
  std::span<const int> elements(int a) const {
    return {list_.data() + begin_[at(a) + 1] - atoms_[at(a)].elements, at(atoms_[at(a)].elements)};
  }
  std::span<const int> members(int e) const { return {pool_.data() + atoms_[at(e)].member, at(atoms_[at(e)].members)}; }

  // True the first time in a sweep, which begins with ++stamp_.
  bool mark(int a) { return std::exchange(atoms_[at(a)].mark, stamp_) != stamp_; }

  void push(int a) {
    atoms_[at(a)].degree = degree(a);
    queue_.push({atoms_[at(a)].degree, a});
  }

  // Unknowns outside a that its elimination couples. Exact while a sees little, an upper bound for hubs.
  int degree(int a) {
    constexpr int kExact = 64;
    const State& state = atoms_[at(a)];
    // What a hub saw at first has only become less; its list is not searched again and again.
    if (state.neighbours > kHub && state.degree >= 0) return state.degree;
    ++stamp_;
    mark(a);
    int sum = 0;
    for (const int b : neighbours(a))
      if (!atoms_[at(b)].done && mark(b)) sum += atoms_[at(b)].weight;
    for (const int e : elements(a)) {
      if (state.elements <= kExact) {
        for (const int b : members(e))
          if (mark(b)) sum += atoms_[at(b)].weight;
      } else {
        for (const int b : members(e)) sum += atoms_[at(b)].weight;
        sum -= state.weight;
      }
    }
    return sum;
  }

  int next() {
    while (!queue_.empty()) {
      const auto [degree, a] = queue_.top();
      queue_.pop();
      if (atoms_[at(a)].done || degree != atoms_[at(a)].degree) continue;
      if (eliminated_.may_be_pivot(a)) return a;
      atoms_[at(a)].degree = -1;  // comes back when something next to it is eliminated
    }
    // Constraints on nothing but constraints: numbers will tell.
    return static_cast<int>(std::ranges::find(atoms_, false, &State::done) - atoms_.begin());
  }

  void eliminate(int a) {
    ++stamp_;
    mark(a);
    front_.clear();
    const auto take = [&](int b) {
      if (!atoms_[at(b)].done && mark(b)) front_.push_back(b);
    };
    for (const int b : neighbours(a)) take(b);
    for (const int e : elements(a))
      for (const int b : members(e)) take(b);
    for (const int e : elements(a)) atoms_[at(e)].members = 0;
    State& state = atoms_[at(a)];
    state.done = true;
    state.member = static_cast<int>(pool_.size());
    state.members = static_cast<int>(front_.size());
    pool_.insert(pool_.end(), front_.begin(), front_.end());
    eliminated_.add(a);

    for (const int b : front_) {
      drop_elements(b);
      if (atoms_[at(b)].neighbours <= kHub || full(b)) drop_neighbours(b);
      if (front_.size() == 1) continue;  // couples nothing any more, only its atom may have become free to go
      check(!full(b), "a new element has the place of a neighbour or an element");
      list_[at(begin_[at(b) + 1] - ++atoms_[at(b)].elements)] = a;
    }
    state.neighbours = state.elements = 0;
    for (const int b : front_) push(b);
  }

  bool full(int b) const {
    return atoms_[at(b)].neighbours + atoms_[at(b)].elements == begin_[at(b) + 1] - begin_[at(b)];
  }

  // Elements that went into others.
  void drop_elements(int b) {
    int kept = 0;
    for (int k = begin_[at(b) + 1] - 1, n = atoms_[at(b)].elements; n > 0; --k, --n)
      if (atoms_[at(list_[at(k)])].members > 0) list_[at(begin_[at(b) + 1] - ++kept)] = list_[at(k)];
    atoms_[at(b)].elements = kept;
  }

  // Neighbours that are eliminated, or in the new element like b itself.
  void drop_neighbours(int b) {
    const auto first = list_.begin() + begin_[at(b)], last = first + atoms_[at(b)].neighbours;
    const auto gone = [&](int c) { return atoms_[at(c)].done || atoms_[at(c)].mark == stamp_; };
    atoms_[at(b)].neighbours = static_cast<int>(std::remove_if(first, last, gone) - first);
  }

  const BlockGraph& graph_;
  Eliminated eliminated_;
  std::vector<int> list_, begin_, pool_, front_;
  std::vector<State> atoms_;
  int stamp_ = 0;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::vector<int> elimination_order(const BlockGraph& graph) {
  return MinimumDegree(graph).order();
}

}  // namespace poinsot
