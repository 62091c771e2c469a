#include "linsolve/csc_layout.h"

#include <btf.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "core/check.h"

namespace poinsot {

LinearStatus CscLayout::build(const Pattern& pattern) {
  const auto size = [](int k) { return static_cast<std::size_t>(k); };
  n = pattern.n;

  std::int64_t block_columns = 0;
  for (const Block& b : pattern.blocks) block_columns += b.cols;
  const LinearStatus too_large{LinearFailure::refused, -1, "the matrix has more entries than 32-bit indices can count"};
  if (block_columns > std::numeric_limits<int>::max()) return too_large;

  // Row intervals [first, end) by column.
  std::vector<int> begin(size(n) + 1, 0);
  for (const Block& b : pattern.blocks)
    for (int c = 0; c < b.cols; ++c) ++begin[size(b.col + c) + 1];
  for (int j = 0; j < n; ++j) begin[size(j) + 1] += begin[size(j)];
  std::vector<std::pair<int, int>> interval(size(begin.back()));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const Block& b : pattern.blocks)
    for (int c = 0; c < b.cols; ++c) interval[size(next[size(b.col + c)]++)] = {b.row, b.row + b.rows};

  start.assign(1, 0);
  start.reserve(size(n) + 1);
  row.clear();
  for (int j = 0; j < n; ++j) {
    const auto first = interval.begin() + begin[size(j)], last = interval.begin() + begin[size(j) + 1];
    std::sort(first, last);
    int filled = 0;  // rows below this one are in
    for (auto it = first; it != last; ++it)
      for (filled = std::max(filled, it->first); filled < it->second; ++filled) row.push_back(filled);
    if (row.size() > size(std::numeric_limits<int>::max())) return too_large;
    start.push_back(static_cast<int>(row.size()));
  }
  row.shrink_to_fit();

  slots.clear();
  slots.reserve(size(begin.back()));
  for (const Block& b : pattern.blocks)
    for (int j = b.col; j < b.col + b.cols; ++j) {
      const auto first = row.begin() + start[size(j)], last = row.begin() + start[size(j) + 1];
      slots.push_back(static_cast<int>(std::lower_bound(first, last, b.row) - row.begin()));
    }
  return {};
}

LinearStatus CscLayout::matching() const {
  std::vector<int> match(static_cast<std::size_t>(n)), work(5 * static_cast<std::size_t>(n));
  double effort = 0;
  // BTF only reads the pattern, though its interface does not say so.
  const int rank = btf_maxtrans(n, n, const_cast<int*>(start.data()), const_cast<int*>(row.data()), 0, &effort,
                                match.data(), work.data());
  if (rank == n) return {};
  std::vector<char> matched(static_cast<std::size_t>(n), 0);
  for (const int column : match)
    if (column >= 0) matched[static_cast<std::size_t>(column)] = 1;
  const auto free = std::find(matched.begin(), matched.end(), 0);
  check(free != matched.end(), "a matching that is not perfect leaves a column out");
  return {LinearFailure::structurally_singular, static_cast<int>(free - matched.begin()),
          "the matrix is singular by its structure: rank at most " + std::to_string(rank) + " of " + std::to_string(n)};
}

}  // namespace poinsot
