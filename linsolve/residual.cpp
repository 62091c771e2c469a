#include "linsolve/residual.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/check.h"
#include "core/index.h"
#include "linsolve/finite.h"
#include "linsolve/lanes.h"

namespace poinsot {
namespace {

constexpr double kGoodSize = 1e-14;
constexpr int kTogether = 4;       // columns at most
constexpr double kFewTerms = 300;  // of a row; its sums are compared with its largest term

Vec greater(Vec x, Vec y) {
  return x > y ? x : y;
}

// max |v| f
double largest(std::span<const double> v, std::span<const double> f) {
  Vec most = {};
  std::size_t i = 0;
  for (; i + kLanes <= v.size(); i += kLanes) {
    const Vec x = load(v.data() + i);
    most = greater((x < 0 ? -x : x) * load(f.data() + i), most);
  }
  double rest = 0;
  for (; i < v.size(); ++i) rest = std::max(rest, std::abs(v[i]) * f[i]);
  for (int lane = 0; lane < kLanes; ++lane) rest = std::max(rest, most[lane]);
  return rest;
}

// r ← r − A x for C columns with the same rows, each row's terms in the order of the columns.
template <int C>
void take(const int* row, int rows, const double* values, const double* x, double* r) {
  double by[C];
  const double* column[C];
  unrolled<C>([&](auto c) { by[c] = x[c], column[c] = values + c * rows; });
  for (int i = 0; i < rows; ++i) {
    double sum = r[row[i]];
    unrolled<C>([&](auto c) { sum -= column[c][i] * by[c]; });
    r[row[i]] = sum;
  }
}

}  // namespace

void Residual::resize(const CscLayout& layout) {
  panels_.clear();
  const auto rows = [&](int j) {
    return std::span(layout.row)
        .subspan(index(layout.start[index(j)]), index(layout.start[index(j) + 1] - layout.start[index(j)]));
  };
  for (int j = 0, columns; j < layout.n; j += columns) {
    columns = 1;
    while (columns < kTogether && j + columns < layout.n && std::ranges::equal(rows(j), rows(j + columns))) ++columns;
    panels_.push_back(columns);
  }
  panels_.shrink_to_fit();
  std::vector<int> entries(index(layout.n), 0);
  for (const int row : layout.row) ++entries[index(row)];
  terms_.clear();
  if (entries.empty() || *std::ranges::max_element(entries) <= kFewTerms) return;
  terms_.resize(entries.size());
  std::ranges::transform(entries, terms_.begin(), [](int count) { return std::max(1.0, count / kFewTerms); });
}

void Residual::measure_by(std::span<const double> rows, std::span<const double> columns) {
  rows_.assign(rows.begin(), rows.end());
  by_terms_.resize(terms_.size());
  if (!terms_.empty()) std::ranges::transform(rows, terms_, by_terms_.begin(), std::divides());
  per_column_.resize(columns.size());
  std::ranges::transform(columns, per_column_.begin(), [](double column) { return 1 / column; });
}

void Residual::find(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                    std::span<const double> x) {
  check(panels_.empty() == (layout.n == 0), "the residual knows the structure of its matrix");
  r_.assign(b.begin(), b.end());
  const double* xj = x.data();
  const int* start = layout.start.data();
  for (const int columns : panels_) {
    const int rows = start[1] - *start;
    const int* row = layout.row.data() + *start;
    const double* entries = values.data() + *start;
    switch (columns) {
      case 1:
        take<1>(row, rows, entries, xj, r_.data());
        break;
      case 2:
        take<2>(row, rows, entries, xj, r_.data());
        break;
      case 3:
        take<3>(row, rows, entries, xj, r_.data());
        break;
      default:
        take<kTogether>(row, rows, entries, xj, r_.data());
    }
    xj += columns, start += columns;
  }
}

double Residual::size(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                      std::span<const double> x) {
  find(layout, values, b, x);
  const double size_x = largest(x, per_column_), size_b = largest(b, rows_),
               size_r = largest(r_, by_terms_.empty() ? rows_ : by_terms_);
  if (!all_finite(r_)) return HUGE_VAL;
  const double size = size_r == 0 ? 0 : size_r / (size_x + size_b);
  return terms_.empty() || size <= kGoodSize ? size : in_sums(layout, values, b, x, size_x + size_b);
}

double Residual::in_sums(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                         std::span<const double> x, double size) {
  sums_.resize(r_.size());
  std::ranges::transform(b, sums_.begin(), [](double part) { return std::abs(part); });
  for (std::size_t j = 0; j < x.size(); ++j)
    for (int k = layout.start[j]; k < layout.start[j + 1]; ++k)
      if (const std::size_t row = index(layout.row[index(k)]); terms_[row] > 1)
        sums_[row] += std::abs(values[index(k)] * x[j]);
  double most = 0;
  for (std::size_t i = 0; i < r_.size(); ++i) {
    const double r = std::abs(r_[i]);
    if (r == 0) continue;
    const double of_all = r * by_terms_[i] / size;
    most = std::max(most, terms_[i] > 1 ? std::min(of_all, r / sums_[i]) : of_all);
  }
  return most;
}

}  // namespace poinsot
