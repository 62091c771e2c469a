#include "linsolve/block/order.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/check.h"
#include "core/index.h"
#include "linsolve/block/eliminated.h"
#include "linsolve/block/least_first.h"

namespace poinsot::block {
namespace {

// Quotient graph: what was eliminated is kept as elements, each the set of atoms its elimination coupled. An atom's
// neighbours and elements share the room its neighbours had at first, from both ends: an element takes the place of the
// neighbour that became it, or of an element that went into it. Long lists have twice that room, and are searched for
// what is gone when that is used up, not after every elimination beside them.
class MinimumDegree {
 public:
  // What counts more than its degree: a group that is_early(), a body that leads_to_none().
  MinimumDegree(const Graph& graph, int early, int leading_to_none)
      : early_(early),
        leading_to_none_(leading_to_none),
        eliminated_(graph),
        begin_(1, 0),
        atoms_(index(graph.atoms())),
        line_(graph.atoms()) {
    int top = 0;
    for (int a = 0; a < graph.atoms(); ++a) {
      const std::span<const int> neighbours = graph.neighbours[a];
      list_.insert(list_.end(), neighbours.begin(), neighbours.end());
      top += static_cast<int>(neighbours.size()) * (neighbours.size() > kLong ? 2 : 1);
      list_.resize(index(top));
      begin_.push_back(top);
      atoms_[index(a)].neighbours = static_cast<int>(neighbours.size());
      atoms_[index(a)].weight = static_cast<int>(graph.unknowns[a].size());
      atoms_[index(a)].last = !graph.constraint[index(a)] && graph.is_hub(graph.node[index(a)]);
      unknowns_ += atoms_[index(a)].weight;
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
  // That the order found takes, by and large.
  double products() const { return products_; }

 private:
  static constexpr std::size_t kLong = 256;

  struct State {
    int neighbours = 0, elements = 0;  // lengths
    int members = 0, member = 0;       // of the element it became: length and start; none once it went into another
    int weight = 0, degree = -1, mark = 0;
    int front = -2;  // the newest one it was in, by its pivot
    bool done = false, last = false;
    bool waited = false;  // it was a body's turn, but it leads to none
  };

  std::span<const int> neighbours(int a) const {
    return {list_.data() + begin_[index(a)], index(atoms_[index(a)].neighbours)};
  }
  std::span<const int> elements(int a) const {
    return {list_.data() + begin_[index(a) + 1] - atoms_[index(a)].elements, index(atoms_[index(a)].elements)};
  }
  std::span<const int> members(int e) const {
    return {pool_.data() + atoms_[index(e)].member, index(atoms_[index(e)].members)};
  }

  // True the first time in a sweep, which begins with ++stamp_.
  bool mark(int a) { return std::exchange(atoms_[index(a)].mark, stamp_) != stamp_; }

  void push(int a) {
    State& state = atoms_[index(a)];
    state.degree = degree(a) + (eliminated_.is_early(a) ? early_ : 0) + (state.waited ? leading_to_none_ : 0);
    line_.put(a, state.degree);
  }

  // Unknowns outside a that its elimination couples. Exact while a sees little, else an upper bound; hubs come
  // behind all others. Those of the newest front are known together.
  int degree(int a) {
    constexpr int kExact = 64;
    const State& state = atoms_[index(a)];
    // What it saw at first has only become less; long lists are not searched again and again.
    if (long_lists(a) && state.degree >= 0) return state.degree;
    ++stamp_;
    mark(a);
    const auto in_front = [&](int b) { return atoms_[index(b)].front == newest_; };
    int sum = state.last ? unknowns_ : 0;
    if (in_front(a)) sum += front_weight_ - state.weight;
    const auto count = [&](int b) {
      if (!in_front(b) && mark(b)) sum += atoms_[index(b)].weight;
    };
    for (const int b : neighbours(a))
      if (!atoms_[index(b)].done) count(b);
    for (const int e : elements(a)) {
      if (e == newest_) continue;
      if (state.elements <= kExact) {
        for (const int b : members(e)) count(b);
      } else {
        for (const int b : members(e)) sum += atoms_[index(b)].weight;
        sum -= state.weight;
      }
    }
    return sum;
  }

  int next() {
    for (int a = line_.take(); a >= 0; a = line_.take()) {
      State& state = atoms_[index(a)];
      if (!eliminated_.may_be_pivot(a)) {
        state.degree = -1;  // comes back when something next to it is eliminated
      } else if (leading_to_none_ > 0 && !state.waited && eliminated_.leads_to_none(a)) {
        state.waited = true;
        push(a);
      } else {
        return a;
      }
    }
    // Constraints on nothing but constraints: numbers will tell.
    return static_cast<int>(std::ranges::find(atoms_, false, &State::done) - atoms_.begin());
  }

  void eliminate(int a) {
    ++stamp_;
    mark(a);
    front_.clear();
    const auto take = [&](int b) {
      if (!atoms_[index(b)].done && mark(b)) front_.push_back(b);
    };
    for (const int b : neighbours(a)) take(b);
    for (const int e : elements(a))
      for (const int b : members(e)) take(b);
    for (const int e : elements(a)) atoms_[index(e)].members = 0;
    State& state = atoms_[index(a)];
    state.done = true;
    state.member = static_cast<int>(pool_.size());
    state.members = static_cast<int>(front_.size());
    pool_.insert(pool_.end(), front_.begin(), front_.end());
    eliminated_.add(a);

    newest_ = a;
    front_weight_ = 0;
    for (const int b : front_) {
      atoms_[index(b)].front = a;
      front_weight_ += atoms_[index(b)].weight;
    }
    products_ += state.weight * std::pow(state.weight + front_weight_, 2);
    for (const int b : front_) {
      if (!long_lists(b) || full(b)) {
        drop_elements(b);
        drop_neighbours(b);
      }
      if (front_.size() == 1) continue;  // couples nothing any more, only its atom may have become free to go
      check(!full(b), "a new element has the place of a neighbour or an element");
      list_[index(begin_[index(b) + 1] - ++atoms_[index(b)].elements)] = a;
    }
    state.neighbours = state.elements = 0;
    for (const int b : front_) push(b);
  }

  bool long_lists(int b) const { return index(atoms_[index(b)].neighbours + atoms_[index(b)].elements) > kLong; }
  bool full(int b) const {
    return atoms_[index(b)].neighbours + atoms_[index(b)].elements == begin_[index(b) + 1] - begin_[index(b)];
  }

  // Elements that went into others.
  void drop_elements(int b) {
    int kept = 0;
    for (int k = begin_[index(b) + 1] - 1, n = atoms_[index(b)].elements; n > 0; --k, --n)
      if (atoms_[index(list_[index(k)])].members > 0) list_[index(begin_[index(b) + 1] - ++kept)] = list_[index(k)];
    atoms_[index(b)].elements = kept;
  }

  // Neighbours that are eliminated, or in the new element like b itself.
  void drop_neighbours(int b) {
    const auto first = list_.begin() + begin_[index(b)], last = first + atoms_[index(b)].neighbours;
    const auto gone = [&](int c) { return atoms_[index(c)].done || atoms_[index(c)].mark == stamp_; };
    atoms_[index(b)].neighbours = static_cast<int>(std::remove_if(first, last, gone) - first);
  }

  int early_, leading_to_none_;
  double products_ = 0;
  Eliminated eliminated_;
  std::vector<int> list_, begin_, pool_, front_;
  std::vector<State> atoms_;
  int stamp_ = 0, unknowns_ = 0;
  int newest_ = -1, front_weight_ = 0;  // of the newest front: its pivot, and what its atoms weigh
  LeastFirst line_;
};

}  // namespace

std::vector<int> elimination_order(const Graph& graph) {
  constexpr int kSmall = 500;  // atoms: beyond, one order is enough to find
  constexpr int kLeadingToNone = 8;
  MinimumDegree later(graph, 1, 0);
  std::vector<int> best = later.order();
  if (graph.atoms() > kSmall) return best;
  double products = later.products();
  for (const int leading_to_none : {0, kLeadingToNone}) {
    MinimumDegree any_time(graph, 0, leading_to_none);
    std::vector<int> other = any_time.order();
    if (any_time.products() > products) continue;
    products = any_time.products();
    best = std::move(other);
  }
  return best;
}

}  // namespace poinsot::block
