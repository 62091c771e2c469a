#include "linsolve/column_dependencies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "linsolve/front_qr.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int kWide = 300;           // entries of a row that fronts do without
constexpr double kNothing = 1e-9;    // of a coefficient beside the largest of its vector
constexpr double kMentioned = 1e-6;  // of a coefficient beside that of the dependent column

double largest(const SparseEntries& z) {
  double size = 0;
  for (const auto& [index, value] : z) size = std::max(size, std::abs(value));
  return size;
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
  const double nothing = kNothing * largest(sum);
  std::erase_if(sum, [&](const auto& e) { return e.first == gone || std::abs(e.second) <= nothing; });
  return sum;
}

// A z at the wide rows, as entries behind those of the columns: combined like them, and zero for a null vector of A.
void append_wide_rows(const Sparse& A, const std::vector<int>& wide, SparseEntries& z) {
  std::map<int, double> sums;
  for (const auto& [column, value] : z)
    for (Sparse::InnerIterator it(A, column); it; ++it)
      if (const int k = wide[static_cast<std::size_t>(it.row())]; k >= 0) sums[k] += it.value() * value;
  const double nothing = kNothing * largest(z);
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

}  // namespace

std::vector<ColumnDependency> column_dependencies(const Sparse& A, double tolerance) {
  std::vector<int> entries(static_cast<std::size_t>(A.rows()), 0), wide(entries.size(), -1);
  for (int k = 0; k < A.outerSize(); ++k)
    for (Sparse::InnerIterator it(A, k); it; ++it) ++entries[static_cast<std::size_t>(it.row())];
  std::vector<char> left_out(entries.size(), 0);
  int count = 0;
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (entries[k] > kWide) wide[k] = count++, left_out[k] = 1;

  FrontQr qr(A, left_out, tolerance);
  std::vector<SparseEntries> vectors;
  for (const int column : qr.dependent()) {
    vectors.push_back(qr.null_vector(column));
    append_wide_rows(A, wide, vectors.back());
  }
  std::map<int, SparseEntries> ends = echelon(std::move(vectors));
  ends.erase(ends.lower_bound(static_cast<int>(A.cols())), ends.end());  // not null vectors: a wide row holds these

  // Ascending: the dependent columns a vector contains have been expressed by independent ones before.
  std::vector<ColumnDependency> found;
  for (auto& [column, z] : ends) {
    const SparseEntries contained = z;
    for (const auto& [index, value] : contained)
      if (const auto other = ends.find(index); index != column && other != ends.end())
        z = subtract(z, value / other->second.back().second, other->second, index);
    ColumnDependency& dependency = found.emplace_back(ColumnDependency{column, {}});
    for (const auto& [index, value] : z)
      if (index != column && std::abs(value) > kMentioned * std::abs(z.back().second))
        dependency.others.push_back(index);
  }
  return found;
}

}  // namespace poinsot
