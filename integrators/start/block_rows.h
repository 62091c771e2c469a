// The rows of a block (row_blocks.h) as unit vectors on its own bodies.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "integrators/start/row_space.h"

namespace poinsot {

class BlockRows {
 public:
  // `rows`: places in `space`.
  BlockRows(const RowSpace& space, std::vector<int> rows);

  std::size_t size() const { return rows_.size(); }
  int place_in_space(int k) const { return rows_[static_cast<std::size_t>(k)]; }
  std::size_t bodies() const { return bodies_.size(); }
  int place_of_body(int body) const;
  // How many pairs of rows share a body: entries of G Gᵀ.
  double products() const { return products_; }
  // Some of them, as columns of 6 numbers for each body.
  Eigen::SparseMatrix<double> columns(const RowSpace& space, std::span<const int> some) const;

 private:
  std::vector<int> rows_;    // of the space
  std::vector<int> bodies_;  // ascending
  double products_ = 0;
};

}  // namespace poinsot
