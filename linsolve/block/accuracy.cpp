#include "linsolve/block/accuracy.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "linsolve/equilibration.h"

namespace poinsot::block {

void Accuracy::resize(const CscLayout& layout, std::span<const int> node) {
  residual_.resize(layout);
  node_ = node;
  of_body_.assign(index(layout.n), 0);
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k)
      if (layout.row[index(k)] == j) of_body_[index(j)] = 1;
}

void Accuracy::measure_by(const CscLayout& layout, std::span<const double> values, bool masses) {
  Equilibration equilibration;
  equilibration.resize(layout.n);
  (void)equilibration.find(layout, values);
  residual_.measure_by(equilibration.row(), equilibration.col());
  if (masses) find_masses(layout, values, equilibration.col());
}

// Ruiz' iteration within the blocks of bodies, from the units of the whole; then rows of constraints.
void Accuracy::find_masses(const CscLayout& layout, std::span<const double> values, std::span<const double> columns) {
  constexpr int kSweeps = 3;
  by_masses_.assign(columns.begin(), columns.end());
  const auto sweep = [&](bool bodies) {
    largest_.assign(by_masses_.size(), 0);
    for (std::size_t j = 0; j < largest_.size(); ++j) {
      if (bodies != bool(of_body_[j])) continue;
      for (int k = layout.start[j]; k < layout.start[j + 1]; ++k) {
        const std::size_t i = index(layout.row[index(k)]);
        if (!of_body_[i] || (bodies && node_[i] != node_[j])) continue;
        largest_[j] = std::max(largest_[j], std::abs(values[index(k)]) * by_masses_[i]);
      }
    }
    for (std::size_t j = 0; j < largest_.size(); ++j)
      if (largest_[j] > 0) by_masses_[j] = bodies ? std::sqrt(by_masses_[j] / largest_[j]) : 1 / largest_[j];
  };
  for (int k = 0; k < kSweeps; ++k) sweep(true);
  sweep(false);
}

bool Accuracy::good_by_masses(double size, std::span<const double> b, std::span<const double> x) const {
  if (size > kFairResidual) return false;
  const std::span<const double> r = residual_.vector(), rows = residual_.rows();
  double of_r = 0, of_b = 0, of_x = 0;               // by masses
  double violation = 0, motion = 0, prescribed = 0;  // r and b of constraints, x of bodies, of the equilibrated matrix
  for (std::size_t i = 0; i < r.size(); ++i) {
    of_r = std::max(of_r, std::abs(r[i]) * by_masses_[i]);
    of_b = std::max(of_b, std::abs(b[i]) * by_masses_[i]);
    of_x = std::max(of_x, std::abs(x[i]) / by_masses_[i]);
    if (of_body_[i]) {
      motion = std::max(motion, std::abs(x[i]) / residual_.column(i));
    } else {
      violation = std::max(violation, std::abs(r[i]) * rows[i]);
      prescribed = std::max(prescribed, std::abs(b[i]) * rows[i]);
    }
  }
  return of_r <= kSmallResidual * (of_x + of_b) && violation <= kLargeResidual * (motion + prescribed);
}

}  // namespace poinsot::block
