// How much of each row of G is independent of the others, of mechanisms of any size.
//
// With rows of unit length the part of row g that no combination of the others makes up is as long as
//   1/sqrt((G Gᵀ)⁻¹_gg)
// G Gᵀ is sparse, and so are its factors P G Gᵀ Pᵀ = L D Lᵀ. Of the inverse Z those entries are found where L has some,
// the diagonal among them, from the last column to the first (K. Takahashi, J. Fagan, M.-S. Chen, Formation of a sparse
// bus impedance matrix, 1973), in about the time the factors take:
//   Z_ij = −Σ_k Z_ik L_kj,   Z_jj = 1/D_j − Σ_k L_kj Z_kj,   k > j
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <span>

#include "formulations/problem.h"

namespace poinsot {

// G with rows of unit length, a turn counted as the way it makes at the body's size: whatever the unit of lengths.
class UnitRows {
 public:
  // Whether G Gᵀ is sparse enough: not where thousands of rows hold one body.
  static bool has(const Problem& problem);
  // Where has(). The problem stands at (t, q) afterwards, at rest.
  UnitRows(Problem& problem, double t, std::span<const double> q);

  const Eigen::VectorXd& lengths() const { return lengths_; }
  // Of every row, how much of its length is independent of the others; 0 where it is nothing beside rounding.
  const Eigen::VectorXd& shares() const { return shares_; }
  // (G Gᵀ)⁻¹ e_row: what of the others makes up for that row, where it all but depends on them.
  Eigen::VectorXd dependence(Eigen::Index row) const;

 private:
  Eigen::VectorXd lengths_, shares_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> square_;
};

}  // namespace poinsot
