// UMFPACK (T. Davis, Algorithm 832): multifrontal LU with new pivots at every factorization.
#include <umfpack.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "linsolve/back_ends.h"
#include "linsolve/scaled_lu.h"

namespace poinsot {
namespace {

class Umfpack final : public ScaledLu {
 public:
  Umfpack() {
    umfpack_di_defaults(control_);
    control_[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;  // the matrix comes scaled
    control_[UMFPACK_IRSTEP] = 0;                  // as every other solver here: one substitution
    control_[UMFPACK_AGGRESSIVE] = 0;              // with it residuals are up to 3.5e-14, without 6e-16
  }
  ~Umfpack() override { release(); }

  std::uint64_t orientation() override {
    bool negative = odd(0, layout().n, [this](int k) { return rows_[static_cast<std::size_t>(k)]; }) !=
                    odd(0, layout().n, [this](int k) { return columns_[static_cast<std::size_t>(k)]; });
    for (double pivot : pivots_) negative ^= pivot < 0;
    return negative ? 2 : 1;
  }

 private:
  LinearStatus do_symbolic() override {
    release();
    const auto n = static_cast<std::size_t>(layout().n);
    x_.assign(n, 0);
    pivots_.assign(n, 0);
    rows_.assign(n, 0);
    columns_.assign(n, 0);
    index_work_.assign(n, 0);
    work_.assign(5 * n, 0);
    return library_status(umfpack_di_symbolic(layout().n, layout().n, layout().start.data(), layout().row.data(),
                                              nullptr, &symbolic_, control_, nullptr));
  }

  LinearStatus do_fresh() override {
    umfpack_di_free_numeric(&numeric_);
    double info[UMFPACK_INFO];
    const int answer = umfpack_di_numeric(layout().start.data(), layout().row.data(), scaled().data(), symbolic_,
                                          &numeric_, control_, info);
    if (answer != UMFPACK_WARNING_singular_matrix)
      if (LinearStatus status = library_status(answer); !status.ok()) return status;
    statistics_.factor_nonzeros = static_cast<std::int64_t>(info[UMFPACK_LNZ] + info[UMFPACK_UNZ]) - layout().n;
    int reciprocal = 0;
    check(umfpack_di_get_numeric(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, rows_.data(), columns_.data(),
                                 pivots_.data(), &reciprocal, nullptr, numeric_) == UMFPACK_OK,
          "UMFPACK shows its pivots");
    return {};
  }

  void do_substitute(std::span<double> b) override { substitute(UMFPACK_A, b); }
  void do_substitute_transposed(std::span<double> b) override { substitute(UMFPACK_At, b); }

  void substitute(int system, std::span<double> b) {
    umfpack_di_wsolve(system, layout().start.data(), layout().row.data(), scaled().data(), x_.data(), b.data(),
                      numeric_, control_, nullptr, index_work_.data(), work_.data());
    std::ranges::copy(x_, b.begin());
  }

  double pivot(int k) override { return pivots_[static_cast<std::size_t>(k)]; }
  int pivot_column(int k) override { return columns_[static_cast<std::size_t>(k)]; }

  static LinearStatus library_status(int answer) {
    if (answer == UMFPACK_OK) return {};
    if (answer == UMFPACK_ERROR_out_of_memory)
      return {LinearFailure::out_of_memory, -1, "not enough memory for UMFPACK"};
    check(answer == UMFPACK_ERROR_ordering_failed, "UMFPACK accepts the matrix");
    return {LinearFailure::refused, -1, "UMFPACK found no ordering for the matrix"};
  }

  void release() {
    umfpack_di_free_numeric(&numeric_);
    umfpack_di_free_symbolic(&symbolic_);
  }

  std::vector<double> x_, pivots_, work_;
  std::vector<int> rows_, columns_, index_work_;
  double control_[UMFPACK_CONTROL];
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack() {
  return std::make_unique<Umfpack>();
}

}  // namespace poinsot
