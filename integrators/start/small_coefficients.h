// Of a block of some dozens of rows: the coefficients of rows set aside in terms of those kept (block_choice.h), by
// Cholesky's decomposition of their Gram matrix within its envelope.
//
// A row has products with those that share a body with it, and as scenes list joints along their loops, these are the
// rows of the joint just before: rows of L begin late but for those of the joint that closes the loop and of rows set
// aside. Looks at the choice are most of what redundancy costs a motion of long steps.
#pragma once

#include <Eigen/Core>
#include <span>
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
              Eigen::MatrixXd& C);

 private:
  bool decompose(int kept);
  void forward(std::span<double> x) const;
  void backward(std::span<double> x) const;
  double* row(int i) { return L_.data() + i * stride_; }
  const double* row(int i) const { return L_.data() + i * stride_; }

  std::vector<int> place_;  // by row: among those kept, then those left out
  // L of G_K G_Kᵀ = L Lᵀ by rows without its diagonal, and below it (L⁻¹ G_K g_d)ᵀ by row left out; zero elsewhere.
  int stride_ = 0;  // a row's length, of whole vectors
  std::vector<double> L_, x_;
  std::vector<int> first_;       // by row: its first entry that is not zero, or its diagonal
  std::vector<double> inverse_;  // 1 / L_jj
};

}  // namespace poinsot
