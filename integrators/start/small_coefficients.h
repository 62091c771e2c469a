// Of a block of some dozens of rows: the coefficients of rows set aside in terms of those kept (block_choice.h), by
// full matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "integrators/start/block_rows.h"

namespace poinsot {

class SmallCoefficients {
 public:
  static constexpr std::size_t kMost = 50;  // rows kept; with more, sparse matrices are faster

  // C, kept × left out, where `rows` stand; false where the rows kept are not independent.
  bool find(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out, Eigen::MatrixXd& C);
  // Takes out the rounding of what was found last: what is needed where multipliers are made of it.
  void refine(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
              Eigen::MatrixXd& C) const;

 private:
  std::vector<Eigen::Index> place_;  // by row: among those kept, then those left out
  Eigen::MatrixXd L_;                // of G_K G_Kᵀ = L Lᵀ, and below it (L⁻¹ G_K g_d)ᵀ by row left out
};

}  // namespace poinsot
