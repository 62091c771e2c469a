#include "linsolve/block/schedule.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "linsolve/lanes.h"

namespace poinsot::block {
namespace {

int count(const std::vector<int>& v) {
  return static_cast<int>(v.size());
}

// A front while the tree is built, one for each atom at first; unknowns by their place in the order of atoms. Fronts
// that went into others have no pivots.
struct Node {
  int first = 0, pivots = 0;  // its own pivots come last, those of fronts that went into it before
  int others = 0, list = 0;   // number and start of its other unknowns
  int parent = -1, child = -1, last_child = -1, sibling = -1;
  int head = -1, next = -1;  // of the chain of fronts whose pivots are its own, and the one after this one there
};

// Estimated cycles of a front: a fixed part, its arithmetic, the traffic of its update matrix.
double cost(int p, int m) {
  constexpr double kFixed = 120, kFlop = 0.5, kTraffic = 1;
  const double pp = p, mm = m;
  return kFixed + kFlop * (0.7 * pp * pp * pp + 2 * pp * pp * mm + 2 * pp * mm * mm) + kTraffic * (pp + mm) * (pp + mm);
}

class Builder {
 public:
  Builder(const CscLayout& layout, const Graph& graph, std::span<const int> order)
      : layout_(layout), nodes_(order.size()), place_(index(layout.n)), owner_(index(layout.n)) {
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
  }

  bool build(Schedule& schedule) {
    find_structure();
    amalgamate();
    number(schedule);
    if (!lay_out(schedule)) return false;
    assign_values(schedule);
    name_others(schedule);
    return true;
  }

