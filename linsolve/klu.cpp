// KLU (T. Davis and E. Palamadai Natarajan, Algorithm 907): fresh pivots once, then refactorizations that keep them.
//
// Pivots chosen for other values can turn bad. After each refactorization every pivot is compared with its value at the
// last fresh factorization; a pivot a hundred times smaller or larger, or a hundredfold loss of reciprocal growth,
// is answered by fresh pivots for the same values.
#include <klu.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
    common_.tol = 0.1;  // with the default of 1e-3 backward errors reach 1e-11 on loops
  }
  ~Klu() override { release(); }

 private:
  // Two orders compete at the first factorization, and the one with fewer entries in the factors stays: AMD after a
  // permutation to block triangular form (chains, trees, determined mechanisms) and COLAMD (loops). The search for that
  // form takes time in the square of n on saddle points.
  LinearStatus do_symbolic() override {
    constexpr int kLargestSearched = 20000;
    release();
    fresh_pivots_.assign(static_cast<std::size_t>(layout().n), 0);
    if (layout().n <= kLargestSearched) symbolic_ = analyze(0, true);
    rival_ = analyze(1, false);
    if (!symbolic_) std::swap(symbolic_, rival_);
    return symbolic_ ? LinearStatus{} : library_status();
  }

  klu_symbolic* analyze(int ordering, bool block_triangular) {
    common_.ordering = ordering;
    common_.btf = block_triangular;
    return klu_analyze(layout().n, start(), row(), &common_);
  }

  bool do_refactor() override {
    return klu_refactor(start(), row(), scaled().data(), symbolic_, numeric_, &common_) && common_.status == KLU_OK &&
           pivots_still_good();
  }

  LinearStatus do_fresh() override {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    numeric_ = klu_factor(start(), row(), scaled().data(), symbolic_, &common_);
    if (!numeric_) return library_status();
    if (rival_) compare();
    statistics_.factor_nonzeros = entries(*numeric_);
    std::ranges::copy(pivots(), fresh_pivots_.begin());
    fresh_growth_ = reciprocal_growth();
    return {};
  }

  void do_substitute(std::span<double> b) override {
    klu_solve(symbolic_, numeric_, layout().n, 1, b.data(), &common_);
  }

  double pivot(int k) override { return fresh_pivots_[static_cast<std::size_t>(k)]; }
  int pivot_column(int k) override { return symbolic_->Q[k]; }

  void compare() {
    klu_numeric* other = klu_factor(start(), row(), scaled().data(), rival_, &common_);
    if (other && entries(*other) < entries(*numeric_)) {
      std::swap(numeric_, other);
      std::swap(symbolic_, rival_);
    }
    if (other) klu_free_numeric(&other, &common_);
    klu_free_symbolic(&rival_, &common_);
  }

  static std::int64_t entries(const klu_numeric& n) { return std::int64_t{n.lnz} + n.unz + n.nzoff - n.n; }

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
    if (rival_) klu_free_symbolic(&rival_, &common_);
  }

  std::vector<double> fresh_pivots_;
  double fresh_growth_ = 0;
  klu_common common_;
  klu_symbolic *symbolic_ = nullptr, *rival_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_klu() {
  return std::make_unique<Klu>();
}

}  // namespace poinsot
