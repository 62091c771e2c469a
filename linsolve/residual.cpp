#include "linsolve/residual.h"

#include <algorithm>
#include <cmath>

namespace poinsot {

void Residual::measure_by(std::span<const double> rows, std::span<const double> columns) {
  rows_.assign(rows.begin(), rows.end());
  columns_.assign(columns.begin(), columns.end());
}

void Residual::find(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                    std::span<const double> x) {
  r_.assign(b.begin(), b.end());
  for (std::size_t j = 0; j < r_.size(); ++j)
    for (auto k = static_cast<std::size_t>(layout.start[j]); k < static_cast<std::size_t>(layout.start[j + 1]); ++k)
      r_[static_cast<std::size_t>(layout.row[k])] -= values[k] * x[j];
}

double Residual::size(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                      std::span<const double> x) {
  find(layout, values, b, x);
  double size_x = 0, size_b = 0, size_r = 0, poison = 0;
  for (std::size_t i = 0; i < r_.size(); ++i) {
    size_x = std::max(size_x, std::abs(x[i]) / columns_[i]);
    size_b = std::max(size_b, std::abs(b[i]) * rows_[i]);
    size_r = std::max(size_r, std::abs(r_[i]) * rows_[i]);
    poison += r_[i] * 0;
  }
  if (poison != 0) return HUGE_VAL;
  return size_r == 0 ? 0 : size_r / (size_x + size_b);
}

}  // namespace poinsot