 private:
  // The others of every node: entries of the matrix beside its pivots, and what its children leave to it.
  void find_structure() {
    const Lists beside = Lists::collect(count_nodes(), [&](auto&& emit) {
      int last_owner = -1, last_place = -1;
      for (int j = 0; j < layout_.n; ++j)
        for (int k = layout_.start[index(j)]; k < layout_.start[index(j) + 1]; ++k) {
          const auto [first, second] = std::minmax(place_[index(j)], place_[index(layout_.row[index(k)])]);
          const int owner = owner_[index(first)];
          if (owner == owner_[index(second)] || (owner == last_owner && second == last_place)) continue;
          last_owner = owner, last_place = second;
          emit(owner, second);
        }
    });
    std::vector<int> all;
    for (int k = 0; k < count_nodes(); ++k) {
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

  int count_nodes() const { return static_cast<int>(nodes_.size()); }
  std::span<const int> others(const Node& node) const { return {other_.data() + node.list, index(node.others)}; }

  // Appends the siblings `first` to `last` to the children.
  void adopt(Node& parent, int first, int last) {
    (parent.child < 0 ? parent.child : nodes_[index(parent.last_child)].sibling) = first;
    parent.last_child = last;
  }

  // A child goes into its parent where one larger front is cheaper than two.
  void amalgamate() {
    constexpr int kMostPivots = 8;  // as far as kernels of fixed size go
    for (Node& node : nodes_) {
      int before = -1;
      for (int c = node.child; c >= 0;) {
        Node& child = nodes_[index(c)];
        const int p = child.pivots + node.pivots, m = node.others;
        if (p > kMostPivots || cost(p, m) > cost(child.pivots, child.others) + cost(node.pivots, m)) {
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

  // Postorder; positions.
  void number(Schedule& s) {
    std::vector<int> stack;
    for (int k = 0; k < count_nodes(); ++k)
      if (nodes_[index(k)].parent < 0 && nodes_[index(k)].pivots > 0) stack.push_back(k);
    std::vector<char> open(nodes_.size(), 0);
    while (!stack.empty()) {
      const int k = stack.back();
      if (!open[index(k)]) {
        open[index(k)] = 1;
        const auto size = static_cast<std::ptrdiff_t>(stack.size());
        for (int c = nodes_[index(k)].child; c >= 0; c = nodes_[index(c)].sibling) stack.push_back(c);
        std::reverse(stack.begin() + size, stack.end());
        continue;
      }
      stack.pop_back();
      postorder_.push_back(k);
    }
    front_of_.assign(nodes_.size(), -1);
    position_.assign(index(layout_.n), 0);
    s.unknown.clear();
    s.unknown.reserve(index(layout_.n));
    std::vector<int> length(nodes_.size());  // of each node's own pivots
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      length[k] = (k + 1 < nodes_.size() ? nodes_[k + 1].first : layout_.n) - nodes_[k].first;
    for (std::size_t f = 0; f < postorder_.size(); ++f) {
      front_of_[index(postorder_[f])] = static_cast<int>(f);
      for (int part = nodes_[index(postorder_[f])].head; part >= 0; part = nodes_[index(part)].next)
        for (int k = nodes_[index(part)].first, end = k + length[index(part)]; k < end; ++k) {
          position_[index(unknown_[index(k)])] = count(s.unknown);
          s.unknown.push_back(unknown_[index(k)]);
        }
    }
  }

  bool lay_out(Schedule& s) {
    s.n = layout_.n;
    s.fronts.clear(), s.other.clear(), s.stretches.clear(), s.children.clear();
    s.store_size = s.stack_size = s.factor_nonzeros = 0;
    s.largest_update = s.largest_pivots = s.largest_rows = 0;
    std::size_t entries = 0;
    for (const int k : postorder_) entries += index(nodes_[index(k)].others);
    s.fronts.reserve(postorder_.size()), s.other.reserve(entries);
    s.children.reserve(postorder_.size());
    std::int64_t top = 0;
    int first = 0;
    for (const int k : postorder_) {
      const Node& node = nodes_[index(k)];
      Front f{};
      f.pivots = node.pivots, f.others = node.others, f.rows = padded(f.others);
      f.first = first, first += f.pivots;
      f.list = count(s.other);
      for (const int other : others(node)) s.other.push_back(position_[index(unknown_[index(other)])]);
      std::sort(s.other.begin() + f.list, s.other.end());
      for (int child = node.child; child >= 0; child = nodes_[index(child)].sibling) {
        s.children.push_back(front_of_[index(child)]);
        const Front& c = s.fronts[index(front_of_[index(child)])];
        top -= std::int64_t{c.rows} * c.others;
      }
      f.children = count(s.children);
      f.update = top, top += std::int64_t{f.rows} * f.others;
      s.stack_size = std::max(s.stack_size, top);
      f.store = s.store_size;
      const std::int64_t size = std::int64_t{f.pivots} * (f.pivots + f.rows + f.others);
      if (size >= std::int64_t{1} << 24 || std::int64_t{f.rows} * f.others >= std::int64_t{1} << 24) return false;
      s.store_size += size;
      s.factor_nonzeros += std::int64_t{f.pivots} * (f.pivots + 2 * f.others);
      s.largest_update = std::max(s.largest_update, f.rows * f.others);
      s.largest_pivots = std::max(s.largest_pivots, f.pivots);
      s.largest_rows = std::max(s.largest_rows, f.rows);
      s.fronts.push_back(f);
    }
    // Places in the parent.
    std::vector<int> parent_of(s.fronts.size(), -1);
    for (std::size_t k = 0, c = 0; k < s.fronts.size(); ++k)
      for (; c < index(s.fronts[k].children); ++c) parent_of[index(s.children[c])] = static_cast<int>(k);
    for (std::size_t k = 0; k < s.fronts.size(); ++k) {
      Front& f = s.fronts[k];
      f.first_stretch = f.first_outer_stretch = f.last_stretch = static_cast<int>(s.stretches.size());
      if (f.others == 0) continue;
      const int parent = parent_of[k], pivots = s.fronts[index(parent)].pivots;
      int before = -2;
      for (int i = 0; i < f.others; ++i) {
        const int place = local(s, parent, s.other[index(f.list + i)]);
        const bool outer = place >= pivots;
        if (place != before + 1 || place == pivots) {
          s.stretches.push_back(
              {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(outer ? place - pivots : place), 0});
        }
        ++s.stretches.back().length;
        before = place;
        if (outer) continue;
        f.inner = i + 1;
        f.first_outer_stretch = static_cast<int>(s.stretches.size());
      }
      f.last_stretch = static_cast<int>(s.stretches.size());
    }
    s.stretches.shrink_to_fit();
    return true;
  }

  // Pivots come first, 0 to p − 1, then the others.
  static int local(const Schedule& s, int front, int position) {
    const Front& f = s.fronts[index(front)];
    if (position < f.first + f.pivots) return position - f.first;
    const auto begin = s.other.begin() + f.list, end = begin + f.others;
    return f.pivots + static_cast<int>(std::lower_bound(begin, end, position) - begin);
  }

  void assign_values(Schedule& s) {
    std::vector<int> front_at(index(s.n));
    for (std::size_t f = 0; f < s.fronts.size(); ++f)
      std::fill_n(front_at.begin() + s.fronts[f].first, s.fronts[f].pivots, static_cast<int>(f));

    // By front; short runs, nearly all there are, by their length: they are copied without a loop.
    constexpr int kKinds = std::tuple_size_v<decltype(Front::runs)>;
    const auto place_of = [&](int front, const Run& run) {
      return index(kKinds * front + std::min<int>(run.length, kKinds) - 1);
    };
    std::vector<int> next(kKinds * s.fronts.size() + 1, 0);
    visit_runs(s, front_at, [&](int front, const Run& run) { ++next[place_of(front, run) + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t f = 0; f < s.fronts.size(); ++f)
      std::copy_n(next.begin() + static_cast<std::ptrdiff_t>(kKinds * f + 1), kKinds, s.fronts[f].runs.begin());
    s.runs.assign(index(next.back()), Run{});
    visit_runs(s, front_at, [&](int front, const Run& run) { s.runs[index(next[place_of(front, run)]++)] = run; });
  }

  // Positions become unknowns.
  static void name_others(Schedule& s) {
    std::vector<int> named;
    std::size_t entries = 0;
    for (const Front& f : s.fronts) entries += index(f.rows);
    named.reserve(entries);
    for (Front& f : s.fronts) {
      const int* position = s.other.data() + f.list;
      f.list = count(named);
      for (int i = 0; i < f.rows; ++i)
        named.push_back(s.unknown[index(i < f.others ? position[i] : f.first + (i - f.others) % f.pivots)]);
    }
    s.other.swap(named);
  }

  // Calls visit(front, run) for stretches of the values that stay together in the store of a front.
  template <class Visit>
  void visit_runs(const Schedule& s, const std::vector<int>& front_at, Visit&& visit) const {
    int open = -1;  // front of the run at hand
    Run run{};
    for (int j = 0; j < layout_.n; ++j) {
      const int pj = position_[index(j)];
      for (int k = layout_.start[index(j)]; k < layout_.start[index(j) + 1]; ++k) {
        const int pi = position_[index(layout_.row[index(k)])];
        const int front = front_at[index(std::min(pi, pj))];
        const Front& f = s.fronts[index(front)];
        const int li = local(s, front, pi), lj = local(s, front, pj), p = f.pivots;
        int target = lj * p + li;
        if (li >= p) target = p * p + lj * f.rows + li - p;
        if (lj >= p) target = p * (p + f.rows) + (lj - p) * p + li;
        const int length = run.length;
        if (open == front && run.source + length == k && static_cast<int>(run.target) + length == target &&
            length < 255) {
          run.length = static_cast<std::uint8_t>(length + 1);
          continue;
        }
        if (open >= 0) visit(open, run);
        open = front;
        run = {k, static_cast<std::uint32_t>(target) & 0xffffffu, 1};
      }
    }
    if (open >= 0) visit(open, run);
  }

  const CscLayout& layout_;
  std::vector<Node> nodes_;
  std::vector<int> unknown_;  // by place
  std::vector<int> place_, owner_;
  std::vector<int> other_;  // by node: its other unknowns, ascending
  std::vector<int> postorder_, front_of_, position_;
};

}  // namespace

bool Schedule::build(const CscLayout& layout, const Graph& graph, std::span<const int> order) {
  return Builder(layout, graph, order).build(*this);
}

}  // namespace poinsot::block
