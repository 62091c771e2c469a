// KLU (T. Davis and E. Palamadai Natarajan, Algorithm 907): fresh pivots once, then refactorizations that keep them.
//
// Pivots chosen for other values can turn bad. After each refactorization every pivot is compared with its value at the
// last fresh factorization; a pivot that left three decades around it, or a loss of reciprocal growth of the same size,
// is answered by fresh pivots for the same values. Three decades is what KLU's own threshold pivoting (tol = 1e-3)
// concedes to an entry, so a kept pivot order is never trusted with more than a fresh one.
#include <klu.h>

#include <cmath>

#include "core/check.h"
#include "linsolve/back_ends.h"
#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/singularity.h"

namespace poinsot {
namespace {

constexpr double kPivotRange = 1e3;

class Klu final : public LinearSolver {
 public:
  Klu() {
    klu_defaults(&common_);
    common_.scale = -1;  // the matrix comes equilibrated and checked
  }
  ~Klu() override { release(); }

 private:
  LinearStatus do_analyze(const Pattern& pattern) override {
    release();
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    slots_ = layout_.slots;
    const auto nonzeros = static_cast<std::size_t>(layout_.nonzeros()), n = static_cast<std::size_t>(layout_.n);
    values_.assign(nonzeros, 0);
    scaled_.assign(nonzeros, 0);
    fresh_pivots_.assign(n, 0);
    work_.assign(n, 0);
    equilibration_.resize(layout_.n);
    inverse_norm_.resize(layout_.n);
    statistics_.nonzeros = layout_.nonzeros();
    symbolic_ = klu_analyze(layout_.n, layout_.start.data(), layout_.row.data(), &common_);
    return symbolic_ ? LinearStatus{} : library_status();
  }

  LinearStatus do_factor() override {
    if (numeric_) {
      if (!equilibration_.scale(layout_, values_, scaled_)) return not_finite();
      if (klu_refactor(layout_.start.data(), layout_.row.data(), scaled_.data(), symbolic_, numeric_, &common_) &&
          common_.status == KLU_OK && pivots_still_good()) {
        ++statistics_.refactorizations;
        return {};
      }
      klu_free_numeric(&numeric_, &common_);
    }
    return factor_fresh();
  }

  LinearStatus factor_fresh() {
    if (!equilibration_.find(layout_, values_) || !equilibration_.scale(layout_, values_, scaled_)) return not_finite();
    ++statistics_.factorizations;
    statistics_.reciprocal_condition = 0;
    numeric_ = klu_factor(layout_.start.data(), layout_.row.data(), scaled_.data(), symbolic_, &common_);
    if (common_.status == KLU_SINGULAR) return reject(singular_status(common_.singular_col));
    if (!numeric_) return library_status();
    const int n = layout_.n;
    statistics_.factor_nonzeros = std::int64_t{numeric_->lnz} + numeric_->unz + numeric_->nzoff - n;

    klu_rgrowth(layout_.start.data(), layout_.row.data(), scaled_.data(), symbolic_, numeric_, &common_);
    fresh_growth_ = common_.rgrowth;
    const auto* pivots = static_cast<const double*>(numeric_->Udiag);
    std::copy(pivots, pivots + n, fresh_pivots_.begin());

    const double inverse_norm =
        inverse_norm_.estimate([&](std::span<double> x) { klu_solve(symbolic_, numeric_, n, 1, x.data(), &common_); },
                               [&](std::span<double> x) { klu_tsolve(symbolic_, numeric_, n, 1, x.data(), &common_); });
    statistics_.reciprocal_condition = 1 / (inverse_norm * one_norm(layout_, scaled_));
    const PivotRatio ratio = worst_pivot();
    if (is_singular(ratio.smallest) ||
        (is_doubtful(ratio.smallest) && !(statistics_.reciprocal_condition >= kSingularCondition)))
      return reject(singular_status(symbolic_->Q[ratio.k]));
    return {};
  }

  LinearStatus do_solve(std::span<double> b) override {
    equilibration_.scale_right_hand_side(b);
    klu_solve(symbolic_, numeric_, layout_.n, 1, b.data(), &common_);
    equilibration_.scale_solution(b);
    return {};
  }

  bool pivots_still_good() {
    const auto* pivots = static_cast<const double*>(numeric_->Udiag);
    bool good = true;
    for (std::size_t k = 0; k < fresh_pivots_.size(); ++k) {
      const double now = std::abs(pivots[k]), then = std::abs(fresh_pivots_[k]);
      good = good && now * kPivotRange >= then && now <= then * kPivotRange;
    }
    if (!good) return false;
    klu_rgrowth(layout_.start.data(), layout_.row.data(), scaled_.data(), symbolic_, numeric_, &common_);
    return common_.rgrowth * kPivotRange >= fresh_growth_;
  }

  PivotRatio worst_pivot() {
    const auto n = static_cast<std::size_t>(layout_.n);
    for (auto* f : {&l_columns_, &u_columns_}) f->start.resize(n + 1);
    l_columns_.index.resize(static_cast<std::size_t>(numeric_->lnz));
    l_columns_.value.resize(static_cast<std::size_t>(numeric_->lnz));
    u_columns_.index.resize(static_cast<std::size_t>(numeric_->unz));
    u_columns_.value.resize(static_cast<std::size_t>(numeric_->unz));
    klu_extract(numeric_, symbolic_, l_columns_.start.data(), l_columns_.index.data(), l_columns_.value.data(),
                u_columns_.start.data(), u_columns_.index.data(), u_columns_.value.data(), nullptr, nullptr, nullptr,
                nullptr, nullptr, nullptr, nullptr, &common_);
    transpose(l_columns_, l_rows_);
    return pivot_ratio(l_rows_, u_columns_, fresh_pivots_, work_);
  }

  static LinearStatus not_finite() {
    return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
  }

  LinearStatus library_status() {
    if (common_.status == KLU_OUT_OF_MEMORY) return {LinearFailure::out_of_memory, -1, "not enough memory for KLU"};
    check(common_.status == KLU_TOO_LARGE, "KLU accepts the matrix");
    return {LinearFailure::refused, -1, "the factors have more entries than KLU's 32-bit indices can count"};
  }

  LinearStatus reject(LinearStatus status) {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    return status;
  }

  void release() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }

  CscLayout layout_;
  Equilibration equilibration_;
  InverseNorm inverse_norm_;
  std::vector<double> scaled_, fresh_pivots_, work_;
  CompressedFactor l_columns_, u_columns_, l_rows_;
  double fresh_growth_ = 0;
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_klu() {
  return std::make_unique<Klu>();
}

}  // namespace poinsot
