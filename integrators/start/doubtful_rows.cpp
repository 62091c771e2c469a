#include "integrators/start/doubtful_rows.h"

#include <algorithm>

#include "core/index.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {

Doubt vanishing_row(const RowSpace& space) {
  Doubt found;
  for (std::size_t k = 0; k < space.rows().size(); ++k) {
    const double left = space.left_of(k);
    if (left <= kDependent || left >= (found.vanishing ? found.part : kIndependent)) continue;
    found = {.row = space.rows()[k], .part = left, .vanishing = true};
  }
  return found;
}

Doubt barely_independent_row(const RowSpace& space, const Eigen::SparseMatrix<double>& columns,
                             const std::vector<int>& surely, double most, double least) {
  Doubt found{.part = most};
  for (const int column : dependent_columns(columns, most))
    if (!std::ranges::binary_search(surely, column)) found.row = space.rows()[index(column)];
  for (double part = most / 10; part > least; part /= 10)
    if (dependent_columns(columns, part).size() > surely.size()) found.part = part;
  return found;
}

Doubt row_of_few_digits(const RowSpace& space, std::size_t redundant) {
  constexpr double kFewDigits = 1e-3;
  constexpr std::size_t kMostRows = 400;
  if (space.rows().size() > kMostRows) return {};
  const Eigen::SparseMatrix<double> columns = space.columns();
  if (dependent_columns(columns, kFewDigits).size() <= redundant) return {};
  const std::vector<int> surely = dependent_columns(columns, kIndependent);
  if (surely.size() != redundant) return {};
  Doubt found = barely_independent_row(space, columns, surely, kFewDigits, kIndependent);
  found.few_digits = true;
  return found;
}

}  // namespace poinsot
