// Of a block of some dozens of rows: the coefficients of rows set aside in terms of those kept (block_choice.h), by
// full matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model.h"
#include "integrators/start/block_rows.h"

namespace poinsot {

class SmallCoefficients {
 public:
  static constexpr std::size_t kMost = 120;  // rows kept; with more, sparse matrices are faster

  SmallCoefficients(const Model& model, const RowSpace& space, const BlockRows& rows);

  // C, kept × left out; false where the rows kept are not independent.
  bool find(const RowSpace& space, const BlockRows& rows, const std::vector<int>& kept,
            const std::vector<int>& left_out, Eigen::MatrixXd& C);
  // Takes out the rounding of what was found last: what is needed where multipliers are made of it.
  void refine(const std::vector<int>& kept, const std::vector<int>& left_out, Eigen::MatrixXd& C) const;

 private:
  void take_parts(const RowSpace& space, const BlockRows& rows);
  double dot(int k, int l) const;

  struct Parts {
    int body[2];  // place of it, −1: the ground
    Eigen::Matrix<double, 6, 1> part[2];
  };
  Eigen::Index variables_;
  std::vector<std::vector<int>> beside_;  // by row: rows that share a body
  std::vector<int> place_;                // by row: among those kept, −1 where it is not
  std::vector<Parts> parts_;              // by row
  Eigen::MatrixXd gram_;                  // the lower triangle's Cholesky factor
};

}  // namespace poinsot
