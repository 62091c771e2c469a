#include "linsolve/block_schedule.h"

#include <algorithm>
#include <numeric>

namespace poinsot {
namespace {

std::size_t at(std::int64_t k) {
  return static_cast<std::size_t>(k);
}
int count(const std::vector<int>& v) {
  return static_cast<int>(v.size());
}

// A front while the tree is built; unknowns by their place in the order of atoms.
struct Node {
  std::vector<int> pivots, others;
  int parent = -1;
};

// Estimated cycles of a front: a fixed part, its arithmetic, the traffic of its update matrix.
double cost(int p, int m) {
  constexpr double kFixed = 120, kFlop = 0.5, kTraffic = 1;
  const double pp = p, mm = m;
  return kFixed + kFlop * (0.7 * pp * pp * pp + 2 * pp * pp * mm + 2 * pp * mm * mm) + kTraffic * (pp + mm) * (pp + mm);
}

class Builder {
 public:
  Builder(const CscLayout& layout, const BlockGraph& graph, std::span<const int> order)
      : layout_(layout), nodes_(order.size()), place_(at(layout.n)), owner_(at(layout.n)) {
    int next = 0;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (const int u : graph.atoms[at(order[k])].unknowns) {
        unknown_.push_back(u);
        owner_[at(next)] = static_cast<int>(k);
        nodes_[k].pivots.push_back(next);
        place_[at(u)] = next++;
      }
  }

  bool build(Schedule& schedule) {
    find_structure();
    amalgamate();
    number(schedule);
    if (!lay_out(schedule)) return false;
    assign_values(schedule);
    return true;
  }

 private:
  // The others of every node: entries of the matrix beside its pivots, and what its children leave to it.
  void find_structure() {
    for (int j = 0; j < layout_.n; ++j)
      for (int k = layout_.start[at(j)]; k < layout_.start[at(j) + 1]; ++k) {
        const auto [first, second] = std::minmax(place_[at(j)], place_[at(layout_.row[at(k)])]);
        if (owner_[at(first)] != owner_[at(second)]) nodes_[at(owner_[at(first)])].others.push_back(second);
      }
    for (Node& node : nodes_) {
      std::ranges::sort(node.others);
      node.others.erase(std::unique(node.others.begin(), node.others.end()), node.others.end());
      if (node.others.empty()) continue;
      node.parent = owner_[at(node.others[0])];
      Node& parent = nodes_[at(node.parent)];
      for (const int k : node.others)
        if (owner_[at(k)] != node.parent) parent.others.push_back(k);
      node.others.shrink_to_fit();
    }
  }

  // A child goes into its parent where one larger front is cheaper than two.
  void amalgamate() {
    constexpr int kMostPivots = 8;  // as far as kernels of fixed size go
    std::vector<std::vector<int>> children(nodes_.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      Node& node = nodes_[k];
      for (std::size_t c = 0; c < children[k].size(); ++c) {
        Node& child = nodes_[at(children[k][c])];
        const int p = count(child.pivots) + count(node.pivots), m = count(node.others);
        if (p > kMostPivots ||
            cost(p, m) > cost(count(child.pivots), count(child.others)) + cost(count(node.pivots), m))
          continue;
        node.pivots.insert(node.pivots.begin(), child.pivots.begin(), child.pivots.end());
        const int gone = children[k][c];
        child = Node();
        children[k].insert(children[k].end(), children[at(gone)].begin(), children[at(gone)].end());
        children[k].erase(children[k].begin() + static_cast<std::ptrdiff_t>(c--));
        std::vector<int>().swap(children[at(gone)]);
      }
      if (node.parent >= 0) children[at(node.parent)].push_back(static_cast<int>(k));
    }
    children_ = std::move(children);
  }

  // Postorder; positions.
  void number(Schedule& s) {
    std::vector<int> stack;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if (nodes_[k].parent < 0 && !nodes_[k].pivots.empty()) stack.push_back(static_cast<int>(k));
    std::vector<char> open(nodes_.size(), 0);
    while (!stack.empty()) {
      const int k = stack.back();
      if (!open[at(k)]) {
        open[at(k)] = 1;
        stack.insert(stack.end(), children_[at(k)].rbegin(), children_[at(k)].rend());
        continue;
      }
      stack.pop_back();
      postorder_.push_back(k);
    }
    front_of_.assign(nodes_.size(), -1);
    position_.assign(at(layout_.n), 0);
    s.unknown.clear();
    for (std::size_t f = 0; f < postorder_.size(); ++f) {
      front_of_[at(postorder_[f])] = static_cast<int>(f);
      for (const int k : nodes_[at(postorder_[f])].pivots) {
        position_[at(unknown_[at(k)])] = static_cast<int>(s.unknown.size());
        s.unknown.push_back(unknown_[at(k)]);
      }
    }
  }

