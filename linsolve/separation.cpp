#include "linsolve/separation.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kNegligibleBeside = 1e-9;        // of a coefficient beside the largest of its vector
constexpr std::size_t kMostCombined = 2'000'000;  // entries: a second's work
constexpr double kGood = 0.1;                     // the least entry that a group's pivot is worth
constexpr double kBetter = 1.2;                   // of another pivot of the group, beside the one it has
constexpr int kPasses = 20;

class Separation {
 public:
  Separation(std::vector<SparseEntries>&& vectors, std::vector<int> pivots)
      : vectors_(std::move(vectors)), pivots_(std::move(pivots)) {
    std::size_t size = 0;
    int last = -1;
    for (const SparseEntries& z : vectors_) size += z.size(), last = std::max(last, z.back().first);
    too_long_ = size > kMostCombined;
    if (too_long_) return;
    having_.resize(index(last + 1));
    for (std::size_t k = 0; k < vectors_.size(); ++k)
      for (const auto& [column, value] : vectors_[k]) having_[index(column)].push_back(k);
  }

  bool too_long() const { return too_long_; }
  const std::vector<int>& pivots() const { return pivots_; }
  std::vector<int> take_pivots() { return std::move(pivots_); }

  void pivot_on_largest() {
    for (std::size_t k = 0; k < vectors_.size(); ++k) pivot_on(k, largest_of(k));
  }

  // Entries above `limit` become pivots.
  void flatten(double limit) {
    flatten([&](std::size_t k) {
      const auto best = largest_of(k);
      return std::abs(best.second) > limit ? best : kNone;
    });
  }
  // Vectors with entries above `own` take better pivots of their group, those with entries above `limit` that none of
  // the group is good for take others.
  void flatten(double own, double limit, std::span<const int> group) {
    flatten([&](std::size_t k) {
      const auto best = largest_of(k), other = largest_of(k, group, group[index(pivots_[k])]);
      const double size = std::abs(best.second);
      if (size > own && std::abs(other.second) > kBetter) return other;
      return size > std::max(own, limit) ? best : kNone;
    });
  }

  // Pivots by groups, in the order of how many these could have by themselves.
  void gather(const Grouped& grouped) {
    std::map<int, std::vector<int>> columns;  // by group
    for (std::size_t column = 0; column < having_.size(); ++column)
      if (!having_[column].empty()) columns[grouped.group[column]].push_back(static_cast<int>(column));
    struct Worth {
      int pivots, turn, group;
    };
    std::vector<Worth> order;
    for (const auto& [g, of] : columns)
      if (const int pivots = worth(of); pivots > 0) order.push_back({pivots, grouped.turn[index(of.front())], g});
    std::ranges::stable_sort(order, [](const Worth& a, const Worth& b) {
      return a.pivots != b.pivots ? a.pivots > b.pivots : a.turn < b.turn;
    });
    std::vector<char> settled(vectors_.size(), 0);
    std::size_t left = vectors_.size();
    for (const Worth& one : order) {
      while (left > 0) {
        std::size_t vector = 0;
        std::pair<int, double> best = kNone;
        for (const int column : columns[one.group])
          for (const std::size_t k : having_[index(column)])
            if (const double value = settled[k] ? 0 : find(vectors_[k], column);
                std::abs(value) > std::abs(best.second))
              vector = k, best = {column, value};
        if (!(std::abs(best.second) > kGood)) break;
        pivot_on(vector, best);
        settled[vector] = 1;
        --left;
      }
    }
  }

 private:
  static constexpr std::pair<int, double> kNone{-1, 0.0};

  // `pick` says which entry of a vector becomes its pivot.
  template <typename Pick>
  void flatten(Pick&& pick) {
    bool any = true;
    for (int pass = 0; pass < kPasses && any; ++pass) {
      any = false;
      for (std::size_t k = 0; k < vectors_.size(); ++k) {
        const std::pair<int, double> entry = pick(k);
        if (entry.first < 0) continue;
        pivot_on(k, entry);
        any = true;
      }
    }
  }

  static double find(const SparseEntries& z, int column) {
    const auto it = std::ranges::lower_bound(z, column, {}, &std::pair<int, double>::first);
    return it != z.end() && it->first == column ? it->second : 0.0;
  }
  // Among equals the last: what a scene lists later is what it says twice.
  std::pair<int, double> largest_of(std::size_t k) const {
    return *std::ranges::max_element(
        vectors_[k], [](const auto& x, const auto& y) { return 0.999 * std::abs(x.second) < std::abs(y.second); });
  }
  std::pair<int, double> largest_of(std::size_t k, std::span<const int> group, int of) const {
    std::pair<int, double> best = kNone;
    for (const auto& entry : vectors_[k])
      if (group[index(entry.first)] == of && entry.first != pivots_[k] &&
          std::abs(entry.second) >= std::abs(best.second))
        best = entry;
    return best;
  }

