// Cholesky's factor of a Gram matrix of some dozens of rows, where it lies; the zeros of such matrices, whose rows act
// on two bodies each, are passed over.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace poinsot {

// L of A = L Lᵀ in the place of A's lower triangle; false where A is not positive definite. Zeros of L are passed over.
inline bool small_cholesky(Eigen::MatrixXd& A) {
  const Eigen::Index n = A.cols();
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = &A(j, j);
    for (Eigen::Index k = 0; k < j; ++k) {
      const double factor = A(j, k);
      if (factor == 0) continue;
      const double* other = &A(j, k);
      for (Eigen::Index i = 0; i < n - j; ++i) column[i] -= factor * other[i];
    }
    if (!(column[0] > 0)) return false;
    const double by = 1 / std::sqrt(column[0]);
    for (Eigen::Index i = 0; i < n - j; ++i) column[i] *= by;
  }
  return true;
}

// X ← L⁻ᵀ L⁻¹ X.
inline void small_cholesky_solve(const Eigen::MatrixXd& L, Eigen::MatrixXd& X) {
  const Eigen::Index n = L.cols();
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    double* x = X.col(c).data();
    for (Eigen::Index j = 0; j < n; ++j) {
      const double* column = L.col(j).data();
      x[j] /= column[j];
      if (x[j] == 0) continue;
      for (Eigen::Index i = j + 1; i < n; ++i) x[i] -= x[j] * column[i];
    }
    for (Eigen::Index j = n; j-- > 0;) {
      const auto below = n - j - 1;
      x[j] = (x[j] - L.col(j).tail(below).dot(X.col(c).tail(below))) / L(j, j);
    }
  }
}

}  // namespace poinsot
