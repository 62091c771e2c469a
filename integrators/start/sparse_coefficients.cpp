#include "integrators/start/sparse_coefficients.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr int kColumns = 32;              // that are solved for together
constexpr double kForgettable = 1e-13;    // of the largest number
constexpr double kNoCoefficient = 1e-12;  // of a coefficient beside the row set aside

}  // namespace

SparseEntries unit_null_vector(std::span<const int> kept, const Eigen::Ref<const Eigen::VectorXd>& c, int left_out) {
  SparseEntries z;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (const double by = c[static_cast<Eigen::Index>(k)]; std::abs(by) > kNoCoefficient) z.emplace_back(kept[k], -by);
  z.insert(std::ranges::lower_bound(z, left_out, {}, &SparseEntries::value_type::first), {left_out, 1.0});
  return z;
}

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

std::vector<SparseEntries> SparseCoefficients::null_vectors(const BlockRows& rows, std::span<const int> left_out,
                                                            int refinements) const {
  std::vector<SparseEntries> vectors;
  for (std::size_t first = 0; first < left_out.size(); first += kColumns) {
    const auto some = left_out.subspan(first, std::min<std::size_t>(kColumns, left_out.size() - first));
    const Eigen::MatrixXd C = find(rows, some, refinements);
    if (!C.allFinite()) return {};
    for (std::size_t d = 0; d < some.size(); ++d)
      vectors.push_back(unit_null_vector(kept_, C.col(static_cast<Eigen::Index>(d)), some[d]));
  }
  return vectors;
}

// B ← (G_K G_Kᵀ)⁻¹ B. Eigen takes one column after the other.
void SparseCoefficients::solve(Eigen::MatrixXd& B) const {
  constexpr int kEstimated = 4;
  if (B.cols() <= kEstimated) return solve_together<kEstimated>(B);
  for (Eigen::Index first = 0; first < B.cols(); first += kColumns)
    solve_together<kColumns>(B.middleCols(first, std::min<Eigen::Index>(kColumns, B.cols() - first)));
}

// Of rows left out next to each other most are 0 in the forward pass, and coefficients far from them are negligible.
template <int N>
void SparseCoefficients::solve_together(Eigen::Ref<Eigen::MatrixXd> B) const {
  const Eigen::SparseMatrix<double>& L = factored_.matrixL().nestedExpression();
  const Eigen::VectorXd D = factored_.vectorD();
  const auto place = [&](Eigen::Index k) { return factored_.permutationP().indices()[k]; };
  Eigen::Matrix<double, Eigen::Dynamic, N, Eigen::RowMajor> x(B.rows(), N);
  x.setZero();
  for (Eigen::Index k = 0; k < B.rows(); ++k) x.row(place(k)).head(B.cols()) = B.row(k);
  std::vector<char> counts(index(B.rows()));
  for (Eigen::Index j = 0; j < x.rows(); ++j) {
    counts[index(j)] = !x.row(j).isZero(0);
    if (!counts[index(j)]) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it)
      if (it.row() > j) x.row(it.row()) -= it.value() * x.row(j);
  }
  const double negligible = kForgettable * x.cwiseAbs().maxCoeff();
  for (Eigen::Index j = x.rows(); j-- > 0;) {
    if (counts[index(j)]) x.row(j) /= D[j];
    for (Eigen::SparseMatrix<double>::InnerIterator it(L, j); it; ++it)
      if (it.row() > j && counts[index(it.row())]) {
        x.row(j) -= it.value() * x.row(it.row());
        counts[index(j)] = 1;
      }
    if (counts[index(j)] && x.row(j).cwiseAbs().maxCoeff() <= negligible) {
      x.row(j).setZero();
      counts[index(j)] = 0;
    }
  }
  for (Eigen::Index k = 0; k < B.rows(); ++k) B.row(k) = x.row(place(k)).head(B.cols());
}

}  // namespace poinsot
