#include "integrators/start/sparse_coefficients.h"

#include "core/index.h"

namespace poinsot {

SparseCoefficients::SparseCoefficients(const BlockRows& rows, std::span<const int> kept)
    : kept_(kept.begin(), kept.end()) {
  const int n = static_cast<int>(kept_.size());
  std::vector<int> place(rows.size(), -1);
  for (int j = 0; j < n; ++j) place[index(kept_[index(j)])] = j;
  const Lists below = Lists::collect(n, [&](auto&& emit) {
    for (int j = 0; j < n; ++j)
      rows.for_each_beside(kept_[index(j)], [&](int l) {
        if (place[index(l)] >= j) emit(j, place[index(l)]);
      });
  });
  gram_.resize(n, n);
  for (int j = 0; j < n; ++j) {
    gram_.startVec(j);
    for (const int i : below[j]) gram_.insertBack(i, j) = i == j ? 1.0 : 0.0;
  }
  gram_.finalize();
  factored_.analyzePattern(gram_);
}

bool SparseCoefficients::factor(const BlockRows& rows) {
  for (Eigen::Index j = 0; j < gram_.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram_, j); it; ++it)
      it.valueRef() = rows.dot(kept_[index(it.row())], kept_[index(j)]);
  factored_.factorize(gram_);
  return factored_.info() == Eigen::Success;
}

// G_K F
Eigen::MatrixXd SparseCoefficients::shares(const BlockRows& rows, const Eigen::MatrixXd& F) const {
  Eigen::MatrixXd of(static_cast<Eigen::Index>(kept_.size()), F.cols());
  for (Eigen::Index c = 0; c < F.cols(); ++c)
    for (std::size_t k = 0; k < kept_.size(); ++k) of(static_cast<Eigen::Index>(k), c) = rows.share(kept_[k], F.col(c));
  return of;
}

Eigen::MatrixXd SparseCoefficients::find(const BlockRows& rows, const Eigen::MatrixXd& F, int refinements) const {
  Eigen::MatrixXd C = factored_.solve(shares(rows, F));
  for (int r = 0; r < refinements; ++r) {
    Eigen::MatrixXd left = F;
    for (Eigen::Index c = 0; c < F.cols(); ++c)
      for (std::size_t k = 0; k < kept_.size(); ++k)
        rows.add(-C(static_cast<Eigen::Index>(k), c), kept_[k], left.col(c));
    C += factored_.solve(shares(rows, left));
  }
  return C;
}

}  // namespace poinsot
