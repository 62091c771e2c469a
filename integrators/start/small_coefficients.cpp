#include "integrators/start/small_coefficients.h"

#include "core/index.h"
#include "integrators/start/small_cholesky.h"

namespace poinsot {

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
