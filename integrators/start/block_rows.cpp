#include "integrators/start/block_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {

BlockRows::BlockRows(const RowSpace& space, std::vector<int> rows) : rows_(std::move(rows)) {
  std::vector<int> of_rows;
  for (const int row : rows_) {
    int last = -1;
    for (Eigen::SparseMatrix<double>::InnerIterator it(space.columns(), row); it; ++it)
      if (const int body = static_cast<int>(it.row()) / 6; body != last) of_rows.push_back(last = body);
  }
  std::ranges::sort(of_rows);
  for (auto first = of_rows.begin(); first != of_rows.end();) {
    const auto last = std::ranges::upper_bound(first, of_rows.end(), *first);
    products_ += std::pow(last - first, 2);
    bodies_.push_back(*first);
    first = last;
  }
}

int BlockRows::place_of_body(int body) const {
  return static_cast<int>(std::ranges::lower_bound(bodies_, body) - bodies_.begin());
}

Eigen::SparseMatrix<double> BlockRows::columns(const RowSpace& space, std::span<const int> some) const {
  Eigen::SparseMatrix<double> of(6 * static_cast<Eigen::Index>(bodies_.size()), static_cast<Eigen::Index>(some.size()));
  of.reserve(12 * static_cast<Eigen::Index>(some.size()));
  for (std::size_t c = 0; c < some.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    of.startVec(column);
    for (Eigen::SparseMatrix<double>::InnerIterator it(space.columns(), rows_[index(some[c])]); it; ++it)
      if (it.value() != 0)
        of.insertBack(6 * place_of_body(static_cast<int>(it.row()) / 6) + it.row() % 6, column) = it.value();
  }
  of.finalize();
  return of;
}

}  // namespace poinsot
