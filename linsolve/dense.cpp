// LU with partial pivoting of the full equilibrated matrix, columns stored one after the other: P A = L U.
#include <algorithm>
#include <cmath>

#include "linsolve/back_ends.h"
#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/singularity.h"

namespace poinsot {
namespace {

constexpr int kLargest = 2000;  // 32 MB, and already seconds a factorization

class Dense final : public LinearSolver {
 private:
  LinearStatus do_analyze(const Pattern& pattern) override {
    if (pattern.n > kLargest)
      return {LinearFailure::refused, -1,
              "linear solver dense takes at most " + std::to_string(kLargest) + " unknowns, these are " +
                  std::to_string(pattern.n) + "; klu takes them"};
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    slots_ = layout_.slots;
    n_ = static_cast<std::size_t>(pattern.n);
    values_.assign(static_cast<std::size_t>(layout_.nonzeros()), 0);
    scaled_.assign(values_.size(), 0);
    lu_.assign(n_ * n_, 0);
    swap_.assign(n_, 0);
    equilibration_.resize(pattern.n);
    inverse_norm_.resize(pattern.n);
    statistics_.nonzeros = layout_.nonzeros();
    statistics_.factor_nonzeros = static_cast<std::int64_t>(n_ * n_);
    return {};
  }

  LinearStatus do_factor() override {
    if (!equilibration_.find(layout_, values_) || !equilibration_.scale(layout_, values_, scaled_))
      return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    ++statistics_.factorizations;
    statistics_.reciprocal_condition = 0;
    std::ranges::fill(lu_, 0.0);
    for (std::size_t j = 0; j < n_; ++j)
      for (auto k = static_cast<std::size_t>(layout_.start[j]); k < static_cast<std::size_t>(layout_.start[j + 1]); ++k)
        column(j)[layout_.row[k]] = scaled_[k];

    double smallest = HUGE_VAL;
    for (std::size_t k = 0; k < n_; ++k) {
      double* ck = column(k);
      std::size_t p = k;
      for (std::size_t i = k + 1; i < n_; ++i)
        if (std::abs(ck[i]) > std::abs(ck[p])) p = i;
      swap_[k] = p;
      if (ck[p] == 0) return singular_status(static_cast<int>(k));
      if (p != k)
        for (std::size_t j = 0; j < n_; ++j) std::swap(column(j)[k], column(j)[p]);
      smallest = std::min(smallest, std::abs(ck[k]));
      const double inverse = 1 / ck[k];
      for (std::size_t i = k + 1; i < n_; ++i) ck[i] *= inverse;
      for (std::size_t j = k + 1; j < n_; ++j) {
        double* cj = column(j);
        const double u = cj[k];
        if (u == 0) continue;  // most of a saddle point
        for (std::size_t i = k + 1; i < n_; ++i) cj[i] -= ck[i] * u;
      }
    }
    // Entries are at most one and partial pivoting lets them grow little: without a small pivot no ratio is small.
    if (smallest >= kDoubtfulPivotRatio) return {};
    const PivotRatio ratio = worst_pivot();
    if (is_singular(ratio.smallest)) return singular_status(ratio.k);
    statistics_.reciprocal_condition =
        1 / (one_norm(layout_, scaled_) *
             inverse_norm_.estimate([&](std::span<double> x) { substitute(x.data()); },
                                    [&](std::span<double> x) { substitute_transposed(x.data()); }));
    if (is_doubtful(ratio.smallest) && !(statistics_.reciprocal_condition >= kSingularCondition))
      return singular_status(ratio.k);
    return {};
  }

  LinearStatus do_solve(std::span<double> b) override {
    equilibration_.scale_right_hand_side(b);
    substitute(b.data());
    equilibration_.scale_solution(b);
    return {};
  }

  void substitute(double* x) const {
    for (std::size_t k = 0; k < n_; ++k) std::swap(x[k], x[swap_[k]]);
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = k + 1; i < n_; ++i) x[i] -= column(k)[i] * x[k];
    for (std::size_t k = n_; k-- > 0;) {
      x[k] /= column(k)[k];
      for (std::size_t i = 0; i < k; ++i) x[i] -= column(k)[i] * x[k];
    }
  }

  void substitute_transposed(double* x) const {
    for (std::size_t k = 0; k < n_; ++k) {
      for (std::size_t i = 0; i < k; ++i) x[k] -= column(k)[i] * x[i];
      x[k] /= column(k)[k];
    }
    for (std::size_t k = n_; k-- > 0;)
      for (std::size_t i = k + 1; i < n_; ++i) x[k] -= column(k)[i] * x[i];
    for (std::size_t k = n_; k-- > 0;) std::swap(x[k], x[swap_[k]]);
  }

  PivotRatio worst_pivot() const {
    PivotRatio worst;
    for (std::size_t k = 0; k < n_; ++k) {
      double cancelled = 0;
      for (std::size_t j = 0; j < k; ++j) cancelled += std::abs(column(j)[k]) * std::abs(column(k)[j]);
      const double pivot = std::abs(column(k)[k]), ratio = pivot / (pivot + cancelled);
      if (!(ratio >= worst.smallest)) worst = {ratio, static_cast<int>(k)};
    }
    return worst;
  }

  double* column(std::size_t j) { return lu_.data() + j * n_; }
  const double* column(std::size_t j) const { return lu_.data() + j * n_; }

  CscLayout layout_;
  Equilibration equilibration_;
  InverseNorm inverse_norm_;
  std::size_t n_ = 0;
  std::vector<double> scaled_, lu_;
  std::vector<std::size_t> swap_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_dense() {
  return std::make_unique<Dense>();
}

}  // namespace poinsot
