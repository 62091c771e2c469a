#include "linsolve/column_dependencies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "linsolve/front_qr.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int kWide = 300;            // entries of a row that fronts do without
constexpr double kNegligible = 1e-9;  // of a coefficient beside the largest of its vector
constexpr double kMentioned = 1e-6;   // of a coefficient beside that of the dependent column

double largest(const SparseEntries& z) {
  double size = 0;
  for (const auto& [index, value] : z) size = std::max(size, std::abs(value));
  return size;
}

void drop_nothing(SparseEntries& z) {
  const double nothing = kNegligible * largest(z);
  std::erase_if(z, [&](const auto& entry) { return std::abs(entry.second) <= nothing; });
}

// x − factor y without entry `gone` and what is nothing beside the rest.
SparseEntries subtract(const SparseEntries& x, double factor, const SparseEntries& y, int gone) {
  SparseEntries sum;
  auto a = x.begin();
  auto b = y.begin();
  while (a != x.end() || b != y.end()) {
    if (b == y.end() || (a != x.end() && a->first < b->first)) {
      sum.push_back(*a++);
    } else {
      sum.emplace_back(b->first, -factor * b->second);
      if (a != x.end() && a->first == b->first) sum.back().second += (a++)->second;
      ++b;
    }
  }
  std::erase_if(sum, [&](const auto& entry) { return entry.first == gone; });
  drop_nothing(sum);
  return sum;
}

// A z at the wide rows, as entries behind those of the columns: combined like them, and zero for a null vector of A.
void append_wide_rows(const Sparse& A, const std::vector<int>& wide, SparseEntries& z) {
  std::map<int, double> sums;
  for (const auto& [column, value] : z)
    for (Sparse::InnerIterator it(A, column); it; ++it)
      if (const int k = wide[static_cast<std::size_t>(it.row())]; k >= 0) sums[k] += it.value() * value;
  const double nothing = kNegligible * largest(z);
  for (const auto& [k, sum] : sums)
    if (std::abs(sum) > nothing) z.emplace_back(static_cast<int>(A.cols()) + k, sum);
}

// Combines the vectors until each ends at an index of its own, which becomes its key.
std::map<int, SparseEntries> echelon(std::vector<SparseEntries> vectors) {
  std::map<int, std::vector<SparseEntries>> by_last;
  const auto sort_in = [&](SparseEntries&& z) {
    if (!z.empty()) by_last[z.back().first].push_back(std::move(z));
  };
  for (SparseEntries& z : vectors) sort_in(std::move(z));
  std::map<int, SparseEntries> ends;
  while (!by_last.empty()) {
    auto node = by_last.extract(std::prev(by_last.end()));
    const int last = node.key();
    std::vector<SparseEntries>& same = node.mapped();
    const auto share = [](const SparseEntries& z) { return std::abs(z.back().second) / largest(z); };
    const auto best = std::max_element(
        same.begin(), same.end(), [&](const SparseEntries& x, const SparseEntries& y) { return share(x) < share(y); });
    std::iter_swap(same.begin(), best);
    for (std::size_t k = 1; k < same.size(); ++k)
      sort_in(subtract(same[k], same[k].back().second / same[0].back().second, same[0], last));
    ends.emplace(last, std::move(same[0]));
  }
  return ends;
}

// Null vectors of A, by the last column of each.
struct Echelon {
  std::map<int, SparseEntries> by_last;
  std::vector<int> dependent;  // instead, where the vectors are not needed or would be too long
  bool complete = true;

