#include "linsolve/sparse_ldlt.h"

#include <amd.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/check.h"
#include "core/index.h"

namespace poinsot {
namespace {

// Columns of the pattern that the cliques make, rows sorted, each once; of all pairs or of those keep(row, column).
template <class Keep>
void columns_of(int n, std::span<const int> clique_start, std::span<const int> member, Keep&& keep,
                std::vector<int>& start, std::vector<int>& row) {
  std::vector<std::pair<int, int>> entries;  // column, row
  for (std::size_t c = 0; c + 1 < clique_start.size(); ++c)
    for (int a = clique_start[c]; a < clique_start[c + 1]; ++a)
      for (int b = clique_start[c]; b < clique_start[c + 1]; ++b)
        if (keep(member[index(a)], member[index(b)])) entries.emplace_back(member[index(b)], member[index(a)]);
  std::ranges::sort(entries);
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  start.assign(index(n) + 1, 0);
  row.clear();
  for (const auto& [j, i] : entries) ++start[index(j) + 1], row.push_back(i);
  for (int j = 0; j < n; ++j) start[index(j) + 1] += start[index(j)];
}

}  // namespace

bool SparseLdlt::analyze(int n, std::span<const int> clique_start, std::span<const int> member) {
  n_ = n;
  columns_of(
      n, clique_start, member, [](int, int) { return true; }, start_, row_);
  order_.assign(index(n), 0);
  const int status = amd_order(n, start_.data(), row_.data(), order_.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  check(status == AMD_OK, "AMD orders the pattern of a symmetric matrix");

  std::vector<int> position(index(n)), permuted(member.size());
  for (int k = 0; k < n; ++k) position[index(order_[index(k)])] = k;
  std::ranges::transform(member, permuted.begin(), [&](int k) { return position[index(k)]; });
  columns_of(
      n, clique_start, permuted, [](int i, int j) { return i <= j; }, start_, row_);
  places_.clear();
  for (std::size_t c = 0; c + 1 < clique_start.size(); ++c)
    for (int b = clique_start[c]; b < clique_start[c + 1]; ++b)
      for (int a = b; a < clique_start[c + 1]; ++a) {
        const auto [i, j] = std::minmax(permuted[index(a)], permuted[index(b)]);
        const auto first = row_.begin() + start_[index(j)], last = row_.begin() + start_[index(j) + 1];
        places_.push_back(static_cast<int>(std::lower_bound(first, last, i) - row_.begin()));
      }
  values_.assign(row_.size(), 0);
  return find_structure();
}

// The elimination tree and the lengths of L's columns.
bool SparseLdlt::find_structure() {
  parent_.assign(index(n_), -1), mark_.assign(index(n_), -1);
  std::vector<int> count(index(n_), 0);
  for (int k = 0; k < n_; ++k) {
    mark_[index(k)] = k;
    for (int p = start_[index(k)]; p < start_[index(k) + 1]; ++p)
      for (int i = row_[index(p)]; mark_[index(i)] != k; i = parent_[index(i)]) {
        if (parent_[index(i)] < 0) parent_[index(i)] = k;
        ++count[index(i)];
        mark_[index(i)] = k;
      }
  }
  l_start_.assign(1, 0);
  std::int64_t sum = 0;
  for (const int c : count) {
    sum += c;
    if (sum > std::numeric_limits<int>::max()) return false;
    l_start_.push_back(static_cast<int>(sum));
  }
  l_row_.assign(index(l_start_.back()), 0), l_.assign(index(l_start_.back()), 0);
  filled_.assign(index(n_), 0), pattern_.assign(index(n_), 0);
  d_.assign(index(n_), 0), y_.assign(index(n_), 0);
  return true;
}

void SparseLdlt::factor() {
  std::ranges::fill(mark_, -1);
  for (int k = 0; k < n_; ++k) {
    // Row k of L is nonzero where the paths from the column's rows up to k lead.
    int top = n_;
    mark_[index(k)] = k;
    filled_[index(k)] = 0;
    for (int p = start_[index(k)]; p < start_[index(k) + 1]; ++p) {
      int i = row_[index(p)], length = 0;
      y_[index(i)] += values_[index(p)];
      for (; mark_[index(i)] != k; i = parent_[index(i)]) pattern_[index(length++)] = i, mark_[index(i)] = k;
      while (length > 0) pattern_[index(--top)] = pattern_[index(--length)];
    }
    double d = std::exchange(y_[index(k)], 0);
    for (; top < n_; ++top) {
      const int i = pattern_[index(top)];
      const double yi = std::exchange(y_[index(i)], 0);
      const int end = l_start_[index(i)] + filled_[index(i)]++;
      for (int p = l_start_[index(i)]; p < end; ++p) y_[index(l_row_[index(p)])] -= l_[index(p)] * yi;
      const double l = yi / d_[index(i)];
      d -= l * yi;
      l_row_[index(end)] = k, l_[index(end)] = l;
    }
    d_[index(k)] = d;
  }
}

int SparseLdlt::cancelled(double part) const {
  for (int k = 0; k < n_; ++k)  // the diagonal entry is the last of its column
    if (!(d_[index(k)] > part * values_[index(start_[index(k) + 1] - 1)])) return order_[index(k)];
  return -1;
}

void SparseLdlt::solve(std::span<double> b) {
  for (int k = 0; k < n_; ++k) y_[index(k)] = b[index(order_[index(k)])];
  for (int k = 0; k < n_; ++k)
    for (int p = l_start_[index(k)]; p < l_start_[index(k) + 1]; ++p)
      y_[index(l_row_[index(p)])] -= l_[index(p)] * y_[index(k)];
  for (int k = n_ - 1; k >= 0; --k) {
    double x = y_[index(k)] / d_[index(k)];
    for (int p = l_start_[index(k)]; p < l_start_[index(k) + 1]; ++p) x -= l_[index(p)] * y_[index(l_row_[index(p)])];
    y_[index(k)] = x;
  }
  for (int k = 0; k < n_; ++k) b[index(order_[index(k)])] = std::exchange(y_[index(k)], 0);
}

}  // namespace poinsot
