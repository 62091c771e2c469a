// Eigen's SparseLU (after SuperLU): supernodal LU with new pivots at every factorization.
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "linsolve/back_ends.h"
#include "linsolve/scaled_lu.h"

namespace poinsot {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// Eigen shows its factors only as operators; a derived class may read them.
class Factors : public Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> {
 public:
  double pivot(Eigen::Index j) const {
    for (SCMatrix::InnerIterator it(m_Lstore, j); it; ++it)
      if (it.index() == j) return it.value();
    return 0;
  }
  // The column of the matrix that has pivot k.
  int column(Eigen::Index k) const {
    const auto& order = m_perm_c.indices();
    return static_cast<int>(std::find(order.begin(), order.end(), k) - order.begin());
  }
};

class EigenSparseLu final : public ScaledLu {
 public:
  std::uint64_t orientation() override { return lu_.signDeterminant() < 0 ? 2 : 1; }

 private:
  LinearStatus do_symbolic() override {
    const int n = layout().n;
    x_.resize(n);
    matrix_ = Eigen::Map<const Matrix>(n, n, layout().nonzeros(), layout().start.data(), layout().row.data(),
                                       scaled().data());
    lu_.analyzePattern(matrix_);
    return {};
  }

  LinearStatus do_fresh() override {
    std::ranges::copy(scaled(), matrix_.valuePtr());
    lu_.factorize(matrix_);
    if (lu_.info() != Eigen::Success) return singular(-1);  // an exact zero; Eigen says where in words only
    statistics_.factor_nonzeros = static_cast<std::int64_t>(lu_.nnzL() + lu_.nnzU()) - layout().n;
    return {};
  }

  void do_substitute(std::span<double> b) override {
    Eigen::Map<Eigen::VectorXd> map(b.data(), layout().n);
    x_ = lu_.solve(map);
    map = x_;
  }

  void do_substitute_transposed(std::span<double> b) override {
    Eigen::Map<Eigen::VectorXd> map(b.data(), layout().n);
    x_ = lu_.transpose().solve(map);
    map = x_;
  }

  double pivot(int k) override { return lu_.pivot(k); }
  int pivot_column(int k) override { return lu_.column(k); }

  Matrix matrix_;  // scaled
  Factors lu_;
  Eigen::VectorXd x_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_eigen_sparselu() {
  return std::make_unique<EigenSparseLu>();
}

}  // namespace poinsot
