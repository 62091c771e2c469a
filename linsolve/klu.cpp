// KLU (T. Davis and E. Palamadai Natarajan, Algorithm 907): fresh pivots once, then refactorizations that keep them.
//
// Pivots chosen for other values can turn bad. After each refactorization every pivot is compared with its value at the
// last fresh factorization; a pivot a hundred times smaller or larger, or a hundredfold loss of reciprocal growth,
// is answered by fresh pivots for the same values.
#include <klu.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "linsolve/back_ends.h"
#include "linsolve/scaled_lu.h"

namespace poinsot {
namespace {

constexpr double kPivotRange = 100;

class Klu final : public ScaledLu {
 public:
  Klu() {
    klu_defaults(&common_);
    common_.scale = -1;  // the matrix comes scaled and checked
    common_.halt_if_singular = 0;
    common_.maxwork = 20;  // times the entries, for the search of a block triangular form: enough where there is one
    common_.tol = 0.1;     // with the default of 1e-3 backward errors reach 1e-11 on loops
  }
  ~Klu() override { release(); }

 private:
  LinearStatus do_symbolic() override {
    release();
    fresh_pivots_.assign(static_cast<std::size_t>(layout().n), 0);
    // The block triangular form helps small kinematic matrices. A saddle point has none, and the search for it takes
    // time in the square of n there.
    constexpr int kLargestSearched = 20000;
    common_.btf = layout().n <= kLargestSearched;
    symbolic_ = klu_analyze(layout().n, start(), row(), &common_);
    return symbolic_ ? LinearStatus{} : library_status();
  }

  bool do_refactor() override {
    return klu_refactor(start(), row(), scaled().data(), symbolic_, numeric_, &common_) && common_.status == KLU_OK &&
           pivots_still_good();
  }

  LinearStatus do_fresh() override {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    numeric_ = klu_factor(start(), row(), scaled().data(), symbolic_, &common_);
    if (!numeric_) return library_status();
    statistics_.factor_nonzeros = std::int64_t{numeric_->lnz} + numeric_->unz + numeric_->nzoff - layout().n;
    std::ranges::copy(pivots(), fresh_pivots_.begin());
    fresh_growth_ = reciprocal_growth();
    return {};
  }

  void do_substitute(std::span<double> b) override {
    klu_solve(symbolic_, numeric_, layout().n, 1, b.data(), &common_);
  }

  double pivot(int k) override { return fresh_pivots_[static_cast<std::size_t>(k)]; }
  int pivot_column(int k) override { return symbolic_->Q[k]; }

  bool pivots_still_good() {
    bool good = true;
    for (std::size_t k = 0; k < fresh_pivots_.size(); ++k) {
      const double now = std::abs(pivots()[k]), then = std::abs(fresh_pivots_[k]);
      good = good && now * kPivotRange >= then && now <= then * kPivotRange;
    }
    return good && reciprocal_growth() * kPivotRange >= fresh_growth_;
  }

  // min over columns of max|A| / max|U|.
  double reciprocal_growth() {
    klu_rgrowth(start(), row(), scaled().data(), symbolic_, numeric_, &common_);
    return common_.rgrowth;
  }

  std::span<const double> pivots() const { return {static_cast<const double*>(numeric_->Udiag), fresh_pivots_.size()}; }

  LinearStatus library_status() const {
    if (common_.status == KLU_OUT_OF_MEMORY) return {LinearFailure::out_of_memory, -1, "not enough memory for KLU"};
    check(common_.status == KLU_TOO_LARGE, "KLU accepts the matrix");
    return {LinearFailure::refused, -1, "the factors have more entries than KLU's 32-bit indices can count"};
  }

  // KLU only reads these, though its interface does not say so.
  int* start() { return const_cast<int*>(layout().start.data()); }
  int* row() { return const_cast<int*>(layout().row.data()); }

  void release() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }

  std::vector<double> fresh_pivots_;
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
