#include "linsolve/determined.h"

#include <algorithm>

#include "core/index.h"
#include "linsolve/finite.h"

namespace poinsot {
bool Determined::analyze(const CscLayout& layout) {
  const int n = layout.n;
  if (n % 2 != 0) return false;
  const auto find = [&](int i, int j) {
    const auto first = layout.row.begin() + layout.start[index(j)],
               last = layout.row.begin() + layout.start[index(j) + 1];
    const auto it = std::lower_bound(first, last, i);
    return it != last && *it == i ? static_cast<int>(it - layout.row.begin()) : -1;
  };
  velocities_.clear(), multipliers_.clear();
  velocity_of_.assign(index(n), -1);
  std::vector<int> multiplier_of(index(n), -1);
  for (int k = 0; k < n; ++k) {
    if (find(k, k) >= 0) {
      velocity_of_[index(k)] = static_cast<int>(velocities_.size());
      velocities_.push_back(k);
    } else {
      multiplier_of[index(k)] = static_cast<int>(multipliers_.size());
      multipliers_.push_back(k);
    }
  }
  if (velocities_.size() != multipliers_.size()) return false;

  Pattern g{n / 2, {}, std::vector<int>(index(n / 2), 0)};
  g_.clear(), mirror_.clear();
  int entries_above = 0;
  for (int j = 0; j < n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) {
      const int i = layout.row[index(k)];
      if (velocity_of_[index(i)] >= 0) {
        entries_above += velocity_of_[index(j)] < 0;
        continue;
      }
      if (velocity_of_[index(j)] < 0) return false;  // constraints that are coupled directly
      const int above = find(j, i);
      if (above < 0) return false;
      g.blocks.push_back({multiplier_of[index(i)], velocity_of_[index(j)], 1, 1});
      g_.emplace_back(k, 0);
      mirror_.emplace_back(k, above);
    }
  if (entries_above != static_cast<int>(g_.size()) || !klu_.analyze(g).ok()) return false;
  for (std::size_t k = 0; k < g_.size(); ++k) g_[k].second = klu_.slots()[k];
  for (auto* v : {&v_, &f_}) v->assign(velocities_.size(), 0);
  return true;
}

bool Determined::fits(std::span<const double> values) const {
  bool equal = true;
  for (const auto& [g, above] : mirror_) equal = equal && values[index(g)] == values[index(above)];
  return equal;
}

LinearStatus Determined::factor(std::span<const double> values) {
  if (!all_finite(values))  // K included
    return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
  for (const auto& [whole, part] : g_) klu_.values()[index(part)] = values[index(whole)];
  LinearStatus status = klu_.factor();
  if (status.unknown >= 0) status.unknown = velocities_[index(status.unknown)];
  return status;
}

// Numbers are scaled as they are gathered and scattered, one by one: a loop over them right after would load as vectors
// what was stored piece by piece, and processors wait long for that.
void Determined::solve(const CscLayout& layout, std::span<const double> values, std::span<double> b) {
  const std::span<const double> row = klu_.row_factors(), column = klu_.column_factors();
  for (std::size_t k = 0; k < v_.size(); ++k) {
    v_[k] = row[k] * b[index(multipliers_[k])];
    f_[k] = column[k] * b[index(velocities_[k])];
  }
  klu_.substitute(v_);
  for (std::size_t c = 0; c < v_.size(); ++c) {
    const int j = velocities_[c];
    const double v = column[c] * v_[c];
    b[index(j)] = v;
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k)
      if (const int r = velocity_of_[index(layout.row[index(k)])]; r >= 0)
        f_[index(r)] -= column[index(r)] * (values[index(k)] * v);
  }
  klu_.substitute_transposed(f_);
  for (std::size_t k = 0; k < v_.size(); ++k) b[index(multipliers_[k])] = row[k] * f_[k];
}

}  // namespace poinsot
