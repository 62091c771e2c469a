// Of a block of many rows: what forces of rows set aside are by those kept (block_choice.h), by sparse matrices whose
// pattern is analysed once for the same rows kept.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "integrators/start/block_rows.h"
#include "linsolve/front_qr.h"

namespace poinsot {

// g_d − Σ c_k g_k = 0: by row of the block, without what is nothing beside 1.
SparseEntries unit_null_vector(std::span<const int> kept, const Eigen::Ref<const Eigen::VectorXd>& c, int left_out);

class SparseCoefficients {
 public:
  SparseCoefficients(const BlockRows& rows, std::span<const int> kept);

  // Where `rows` stand: false where the rows kept are not independent.
  bool factor(const BlockRows& rows);
  double least_pivot() const { return factored_.vectorD().minCoeff(); }  // small_coefficients.h
  // Coefficients of the rows kept, a column for each column of F: argmin ‖G_Kᵀ c − f‖, refined as often as asked for.
  Eigen::MatrixXd find(const BlockRows& rows, const Eigen::MatrixXd& F, int refinements) const;
  // A null vector of Gᵀ for each row left out, on unit vectors, where that is 1, by row of the block; none where the
  // coefficients are not finite.
  std::vector<SparseEntries> null_vectors(const BlockRows& rows, std::span<const int> left_out, int refinements) const;

 private:
  // The same of F = G_Dᵀ, D the rows left out.
  Eigen::MatrixXd find(const BlockRows& rows, std::span<const int> left_out, int refinements) const;
  void refine(const BlockRows& rows, Eigen::MatrixXd F, Eigen::MatrixXd& C) const;
  Eigen::MatrixXd shares(const BlockRows& rows, const Eigen::MatrixXd& F) const;
  void solve(Eigen::MatrixXd& B) const;
  template <int N>
  void solve_together(Eigen::Ref<Eigen::MatrixXd> B) const;

  std::vector<int> kept_, place_;     // place_: by row, −1 of rows not kept
  Eigen::SparseMatrix<double> gram_;  // lower triangle
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factored_;
};

}  // namespace poinsot
