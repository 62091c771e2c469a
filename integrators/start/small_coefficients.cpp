#include "integrators/start/small_coefficients.h"

#include <cmath>

#include "core/index.h"

namespace poinsot {
namespace {

// Cholesky's factor of a Gram matrix of some dozens of rows, L of A = L Lᵀ in the place of A's lower triangle; false
// where A is not positive definite. The zeros of such matrices, whose rows act on two bodies each, are passed over.
bool small_cholesky(Eigen::MatrixXd& A) {
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
void small_cholesky_solve(const Eigen::MatrixXd& L, Eigen::MatrixXd& X) {
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

}  // namespace

bool SmallCoefficients::find(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                             Eigen::MatrixXd& C) {
  const auto n = static_cast<Eigen::Index>(kept.size()), m = static_cast<Eigen::Index>(left_out.size());
  place_.assign(rows.size(), -1);
  for (Eigen::Index j = 0; j < n; ++j) place_[index(kept[index(j)])] = static_cast<int>(j);
  gram_.resize(n, n), C.setZero(n, m);
  const auto fill = [&](int k, Eigen::Index from, auto&& column) {
    rows.for_each_beside(k, [&](int l) {
      const int place = place_[index(l)];
      if (place >= from) column[place] = rows.dot(k, l);
    });
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    gram_.col(j).tail(n - j).setZero();
    fill(kept[index(j)], j, gram_.col(j));
  }
  for (Eigen::Index d = 0; d < m; ++d) fill(left_out[index(d)], 0, C.col(d));
  if (!small_cholesky(gram_)) return false;
  small_cholesky_solve(gram_, C);
  return C.allFinite();
}

void SmallCoefficients::refine(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                               Eigen::MatrixXd& C) const {
  Eigen::MatrixXd change(C.rows(), C.cols());
  Eigen::VectorXd left(rows.variables());
  for (Eigen::Index d = 0; d < C.cols(); ++d) {
    left.setZero();
    rows.add(1, left_out[index(d)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) rows.add(-C(k, d), kept[index(k)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) change(k, d) = rows.share(kept[index(k)], left);
  }
  small_cholesky_solve(gram_, change);
  C += change;
}

}  // namespace poinsot
