// Eigen's SparseLU (after SuperLU): supernodal LU of the equilibrated matrix, new pivots at every factorization.
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include "linsolve/back_ends.h"
#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/singularity.h"

namespace poinsot {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// Eigen shows its factors only as operators; a derived class may read them.
class Factors : public Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> {
 public:
  void pivots(std::vector<double>& out) const {
    for (Eigen::Index j = 0; j < cols(); ++j)
      for (SCMatrix::InnerIterator it(m_Lstore, j); it; ++it)
        if (it.index() == j) out[static_cast<std::size_t>(j)] = it.value();
  }

  void columns(CompressedFactor& l, CompressedFactor& u) const {
    for (auto* f : {&l, &u}) {
      f->start.assign(1, 0);
      f->index.clear();
      f->value.clear();
    }
    const auto add = [](CompressedFactor& f, Eigen::Index i, double value) {
      f.index.push_back(static_cast<int>(i));
      f.value.push_back(value);
    };
    for (Eigen::Index j = 0; j < cols(); ++j) {
      for (SCMatrix::InnerIterator it(m_Lstore, j); it; ++it) add(it.index() > j ? l : u, it.index(), it.value());
      for (decltype(m_Ustore)::InnerIterator it(m_Ustore, j); it; ++it) add(u, it.index(), it.value());
      for (auto* f : {&l, &u}) f->start.push_back(static_cast<int>(f->index.size()));
    }
  }
};

class EigenSparseLu final : public LinearSolver {
 private:
  LinearStatus do_analyze(const Pattern& pattern) override {
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    slots_ = layout_.slots;
    const auto n = static_cast<std::size_t>(layout_.n);
    values_.assign(static_cast<std::size_t>(layout_.nonzeros()), 0);
    pivots_.assign(n, 0);
    work_.assign(n, 0);
    x_.resize(layout_.n);
    equilibration_.resize(layout_.n);
    inverse_norm_.resize(layout_.n);
    matrix_ = Eigen::Map<const Matrix>(layout_.n, layout_.n, layout_.nonzeros(), layout_.start.data(),
                                       layout_.row.data(), values_.data());
    statistics_.nonzeros = layout_.nonzeros();
    lu_.analyzePattern(matrix_);
    return {};
  }

  LinearStatus do_factor() override {
    const std::span<double> scaled(matrix_.valuePtr(), values_.size());
    if (!equilibration_.find(layout_, values_) || !equilibration_.scale(layout_, values_, scaled))
      return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    ++statistics_.factorizations;
    statistics_.reciprocal_condition = 0;
    lu_.factorize(matrix_);
    if (lu_.info() != Eigen::Success) return singular_status(-1);  // an exact zero; Eigen says where in words only
    statistics_.factor_nonzeros = static_cast<std::int64_t>(lu_.nnzL() + lu_.nnzU() - layout_.n);

    lu_.pivots(pivots_);
    double smallest = HUGE_VAL;
    for (const double p : pivots_) smallest = std::min(smallest, std::abs(p));
    // Entries are at most one and partial pivoting lets them grow little: without a small pivot no ratio is small.
    if (smallest >= kDoubtfulPivotRatio) return {};
    lu_.columns(l_columns_, u_columns_);
    transpose(l_columns_, l_rows_);
    const PivotRatio ratio = pivot_ratio(l_rows_, u_columns_, pivots_, work_);
    const int column = ratio.k < 0 ? -1 : lu_.colsPermutation().inverse().eval().indices()[ratio.k];
    if (is_singular(ratio.smallest)) return singular_status(column);
    statistics_.reciprocal_condition =
        1 / (one_norm(layout_, scaled) * inverse_norm_.estimate([&](std::span<double> x) { substitute(x); },
                                                                [&](std::span<double> x) {
                                                                  Eigen::Map<Eigen::VectorXd> b(x.data(), layout_.n);
                                                                  x_ = lu_.transpose().solve(b);
                                                                  b = x_;
                                                                }));
    if (is_doubtful(ratio.smallest) && !(statistics_.reciprocal_condition >= kSingularCondition))
      return singular_status(column);
    return {};
  }

  LinearStatus do_solve(std::span<double> b) override {
    equilibration_.scale_right_hand_side(b);
    substitute(b);
    equilibration_.scale_solution(b);
    return {};
  }

  void substitute(std::span<double> b) {
    Eigen::Map<Eigen::VectorXd> map(b.data(), layout_.n);
    x_ = lu_.solve(map);
    map = x_;
  }

  CscLayout layout_;
  Equilibration equilibration_;
  InverseNorm inverse_norm_;
  Matrix matrix_;  // equilibrated
  Factors lu_;
  Eigen::VectorXd x_;
  std::vector<double> pivots_, work_;
  CompressedFactor l_columns_, u_columns_, l_rows_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_eigen_sparselu() {
  return std::make_unique<EigenSparseLu>();
}

}  // namespace poinsot