  bool lay_out(Schedule& s) {
    s.n = layout_.n;
    s.fronts.clear(), s.position.clear(), s.target.clear(), s.children.clear();
    s.store_size = s.stack_size = s.factor_nonzeros = 0;
    s.largest_update = s.largest_pivots = s.largest_rows = 0;
    std::int64_t top = 0;
    int first = 0;
    for (const int k : postorder_) {
      const Node& node = nodes_[at(k)];
      Front f{};
      f.pivots = count(node.pivots), f.others = count(node.others), f.rows = padded(f.others);
      f.first = first, first += f.pivots;
      f.list = count(s.position);
      for (const int other : node.others) s.position.push_back(position_[at(unknown_[at(other)])]);
      std::sort(s.position.begin() + f.list, s.position.end());
      for (const int child : children_[at(k)]) {
        s.children.push_back(front_of_[at(child)]);
        const Front& c = s.fronts[at(front_of_[at(child)])];
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
      for (; c < at(s.fronts[k].children); ++c) parent_of[at(s.children[c])] = static_cast<int>(k);
    s.target.resize(s.position.size());
    for (std::size_t k = 0; k < s.fronts.size(); ++k) {
      Front& f = s.fronts[k];
      if (f.others == 0) continue;
      const int parent = parent_of[k];
      for (int i = 0; i < f.others; ++i) {
        const int position = s.position[at(f.list + i)];
        const int place = local(s, parent, position);
        const int pivots = s.fronts[at(parent)].pivots;
        if (place < pivots) f.inner = i + 1;
        s.target[at(f.list + i)] = place < pivots ? place : place - pivots;
      }
      f.in_a_row = true;
      for (int i = 1; i < f.others; ++i)
        if (i != f.inner && s.target[at(f.list + i)] != s.target[at(f.list + i - 1)] + 1) f.in_a_row = false;
    }
    s.position.shrink_to_fit(), s.target.shrink_to_fit(), s.fronts.shrink_to_fit();
    return true;
  }

  // Pivots come first, 0 to p − 1, then the others.
  static int local(const Schedule& s, int front, int position) {
    const Front& f = s.fronts[at(front)];
    if (position < f.first + f.pivots) return position - f.first;
    const auto begin = s.position.begin() + f.list, end = begin + f.others;
    return f.pivots + static_cast<int>(std::lower_bound(begin, end, position) - begin);
  }

  void assign_values(Schedule& s) {
    std::vector<int> front_at(at(s.n));
    for (std::size_t f = 0; f < s.fronts.size(); ++f)
      std::fill_n(front_at.begin() + s.fronts[f].first, s.fronts[f].pivots, static_cast<int>(f));

    struct Placed {
      int front;
      Run run;
    };
    std::vector<Placed> placed;
    for (int j = 0; j < layout_.n; ++j) {
      const int pj = position_[at(j)];
      for (int k = layout_.start[at(j)]; k < layout_.start[at(j) + 1]; ++k) {
        const int pi = position_[at(layout_.row[at(k)])];
        const int front = front_at[at(std::min(pi, pj))];
        const Front& f = s.fronts[at(front)];
        const int li = local(s, front, pi), lj = local(s, front, pj), p = f.pivots;
        int target = lj * p + li;
        if (li >= p) target = p * p + lj * f.rows + li - p;
        if (lj >= p) target = p * (p + f.rows) + (lj - p) * p + li;
        if (!placed.empty()) {
          Placed& last = placed.back();
          const int length = last.run.length;
          if (last.front == front && last.run.source + length == k &&
              static_cast<int>(last.run.target) + length == target && length < 255) {
            last.run.length = static_cast<std::uint8_t>(length + 1);
            continue;
          }
        }
        placed.push_back({front, {k, static_cast<std::uint32_t>(target) & 0xffffffu, 1}});
      }
    }
    // By front; runs of 3 and 4, nearly all there are, first: they are copied without a loop.
    const auto kind = [](const Run& run) { return run.length == 3 ? 0 : run.length == 4 ? 1 : 2; };
    std::vector<int> next(3 * s.fronts.size() + 1, 0);
    for (const Placed& p : placed) ++next[at(3 * p.front + kind(p.run)) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t f = 0; f < s.fronts.size(); ++f) {
      s.fronts[f].threes = next[3 * f + 1];
      s.fronts[f].fours = next[3 * f + 2];
      s.fronts[f].runs = next[3 * f + 3];
    }
    s.runs.assign(placed.size(), Run{});
    for (const Placed& p : placed) s.runs[at(next[at(3 * p.front + kind(p.run))]++)] = p.run;
  }

  const CscLayout& layout_;
  std::vector<Node> nodes_;
  std::vector<int> unknown_;  // by place
  std::vector<int> place_, owner_;
  std::vector<std::vector<int>> children_;
  std::vector<int> postorder_, front_of_, position_;
};

}  // namespace

bool Schedule::build(const CscLayout& layout, const BlockGraph& graph, std::span<const int> order) {
  return Builder(layout, graph, order).build(*this);
}

}  // namespace poinsot
