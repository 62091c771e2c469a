#include "linsolve/equilibration.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "linsolve/lanes.h"

namespace poinsot {
namespace {

constexpr int kSweeps = 3;  // the norms end within a factor of two of each other; more changes no decision

// The power of two next to 1/√m, by the exponents as they are stored: the library's functions were a twentieth of
// first factorizations. An empty row or column stays as it is: the factorization will find it.
double factor(double m) {
  constexpr int kMantissa = std::numeric_limits<double>::digits - 1,
                kBias = std::numeric_limits<double>::max_exponent - 1;
  if (!(m > 0) || !std::isfinite(m)) return 1;
  const auto stored = static_cast<int>(std::bit_cast<std::uint64_t>(m) >> kMantissa);
  const int exponent = 1 + (stored > 0 ? stored - kBias : std::ilogb(m));
  return std::bit_cast<double>(static_cast<std::uint64_t>(kBias - (exponent >> 1)) << kMantissa);
}

}  // namespace

void Equilibration::resize(int n) {
  for (auto* v : {&row_, &col_, &row_max_, &col_max_, &row_min_, &col_min_})
    v->assign(static_cast<std::size_t>(n), 1.0);
  by_entry_.clear();
}

bool Equilibration::find(const CscLayout& layout, std::span<const double> values) {
  std::ranges::fill(row_, 1.0);
  std::ranges::fill(col_, 1.0);
  by_entry_.clear();
  for (int k = 0; k < kSweeps; ++k)
    if (!sweep<false>(layout, values)) return false;
  return true;
}

void Equilibration::find_by_means(const CscLayout& layout, std::span<const double> values) {
  std::ranges::fill(row_, 1.0);
  std::ranges::fill(col_, 1.0);
  by_entry_.clear();
  for (int k = 0; k < kSweeps; ++k) (void)sweep<true>(layout, values);
  for (int k = 0; k < kSweeps; ++k) (void)sweep<false>(layout, values);
}

template <bool means>
bool Equilibration::sweep(const CscLayout& layout, std::span<const double> values) {
  std::ranges::fill(row_max_, 0.0);
  if constexpr (means) std::ranges::fill(row_min_, HUGE_VAL);
  bool finite = true;
  for (std::size_t j = 0; j < col_.size(); ++j) {
    double largest = 0, smallest = HUGE_VAL;
    for (int k = layout.start[j]; k < layout.start[j + 1]; ++k) {
      const auto i = static_cast<std::size_t>(layout.row[static_cast<std::size_t>(k)]);
      const double a = std::abs(values[static_cast<std::size_t>(k)]) * row_[i] * col_[j];
      finite = finite && std::isfinite(a);
      if (a == 0) continue;
      largest = std::max(largest, a);
      row_max_[i] = std::max(row_max_[i], a);
      if constexpr (!means) continue;
      smallest = std::min(smallest, a);
      row_min_[i] = std::min(row_min_[i], a);
    }
    col_max_[j] = largest;
    if constexpr (means) col_min_[j] = smallest;
  }
  for (std::size_t i = 0; i < row_.size(); ++i) {
    row_[i] *= factor(means ? std::sqrt(row_max_[i]) * std::sqrt(row_min_[i]) : row_max_[i]);
    col_[i] *= factor(means ? std::sqrt(col_max_[i]) * std::sqrt(col_min_[i]) : col_max_[i]);
  }
  return finite;
}

double Equilibration::scale(const CscLayout& layout, std::span<const double> values, std::span<double> scaled) {
  if (by_entry_.empty()) multiply(layout);
  // poison stays 0 as long as everything is finite
  double largest = 0, poison = 0;
  Vec most = {}, poisons = {};
  std::size_t k = 0;
  for (; k + kLanes <= values.size(); k += kLanes) {
    const Vec entries = load(&values[k]) * load(&by_entry_[k]), sizes = magnitude(entries);
    store(&scaled[k], entries);
    most = sizes > most ? sizes : most;
    poisons += entries * 0;
  }
  for (; k < values.size(); ++k) {
    scaled[k] = values[k] * by_entry_[k];
    largest = std::max(largest, std::abs(scaled[k]));
    poison += scaled[k] * 0;
  }
  for (int lane = 0; lane < kLanes; ++lane) largest = std::max(largest, most[lane]), poison += poisons[lane];
  return largest + poison;
}

void Equilibration::multiply(const CscLayout& layout) {
  by_entry_.reserve(layout.row.size());
  for (std::size_t j = 0; j < col_.size(); ++j)
    for (int k = layout.start[j]; k < layout.start[j + 1]; ++k)
      by_entry_.push_back(row_[static_cast<std::size_t>(layout.row[static_cast<std::size_t>(k)])] * col_[j]);
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
  by_entry_.clear();
}

void Equilibration::scale_right_hand_side(std::span<double> b) const {
  for (std::size_t i = 0; i < b.size(); ++i) b[i] *= row_[i];
}

void Equilibration::scale_solution(std::span<double> y) const {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] *= col_[i];
}

}  // namespace poinsot
