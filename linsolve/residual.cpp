#include "linsolve/residual.h"

#include <algorithm>
#include <cmath>

#include "linsolve/finite.h"

namespace poinsot {
namespace {

// max |v| f, in lanes that a compiler turns into vectors.
double largest(std::span<const double> v, std::span<const double> f) {
  constexpr std::size_t kWide = 8;
  double most[kWide] = {};
  std::size_t i = 0;
  for (; i + kWide <= v.size(); i += kWide)
    for (std::size_t lane = 0; lane < kWide; ++lane) {
      const double size = std::abs(v[i + lane]) * f[i + lane];
      most[lane] = size > most[lane] ? size : most[lane];
    }
  for (; i < v.size(); ++i) most[0] = std::max(most[0], std::abs(v[i]) * f[i]);
  return *std::ranges::max_element(most);
}

}  // namespace

void Residual::measure_by(std::span<const double> rows, std::span<const double> columns) {
  rows_.assign(rows.begin(), rows.end());
  per_column_.resize(columns.size());
  std::ranges::transform(columns, per_column_.begin(), [](double column) { return 1 / column; });
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
  const double size_x = largest(x, per_column_), size_b = largest(b, rows_), size_r = largest(r_, rows_);
  if (!all_finite(r_)) return HUGE_VAL;
  return size_r == 0 ? 0 : size_r / (size_x + size_b);
}

}  // namespace poinsot
