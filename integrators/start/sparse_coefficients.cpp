#include "integrators/start/sparse_coefficients.h"

#include <algorithm>

#include "core/index.h"

namespace poinsot {

SparseCoefficients::SparseCoefficients(const BlockRows& rows, std::span<const int> kept)
    : kept_(kept.begin(), kept.end()) {
  const int n = static_cast<int>(kept_.size());
  place_.assign(rows.size(), -1);
  for (int j = 0; j < n; ++j) place_[index(kept_[index(j)])] = j;
  const Lists below = Lists::collect(n, [&](auto&& emit) {
    for (int j = 0; j < n; ++j)
      rows.for_each_beside(kept_[index(j)], [&](int l) {
        if (place_[index(l)] >= j) emit(j, place_[index(l)]);
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
  Eigen::MatrixXd C = shares(rows, F);
  solve(C);
  for (int r = 0; r < refinements; ++r) refine(rows, F, C);
  return C;
}

Eigen::MatrixXd SparseCoefficients::find(const BlockRows& rows, std::span<const int> left_out, int refinements) const {
  const auto n = static_cast<Eigen::Index>(kept_.size()), m = static_cast<Eigen::Index>(left_out.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, m);
  for (Eigen::Index d = 0; d < m; ++d)
    rows.for_each_beside(left_out[index(d)], [&](int l) {
      if (place_[index(l)] >= 0) C(place_[index(l)], d) = rows.dot(l, left_out[index(d)]);
    });
  solve(C);
  if (refinements == 0) return C;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(rows.variables(), m);
  for (Eigen::Index d = 0; d < m; ++d) rows.add(1, left_out[index(d)], F.col(d));
  for (int r = 0; r < refinements; ++r) refine(rows, F, C);
  return C;
}

// C is corrected by what it leaves of F.
void SparseCoefficients::refine(const BlockRows& rows, Eigen::MatrixXd F, Eigen::MatrixXd& C) const {
  for (Eigen::Index c = 0; c < C.cols(); ++c)
    for (std::size_t k = 0; k < kept_.size(); ++k) rows.add(-C(static_cast<Eigen::Index>(k), c), kept_[k], F.col(c));
  Eigen::MatrixXd change = shares(rows, F);
  solve(change);
  C += change;
}

// B ← (G_K G_Kᵀ)⁻¹ B. Eigen takes one column after the other; here many go together, and those of rows left out next to
// each other are 0 in most of the forward pass.
void SparseCoefficients::solve(Eigen::MatrixXd& B) const {
  constexpr int kTogether = 32;
  if (B.cols() < kTogether / 4) {
    B = factored_.solve(B).eval();
    return;
  }
  const Eigen::SparseMatrix<double>& L = factored_.matrixL().nestedExpression();
  const Eigen::VectorXd by_D = factored_.vectorD().cwiseInverse();
  Eigen::Matrix<double, Eigen::Dynamic, kTogether, Eigen::RowMajor> x(B.rows(), kTogether);
  for (Eigen::Index first = 0; first < B.cols(); first += kTogether) {
    const Eigen::Index count = std::min<Eigen::Index>(kTogether, B.cols() - first);
    auto some = B.middleCols(first, count);
    x.setZero();
    for (Eigen::Index k = 0; k < B.rows(); ++k) x.row(factored_.permutationP().indices()[k]).head(count) = some.row(k);
    for (Eigen::Index j = 0; j < x.rows(); ++j) {
      if (x.row(j).isZero(0)) continue;
      for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it)
        if (it.row() > j) x.row(it.row()) -= it.value() * x.row(j);
    }
    for (Eigen::Index j = x.rows(); j-- > 0;) {
      x.row(j) *= by_D[j];
      for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it)
        if (it.row() > j) x.row(j) -= it.value() * x.row(it.row());
    }
    for (Eigen::Index k = 0; k < B.rows(); ++k) some.row(k) = x.row(factored_.permutationP().indices()[k]).head(count);
  }
}

}  // namespace poinsot
