#include "linsolve/singularity.h"

#include <cmath>

namespace poinsot {

PivotRatio pivot_ratio(const CompressedFactor& l_rows, const CompressedFactor& u_columns,
                       std::span<const double> pivots, std::span<double> work) {
  PivotRatio worst;
  const auto at = [](int p) { return static_cast<std::size_t>(p); };
  for (std::size_t k = 0; k < pivots.size(); ++k) {
    for (int p = l_rows.start[k]; p < l_rows.start[k + 1]; ++p)
      work[at(l_rows.index[at(p)])] = std::abs(l_rows.value[at(p)]);
    double cancelled = 0;
    for (int p = u_columns.start[k]; p < u_columns.start[k + 1]; ++p)
      if (at(u_columns.index[at(p)]) != k)
        cancelled += work[at(u_columns.index[at(p)])] * std::abs(u_columns.value[at(p)]);
    for (int p = l_rows.start[k]; p < l_rows.start[k + 1]; ++p) work[at(l_rows.index[at(p)])] = 0;

    const double pivot = std::abs(pivots[k]);
    const double ratio = pivot > 0 ? pivot / (pivot + cancelled) : 0;
    if (!(ratio >= worst.smallest)) worst = {ratio, static_cast<int>(k)};
  }
  return worst;
}

void transpose(const CompressedFactor& in, CompressedFactor& out) {
  const std::size_t n = in.start.size() - 1;
  const auto at = [](int p) { return static_cast<std::size_t>(p); };
  out.start.assign(n + 1, 0);
  out.index.resize(in.index.size());
  out.value.resize(in.value.size());
  for (std::size_t p = 0; p < at(in.start[n]); ++p) ++out.start[at(in.index[p]) + 1];
  for (std::size_t i = 0; i < n; ++i) out.start[i + 1] += out.start[i];
  for (std::size_t j = 0; j < n; ++j)
    for (auto p = at(in.start[j]); p < at(in.start[j + 1]); ++p) {
      const auto q = at(out.start[at(in.index[p])]++);
      out.index[q] = static_cast<int>(j);
      out.value[q] = in.value[p];
    }
  for (std::size_t i = n; i > 0; --i) out.start[i] = out.start[i - 1];  // the fill moved every start to its end
  out.start[0] = 0;
}

LinearStatus singular_status(int unknown) {
  return {LinearFailure::singular, unknown, "the matrix is singular to working precision"};
}

}  // namespace poinsot