  Echelon(const Sparse& A, double tolerance, bool vectors_needed) {
    std::vector<int> entries(static_cast<std::size_t>(A.rows()), 0), wide(entries.size(), -1);
    for (int k = 0; k < A.outerSize(); ++k)
      for (Sparse::InnerIterator it(A, k); it; ++it) ++entries[static_cast<std::size_t>(it.row())];
    std::vector<char> left_out(entries.size(), 0);
    int count = 0;
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (entries[k] > kWide) wide[k] = count++, left_out[k] = 1;

    FrontQr qr(A, left_out, tolerance);
    std::vector<SparseEntries> vectors;
    std::size_t size = 0;
    for (const int column : qr.dependent()) {
      complete = count > 0 || (vectors_needed && size <= kMostNamed);
      if (!complete) break;
      SparseEntries& z = vectors.emplace_back(qr.null_vector(column));
      drop_nothing(z);
      append_wide_rows(A, wide, z);
      size += z.size();
    }
    if (!complete) {
      dependent = qr.dependent();
      std::sort(dependent.begin(), dependent.end());
      return;
    }
    by_last = echelon(std::move(vectors));
    by_last.erase(by_last.lower_bound(static_cast<int>(A.cols())), by_last.end());  // a wide row holds these
    for (const auto& [column, z] : by_last) dependent.push_back(column);
  }
};

}  // namespace

ColumnDependencies column_dependencies(const Sparse& A, double tolerance) {
  Echelon space(A, tolerance, true);
  ColumnDependencies found;
  found.named = space.complete;
  for (const int column : space.dependent) found.columns.push_back({column, {}});
  std::size_t size = 0, k = 0;
  for (auto& [column, z] : space.by_last) {
    // Ascending: the dependent columns a vector contains have been expressed by independent ones before.
    if (size <= kMostNamed) {
      const SparseEntries contained = z;
      for (const auto& [index, value] : contained)
        if (const auto other = space.by_last.find(index); index != column && other != space.by_last.end())
          z = subtract(z, value / other->second.back().second, other->second, index);
    }
    size += z.size();
    for (const auto& [index, value] : z)
      if (index != column && std::abs(value) > kMentioned * std::abs(z.back().second))
        found.columns[k].others.push_back(index);
    ++k;
  }
  return found;
}

std::vector<int> dependent_columns(const Sparse& A, double tolerance) {
  return Echelon(A, tolerance, false).dependent;
}

NullSpace null_space(const Sparse& A, double tolerance) {
  Echelon space(A, tolerance, true);
  NullSpace found{std::move(space.dependent), {}};
  for (auto& [column, z] : space.by_last) found.vectors.push_back(std::move(z));
  return found;
}

std::vector<int> separate(std::vector<SparseEntries>&& vectors) {
  constexpr std::size_t kMostCombined = 2'000'000;  // entries: a second's work
  constexpr double kFlat = 1.5;                     // an entry this large takes the place of the pivot
  constexpr int kPasses = 20;
  std::size_t size = 0;
  for (const SparseEntries& z : vectors) size += z.size();
  std::vector<int> pivots;
  for (const SparseEntries& z : vectors) pivots.push_back(z.back().first);
  if (size > kMostCombined) return pivots;

  std::map<int, std::vector<std::size_t>> having;  // by column: vectors that have or had it
  for (std::size_t k = 0; k < vectors.size(); ++k)
    for (const auto& [column, value] : vectors[k]) having[column].push_back(k);
  const auto find = [](const SparseEntries& z, int column) {
    const auto it = std::ranges::lower_bound(z, column, {}, &std::pair<int, double>::first);
    return it != z.end() && it->first == column ? it->second : 0.0;
  };
  const auto pivot_on = [&](std::size_t k, int column, double value) {
    for (auto& entry : vectors[k]) entry.second /= value;
    for (const std::size_t other : std::vector<std::size_t>(having[column])) {
      const double factor = other == k ? 0 : find(vectors[other], column);
      if (factor == 0) continue;
      vectors[other] = subtract(vectors[other], factor, vectors[k], column);
      for (const auto& [c, v] : vectors[k])
        if (c != column) having[c].push_back(other);
    }
    having[column] = {k};
    pivots[k] = column;
  };
  for (int pass = 0; pass < kPasses; ++pass) {
    bool any = false;
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      // Among equals the last: what a scene lists later is what it says twice.
      const auto best = std::ranges::max_element(
          vectors[k], [](const auto& x, const auto& y) { return 0.999 * std::abs(x.second) < std::abs(y.second); });
      const auto [column, value] = *best;
      if (pass > 0 && std::abs(value) <= kFlat) continue;
      pivot_on(k, column, value);
      any = true;
    }
    if (!any) break;
  }
  return pivots;
}

}  // namespace poinsot
