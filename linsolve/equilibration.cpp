#include "linsolve/equilibration.h"

#include <algorithm>
#include <cmath>

namespace poinsot {
namespace {

constexpr int kSweeps = 3;  // the norms end within a factor of two of each other; more changes no decision

// The power of two next to 1/√m. An empty row or column stays as it is: the factorization will find it.
double factor(double m) {
  if (!(m > 0)) return 1;
  int exponent = 0;
  std::frexp(m, &exponent);
  return std::ldexp(1.0, -(exponent >> 1));
}

}  // namespace

void Equilibration::resize(int n) {
  for (auto* v : {&row_, &col_, &row_max_, &col_max_}) v->assign(static_cast<std::size_t>(n), 1.0);
}

bool Equilibration::find(const CscLayout& layout, std::span<const double> values) {
  std::ranges::fill(row_, 1.0);
  std::ranges::fill(col_, 1.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::ranges::fill(row_max_, 0.0);
    bool finite = true;
    for (std::size_t j = 0; j < col_.size(); ++j) {
      double column = 0;
      for (int k = layout.start[j]; k < layout.start[j + 1]; ++k) {
        const auto i = static_cast<std::size_t>(layout.row[static_cast<std::size_t>(k)]);
        const double a = std::abs(values[static_cast<std::size_t>(k)]) * row_[i] * col_[j];
        finite = finite && std::isfinite(a);
        column = std::max(column, a);
        row_max_[i] = std::max(row_max_[i], a);
      }
      col_max_[j] = column;
    }
    if (!finite) return false;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      row_[i] *= factor(row_max_[i]);
      col_[i] *= factor(col_max_[i]);
    }
  }
  return true;
}

double Equilibration::scale(const CscLayout& layout, std::span<const double> values, std::span<double> scaled) const {
  double largest = 0, poison = 0;  // poison stays 0 as long as everything is finite
  for (std::size_t j = 0; j < col_.size(); ++j)
    for (auto k = static_cast<std::size_t>(layout.start[j]); k < static_cast<std::size_t>(layout.start[j + 1]); ++k) {
      scaled[k] = values[k] * row_[static_cast<std::size_t>(layout.row[k])] * col_[j];
      largest = std::max(largest, std::abs(scaled[k]));
      poison += scaled[k] * 0;
    }
  return largest + poison;
}

void Equilibration::improve(std::span<const double> rows, std::span<const double> columns) {
  const auto power_of_two = [](double x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    return std::ldexp(1.0, exponent);
  };
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (rows[i] > 0) row_[i] /= power_of_two(rows[i]);
    if (columns[i] > 0) col_[i] *= power_of_two(columns[i]);
  }
}

void Equilibration::scale_right_hand_side(std::span<double> b) const {
  for (std::size_t i = 0; i < b.size(); ++i) b[i] *= row_[i];
}

void Equilibration::scale_solution(std::span<double> y) const {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] *= col_[i];
}

}  // namespace poinsot
