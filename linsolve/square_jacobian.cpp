#include "linsolve/square_jacobian.h"

#include <algorithm>

#include "core/index.h"
#include "linsolve/finite.h"

namespace poinsot {

bool SquareJacobian::fits(const Pattern& pattern) {
  std::vector<char> velocity(index(pattern.n), 0);
  for (const Block& b : pattern.blocks)
    for (int k = std::max(b.row, b.col); k < std::min(b.row + b.rows, b.col + b.cols); ++k) velocity[index(k)] = 1;
  return 2 * std::ranges::count(velocity, 1) == pattern.n;
}

bool SquareJacobian::analyze(const Pattern& pattern) {
  if (!layout_.build(pattern).ok()) return false;
  const int n = layout_.n;
  const auto find = [&](int i, int j) {
    const auto first = layout_.row.begin() + layout_.start[index(j)],
               last = layout_.row.begin() + layout_.start[index(j) + 1];
    const auto it = std::lower_bound(first, last, i);
    return it != last && *it == i ? static_cast<int>(it - layout_.row.begin()) : -1;
  };
  std::vector<int> velocity_of(index(n), -1), multiplier_of(velocity_of);
  for (int k = 0; k < n; ++k) {
    if (find(k, k) >= 0) {
      velocity_of[index(k)] = static_cast<int>(velocities_.size());
      velocities_.push_back(k);
    } else {
      multiplier_of[index(k)] = static_cast<int>(multipliers_.size());
      multipliers_.push_back(k);
    }
  }

  Pattern g{n / 2, {}, std::vector<int>(index(n / 2), 0)};
  int entries_above = 0;
  for (int j = 0; j < n; ++j) {
    if (velocity_of[index(j)] >= 0) k_start_.push_back(static_cast<int>(k_.size()));
    for (int k = layout_.start[index(j)]; k < layout_.start[index(j) + 1]; ++k) {
      const int i = layout_.row[index(k)];
      if (velocity_of[index(i)] >= 0) {
        if (velocity_of[index(j)] >= 0)
          k_.emplace_back(k, velocity_of[index(i)]);
        else
          ++entries_above;
        continue;
      }
      if (velocity_of[index(j)] < 0) return false;  // constraints that are coupled directly
      const int above = find(j, i);
      if (above < 0) return false;
      g.blocks.push_back({multiplier_of[index(i)], velocity_of[index(j)], 1, 1});
      g_.push_back({k, above, 0});
    }
  }
  k_start_.push_back(static_cast<int>(k_.size()));
  if (entries_above != static_cast<int>(g_.size()) || !solver_->analyze(g, Workload::transposed).ok()) return false;
  for (std::size_t k = 0; k < g_.size(); ++k) g_[k].solver = solver_->slots()[k];
  values_.assign(index(layout_.nonzeros()), 0);
  for (auto* v : {&v_, &f_}) v->assign(velocities_.size(), 0);
  return true;
}

bool SquareJacobian::take_values() {
  const double* from = values_.data();
  double* to = solver_->values().data();
  bool equal = true;
  for (const Entry& entry : g_) {
    const double value = from[entry.whole];
    to[entry.solver] = value;
    equal &= value == from[entry.above];
  }
  return equal;
}

LinearStatus SquareJacobian::factor() {
  if (!all_finite(values_))  // K included
    return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
  LinearStatus status = solver_->factor();
  if (status.unknown >= 0) status.unknown = velocities_[index(status.unknown)];
  return status;
}

LinearStatus SquareJacobian::solve(std::span<double> b) {
  for (std::size_t k = 0; k < v_.size(); ++k) v_[k] = b[index(multipliers_[k])], f_[k] = b[index(velocities_[k])];
  if (LinearStatus status = solver_->solve(v_); !status.ok()) return status;
  const double* values = values_.data();
  double* f = f_.data();
  for (std::size_t c = 0; c < v_.size(); ++c) {
    const double v = v_[c];
    b[index(velocities_[c])] = v;
    for (int k = k_start_[c]; k < k_start_[c + 1]; ++k) f[k_[index(k)].second] -= values[k_[index(k)].first] * v;
  }
  if (LinearStatus status = solver_->solve_transposed(f_); !status.ok()) return status;
  for (std::size_t k = 0; k < v_.size(); ++k) b[index(multipliers_[k])] = f_[k];
  return {};
}

}  // namespace poinsot
