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

  // Which rows are kept; where their products go.
  void arrange(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out);
  // C, kept × left out, where `rows` stand; false where the rows kept are not independent.
  bool find(const BlockRows& rows, Eigen::MatrixXd& C);
  // The least pivot of that: the square of what is left of a row beside those before it.
  double least_pivot() const { return least_pivot_; }
  // Takes the rounding out of c, what f is in terms of the rows kept, for which coefficients were found last: what is
  // needed where multipliers are made of it.
  void refine(const BlockRows& rows, const std::vector<int>& kept, const Eigen::VectorXd& f,
              Eigen::Ref<Eigen::VectorXd> c);

 private:
  bool decompose();
  void forward();  // of the first in x_
  template <int Columns>
  void backward();  // of so many
  double* row(int i) { return L_.data() + i * stride_; }
  double* inverses() { return row(static_cast<int>(first_.size())); }  // 1 / L_jj

  static constexpr int kTogether = 3;  // columns that are solved for together: what a planar loop has left out

  int kept_ = 0;
  double least_pivot_ = 0;
  // Rows kept, then those left out: L of G_K G_Kᵀ = L Lᵀ by rows without its diagonal, and below it (L⁻¹ G_K g_d)ᵀ by
  // row left out, zero elsewhere; then the inverses of the diagonal, and a number for products that nothing needs.
  int stride_ = 0;             // a row's length, of whole vectors
  std::vector<double> L_, x_;  // x_: kTogether columns, stride_ apart
  Eigen::VectorXd left_;       // of f beside the rows kept
  std::vector<int> first_;     // by row: its first entry that is not zero, or its diagonal
  std::vector<int> at_;        // by pair of rows on a body (BlockRows::for_each_pair): where its product goes in L_
};

}  // namespace poinsot
