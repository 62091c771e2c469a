#include "linsolve/sparse_ldlt.h"

#include <amd.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/check.h"

namespace poinsot {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

// Columns of the pattern that the cliques make, rows sorted, each once; of all pairs or of those keep(row, column).
template <class Keep>
void columns_of(int n, std::span<const int> clique_start, std::span<const int> member, Keep&& keep,
                std::vector<int>& start, std::vector<int>& row) {
  std::vector<std::pair<int, int>> entries;  // column, row
  for (std::size_t c = 0; c + 1 < clique_start.size(); ++c)
    for (int a = clique_start[c]; a < clique_start[c + 1]; ++a)
      for (int b = clique_start[c]; b < clique_start[c + 1]; ++b)
        if (keep(member[at(a)], member[at(b)])) entries.emplace_back(member[at(b)], member[at(a)]);
  std::ranges::sort(entries);
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  start.assign(at(n) + 1, 0);
  row.clear();
  for (const auto& [j, i] : entries) ++start[at(j) + 1], row.push_back(i);
  for (int j = 0; j < n; ++j) start[at(j) + 1] += start[at(j)];
}

}  // namespace

bool SparseLdlt::analyze(int n, std::span<const int> clique_start, std::span<const int> member) {
  n_ = n;
  columns_of(
      n, clique_start, member, [](int, int) { return true; }, start_, row_);
  order_.assign(at(n), 0);
  const int status = amd_order(n, start_.data(), row_.data(), order_.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  check(status == AMD_OK, "AMD orders the pattern of a symmetric matrix");

  std::vector<int> position(at(n)), permuted(member.size());
  for (int k = 0; k < n; ++k) position[at(order_[at(k)])] = k;
  std::ranges::transform(member, permuted.begin(), [&](int k) { return position[at(k)]; });
  columns_of(
      n, clique_start, permuted, [](int i, int j) { return i <= j; }, start_, row_);
  places_.clear();
  for (std::size_t c = 0; c + 1 < clique_start.size(); ++c)
    for (int b = clique_start[c]; b < clique_start[c + 1]; ++b)
      for (int a = b; a < clique_start[c + 1]; ++a) {
        const auto [i, j] = std::minmax(permuted[at(a)], permuted[at(b)]);
        const auto first = row_.begin() + start_[at(j)], last = row_.begin() + start_[at(j) + 1];
        places_.push_back(static_cast<int>(std::lower_bound(first, last, i) - row_.begin()));
      }
  values_.assign(row_.size(), 0);
  return find_structure();
}

// The elimination tree and the lengths of L's columns.
bool SparseLdlt::find_structure() {
  parent_.assign(at(n_), -1), mark_.assign(at(n_), -1);
  std::vector<int> count(at(n_), 0);
  for (int k = 0; k < n_; ++k) {
    mark_[at(k)] = k;
    for (int p = start_[at(k)]; p < start_[at(k) + 1]; ++p)
      for (int i = row_[at(p)]; mark_[at(i)] != k; i = parent_[at(i)]) {
        if (parent_[at(i)] < 0) parent_[at(i)] = k;
        ++count[at(i)];
        mark_[at(i)] = k;
      }
  }
  l_start_.assign(1, 0);
  std::int64_t sum = 0;
  for (const int c : count) {
    sum += c;
    if (sum > std::numeric_limits<int>::max()) return false;
    l_start_.push_back(static_cast<int>(sum));
  }
  l_row_.assign(at(l_start_.back()), 0), l_.assign(at(l_start_.back()), 0);
  filled_.assign(at(n_), 0), pattern_.assign(at(n_), 0);
  d_.assign(at(n_), 0), y_.assign(at(n_), 0);
  return true;
}

void SparseLdlt::factor() {
  std::ranges::fill(mark_, -1);
  for (int k = 0; k < n_; ++k) {
    // Row k of L is nonzero where the paths from the column's rows up to k lead.
    int top = n_;
    mark_[at(k)] = k;
    filled_[at(k)] = 0;
    for (int p = start_[at(k)]; p < start_[at(k) + 1]; ++p) {
      int i = row_[at(p)], length = 0;
      y_[at(i)] += values_[at(p)];
      for (; mark_[at(i)] != k; i = parent_[at(i)]) pattern_[at(length++)] = i, mark_[at(i)] = k;
      while (length > 0) pattern_[at(--top)] = pattern_[at(--length)];
    }
    double d = std::exchange(y_[at(k)], 0);
    for (; top < n_; ++top) {
      const int i = pattern_[at(top)];
      const double yi = std::exchange(y_[at(i)], 0);
      const int end = l_start_[at(i)] + filled_[at(i)]++;
      for (int p = l_start_[at(i)]; p < end; ++p) y_[at(l_row_[at(p)])] -= l_[at(p)] * yi;
      const double l = yi / d_[at(i)];
      d -= l * yi;
      l_row_[at(end)] = k, l_[at(end)] = l;
    }
    d_[at(k)] = d;
  }
}

int SparseLdlt::cancelled(double part) const {
  for (int k = 0; k < n_; ++k)  // the diagonal entry is the last of its column
    if (!(d_[at(k)] > part * values_[at(start_[at(k) + 1] - 1)])) return order_[at(k)];
  return -1;
}

void SparseLdlt::solve(std::span<double> b) {
  for (int k = 0; k < n_; ++k) y_[at(k)] = b[at(order_[at(k)])];
  for (int k = 0; k < n_; ++k)
    for (int p = l_start_[at(k)]; p < l_start_[at(k) + 1]; ++p) y_[at(l_row_[at(p)])] -= l_[at(p)] * y_[at(k)];
  for (int k = n_ - 1; k >= 0; --k) {
    double x = y_[at(k)] / d_[at(k)];
    for (int p = l_start_[at(k)]; p < l_start_[at(k) + 1]; ++p) x -= l_[at(p)] * y_[at(l_row_[at(p)])];
    y_[at(k)] = x;
  }
  for (int k = 0; k < n_; ++k) b[at(order_[at(k)])] = std::exchange(y_[at(k)], 0);
}

}  // namespace poinsot
