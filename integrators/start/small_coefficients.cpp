#include "integrators/start/small_coefficients.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace poinsot {
namespace {

// Cholesky's factor of a Gram matrix of some dozens of rows, L of A = L Lᵀ in the place of A's lower triangle, and
// B L⁻ᵀ in the place of the rows B below A; false where A is not positive definite. The zeros of such matrices, whose
// rows act on two bodies each, are passed over.
bool small_cholesky(Eigen::MatrixXd& A) {
  const Eigen::Index n = A.cols(), rows = A.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = &A(j, j);
    for (Eigen::Index k = 0; k < j; ++k) {
      const double factor = A(j, k);
      if (factor == 0) continue;
      const double* other = &A(j, k);
      for (Eigen::Index i = 0; i < rows - j; ++i) column[i] -= factor * other[i];
    }
    if (!(column[0] > 0)) return false;
    const double by = 1 / std::sqrt(column[0]);
    for (Eigen::Index i = 0; i < rows - j; ++i) column[i] *= by;
  }
  return true;
}

// x ← L⁻¹ x and x ← L⁻ᵀ x, L being the first rows of what small_cholesky() made.
void forward(const Eigen::MatrixXd& L, Eigen::Ref<Eigen::VectorXd> x) {
  const Eigen::Index n = L.cols();
  for (Eigen::Index j = 0; j < n; ++j) {
    x[j] /= L(j, j);
    if (x[j] != 0) x.tail(n - j - 1) -= x[j] * L.col(j).segment(j + 1, n - j - 1);
  }
}
void backward(const Eigen::MatrixXd& L, Eigen::Ref<Eigen::VectorXd> x) {
  const Eigen::Index n = L.cols();
  for (Eigen::Index j = n; j-- > 0;)
    x[j] = (x[j] - L.col(j).segment(j + 1, n - j - 1).dot(x.tail(n - j - 1))) / L(j, j);
}

}  // namespace

bool SmallCoefficients::find(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                             Eigen::MatrixXd& C) {
  const auto n = static_cast<Eigen::Index>(kept.size()), m = static_cast<Eigen::Index>(left_out.size());
  place_.resize(rows.size());
  for (Eigen::Index j = 0; j < n; ++j) place_[index(kept[index(j)])] = j;
  for (Eigen::Index d = 0; d < m; ++d) place_[index(left_out[index(d)])] = n + d;
  L_.setZero(n + m, n), C.setZero(n, m);
  rows.for_each_product([&](int k, int l, double product) {
    const auto [j, i] = std::minmax(place_[index(k)], place_[index(l)]);
    if (j < n) L_(i, j) += product;
  });
  if (!small_cholesky(L_)) return false;
  for (Eigen::Index d = 0; d < m; ++d) {
    C.col(d) = L_.row(n + d).transpose();
    backward(L_, C.col(d));
  }
  return C.allFinite();
}

void SmallCoefficients::refine(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                               Eigen::MatrixXd& C) const {
  Eigen::VectorXd left(rows.variables()), change(C.rows());
  for (Eigen::Index d = 0; d < C.cols(); ++d) {
    left.setZero();
    rows.add(1, left_out[index(d)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) rows.add(-C(k, d), kept[index(k)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) change[k] = rows.share(kept[index(k)], left);
    forward(L_, change);
    backward(L_, change);
    C.col(d) += change;
  }
}

}  // namespace poinsot
