#include "linsolve/block/schedule.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "linsolve/block/front_tree.h"
#include "linsolve/lanes.h"

namespace poinsot::block {
namespace {

class Builder {
 public:
  Builder(const CscLayout& layout, const Graph& graph, std::span<const int> order, Fronts kind)
      : layout_(layout), tree_(std::in_place, layout, graph, order, kind), postorder_(tree_->postorder()) {}

  bool build(Schedule& schedule) {
    number(schedule);
    if (!lay_out(schedule)) return false;
    tree_.reset();  // its room is that of the strips
    assign_values(schedule);
    pad_others(schedule);
    return true;
  }

 private:
  void number(Schedule& s) {
    const FrontTree& tree = *tree_;
    front_of_.assign(index(tree.size()), -1);
    position_.assign(index(layout_.n), 0);
    s.unknown.clear();
    s.unknown.reserve(index(layout_.n));
    for (std::size_t f = 0; f < postorder_.size(); ++f) {
      front_of_[index(postorder_[f])] = static_cast<int>(f);
      tree.pivots(tree[postorder_[f]], [&](int unknown) {
        position_[index(unknown)] = count(s.unknown);
        s.unknown.push_back(unknown);
      });
    }
  }

  bool lay_out(Schedule& s) {
    s.n = layout_.n;
    s.fronts.clear(), s.other.clear(), s.stretches.clear(), s.children.clear();
    s.store_size = s.stack_size = s.factor_nonzeros = 0;
    s.largest_update = s.largest_pivots = s.largest_rows = 0;
    const FrontTree& tree = *tree_;
    std::size_t entries = 0;
    for (const int k : postorder_) entries += index(tree[k].others);
    s.fronts.reserve(postorder_.size()), s.other.reserve(entries);
    s.children.reserve(postorder_.size());
    std::int64_t top = 0;
    int first = 0;
    for (const int k : postorder_) {
      const FrontTree::Node& node = tree[k];
      Front f{};
      f.pivots = node.pivots, f.others = node.others, f.rows = padded(f.others);
      f.first = first, first += f.pivots;
      f.list = count(s.other);
      for (const int other : tree.others(node)) s.other.push_back(position_[index(tree.unknown(other))]);
      std::sort(s.other.begin() + f.list, s.other.end());
      for (int child = node.child; child >= 0; child = tree[child].sibling) {
        s.children.push_back(front_of_[index(child)]);
        const Front& c = s.fronts[index(front_of_[index(child)])];
        top -= std::int64_t{c.rows} * c.others;
      }
      f.children = count(s.children);
      f.update = top, top += std::int64_t{f.rows} * f.others;
      s.stack_size = std::max(s.stack_size, top);

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

    // By front; short strips, nearly all there are, by their length: they are copied without a loop.
    constexpr int kKinds = std::tuple_size_v<decltype(Front::strips)>;
    const auto place_of = [&](int front, const Strip& strip) {
      return index(kKinds * front + std::min<int>(strip.length, kKinds) - 1);
    };
    std::vector<int> next(kKinds * s.fronts.size() + 1, 0);
    std::vector<std::pair<int, Strip>> strips;  // and their fronts
    strips.reserve(index(layout_.nonzeros()));
    visit_strips(s, front_at, [&](int front, const Strip& strip) {
      ++next[place_of(front, strip) + 1];
      strips.emplace_back(front, strip);
    });
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t f = 0; f < s.fronts.size(); ++f)
      std::copy_n(next.begin() + static_cast<std::ptrdiff_t>(kKinds * f + 1), kKinds, s.fronts[f].strips.begin());
    s.strips.assign(strips.size(), Strip{});
    for (const auto& [front, strip] : strips) s.strips[index(next[place_of(front, strip)]++)] = strip;
  }

  // The padding rows get positions, too.
  static void pad_others(Schedule& s) {
    std::vector<int> padded;
    std::size_t entries = 0;
    for (const Front& f : s.fronts) entries += index(f.rows);
    padded.reserve(entries);
    for (Front& f : s.fronts) {
      const int* position = s.other.data() + f.list;
      f.list = count(padded);
      for (int i = 0; i < f.rows; ++i)
        padded.push_back(i < f.others ? position[i] : f.first + (i - f.others) % f.pivots);
    }
    s.other.swap(padded);
  }

  // Calls visit(front, strip) for stretches of the values that stay together in the store of a front.
  template <class Visit>
  void visit_strips(const Schedule& s, const std::vector<int>& front_at, Visit&& visit) const {
    int open = -1;  // front of the strip at hand
    Strip strip{};
    for (int j = 0; j < layout_.n; ++j) {
      const int pj = position_[index(j)];
      int lj = 0, li = -1, of = -1;  // the column in the front at hand, and the row before
      for (int k = layout_.start[index(j)]; k < layout_.start[index(j) + 1]; ++k) {
        const int pi = position_[index(layout_.row[index(k)])];
        const int front = front_at[index(std::min(pi, pj))];
        const Front& f = s.fronts[index(front)];
        const int p = f.pivots;
        const bool follows =
            front == of && li + 1 >= p && li + 1 < p + f.others && s.other[index(f.list + li + 1 - p)] == pi;
        if (front != of) lj = local(s, front, pj), of = front;
        li = follows ? li + 1 : local(s, front, pi);
        int target = p * f.others + lj * p + li;
        if (li >= p) target = p * (f.others + p) + lj * f.rows + li - p;
        if (lj >= p) target = (lj - p) * p + li;
        const int length = strip.length;
        if (open == front && strip.source + length == k && static_cast<int>(strip.target) + length == target &&
            length < 255) {
          strip.length = static_cast<std::uint8_t>(length + 1);
          continue;
        }
        if (open >= 0) visit(open, strip);
        open = front;
        strip = {k, static_cast<std::uint32_t>(target) & 0xffffffu, 1};
      }
    }
    if (open >= 0) visit(open, strip);
  }

  const CscLayout& layout_;
  std::optional<FrontTree> tree_;
  std::vector<int> postorder_, front_of_, position_;
};

}  // namespace

bool Schedule::build(const CscLayout& layout, const Graph& graph, std::span<const int> order, Fronts kind) {
  return Builder(layout, graph, order, kind).build(*this);
}

}  // namespace poinsot::block
