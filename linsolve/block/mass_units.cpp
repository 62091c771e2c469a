#include "linsolve/block/mass_units.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace poinsot::block {

// Ruiz' iteration within the blocks of bodies, then rows of constraints. Bodies' unknowns have an entry on the
// diagonal.
std::vector<double> mass_units(const CscLayout& layout, std::span<const double> values, std::span<const int> node,
                               std::span<const double> columns) {
  constexpr int kSweeps = 3;
  std::vector<char> of_body(columns.size(), 0);
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k)
      if (layout.row[index(k)] == j) of_body[index(j)] = 1;
  std::vector<double> units(columns.begin(), columns.end()), largest(columns.size());
  const auto sweep = [&](bool bodies) {
    std::ranges::fill(largest, 0.0);
    for (std::size_t j = 0; j < largest.size(); ++j) {
      if (bodies != (of_body[j] != 0)) continue;
      for (int k = layout.start[j]; k < layout.start[j + 1]; ++k) {
        const std::size_t i = index(layout.row[index(k)]);
        if (of_body[i] && (!bodies || node[i] == node[j]))
          largest[j] = std::max(largest[j], std::abs(values[index(k)]) * units[i]);
      }
    }
    for (std::size_t j = 0; j < largest.size(); ++j)
      if (largest[j] > 0) units[j] = bodies ? std::sqrt(units[j] / largest[j]) : 1 / largest[j];
  };
  for (int k = 0; k < kSweeps; ++k) sweep(true);
  sweep(false);
  return units;
}

}  // namespace poinsot::block