  // How many pivots above kGood the columns have, by elimination with complete pivoting.
  int worth(const std::vector<int>& columns) const {
    std::vector<std::size_t> with;
    for (const int column : columns) {
      const std::vector<std::size_t>& of = having_[index(column)];
      with.insert(with.end(), of.begin(), of.end());
    }
    std::ranges::sort(with);
    with.erase(std::unique(with.begin(), with.end()), with.end());
    Eigen::MatrixXd part(static_cast<Eigen::Index>(columns.size()), static_cast<Eigen::Index>(with.size()));
    part.setZero();
    for (Eigen::Index k = 0; k < part.cols(); ++k) {
      const SparseEntries& z = vectors_[with[static_cast<std::size_t>(k)]];
      auto entry = std::ranges::lower_bound(z, columns.front(), {}, &std::pair<int, double>::first);
      for (Eigen::Index i = 0; i < part.rows() && entry != z.end();) {
        const int column = columns[static_cast<std::size_t>(i)];
        if (entry->first == column) part(i, k) = entry->second;
        if (entry->first <= column)
          ++entry;
        else
          ++i;
      }
    }
    int pivots = 0;
    for (; pivots < std::min(part.rows(), part.cols()); ++pivots) {
      Eigen::Index i = 0, k = 0;
      if (!(part.cwiseAbs().maxCoeff(&i, &k) > kGood)) break;
      const Eigen::VectorXd column = part.col(k);
      part -= column * (part.row(i) / column[i]).eval();
    }
    return pivots;
  }

  void pivot_on(std::size_t k, std::pair<int, double> entry) {
    const auto [column, value] = entry;
    for (auto& one : vectors_[k]) one.second /= value;
    for (const std::size_t other : std::exchange(having_[index(column)], {k})) {
      const double factor = other == k ? 0 : find(vectors_[other], column);
      if (factor == 0) continue;
      gained_.clear();
      vectors_[other] = subtract(vectors_[other], factor, vectors_[k], column, &gained_);
      for (const int c : gained_) having_[index(c)].push_back(other);
    }
    pivots_[k] = column;
  }

  std::vector<SparseEntries> vectors_;
  std::vector<int> pivots_;
  std::vector<std::vector<std::size_t>> having_;  // by column: vectors that have or had it
  std::vector<int> gained_;
  bool too_long_ = false;
};

Separation begin(std::vector<SparseEntries>&& vectors) {
  std::vector<int> ends;
  for (const SparseEntries& z : vectors) ends.push_back(z.back().first);
  Separation separation(std::move(vectors), std::move(ends));
  if (!separation.too_long()) {
    separation.pivot_on_largest();
    separation.flatten(kFlat);
  }
  return separation;
}

}  // namespace

double largest(const SparseEntries& z) {
  double size = 0;
  for (const auto& [k, value] : z) size = std::max(size, std::abs(value));
  return size;
}

void drop_nothing(SparseEntries& z) {
  const double nothing = kNegligibleBeside * largest(z);
  std::erase_if(z, [&](const auto& entry) { return std::abs(entry.second) <= nothing; });
}

SparseEntries subtract(const SparseEntries& x, double factor, const SparseEntries& y, int gone,
                       std::vector<int>* gained) {
  // Most of what a choice of joints costs in a large mechanism: the sum is written in place, and what is negligible in
  // it is left out as the largest entry is known.
  SparseEntries sum(x.size() + y.size());
  auto* to = sum.data();
  double size = 0;
  const auto take = [&](int column, double value) {
    if (column == gone) return;
    size = std::max(size, std::abs(value));
    *to++ = {column, value};
  };
  const auto take_new = [&](int column, double value) {
    if (gained) gained->push_back(column);
    take(column, value);
  };
  const auto *a = x.data(), *a_end = a + x.size(), *b = y.data(), *b_end = b + y.size();
  while (a != a_end && b != b_end) {
    if (a->first < b->first)
      take(a->first, a->second), ++a;
    else if (b->first < a->first)
      take_new(b->first, -factor * b->second), ++b;
    else
      take(a->first, a->second - factor * b->second), ++a, ++b;
  }
  for (; a != a_end; ++a) take(a->first, a->second);
  for (; b != b_end; ++b) take_new(b->first, -factor * b->second);
  const double nothing = kNegligibleBeside * size;
  auto* kept = sum.data();
  for (const auto* one = kept; one != to; ++one)
    if (std::abs(one->second) > nothing) *kept++ = *one;
  sum.resize(static_cast<std::size_t>(kept - sum.data()));
  return sum;
}

std::vector<int> separate(std::vector<SparseEntries>&& vectors) {
  return begin(std::move(vectors)).take_pivots();
}

std::vector<int> gather(std::vector<SparseEntries>&& vectors, const Grouped& columns) {
  Separation separation = begin(std::move(vectors));
  if (!separation.too_long()) {
    separation.gather(columns);
    separation.flatten(kGathered, kGathered, columns.group);
  }
  return separation.take_pivots();
}

void repair(std::vector<SparseEntries>&& vectors, std::vector<int>& pivots, const Grouped& columns, double most,
            double of_all) {
  const auto of_group = [&](int column) { return columns.group[index(column)]; };
  const std::vector<int> before = pivots;
  Separation separation(std::move(vectors), std::move(pivots));
  if (!separation.too_long()) {
    separation.flatten(most, of_all, columns.group);
    if (!std::ranges::equal(before, separation.pivots(), {}, of_group, of_group)) {
      separation.gather(columns);
      separation.flatten(most, of_all, columns.group);
    }
  }
  pivots = separation.take_pivots();
}

}  // namespace poinsot
