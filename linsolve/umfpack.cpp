// UMFPACK (T. Davis, Algorithm 832): multifrontal LU of the equilibrated matrix, new pivots at every factorization.
#include <umfpack.h>

#include "core/check.h"
#include "linsolve/back_ends.h"
#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/singularity.h"

namespace poinsot {
namespace {

class Umfpack final : public LinearSolver {
 public:
  Umfpack() {
    umfpack_di_defaults(control_);
    control_[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;  // the matrix comes equilibrated
    control_[UMFPACK_IRSTEP] = 0;                  // as every other solver here: one substitution
  }
  ~Umfpack() override { release(); }

 private:
  LinearStatus do_analyze(const Pattern& pattern) override {
    release();
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    slots_ = layout_.slots;
    const auto n = static_cast<std::size_t>(layout_.n);
    values_.assign(static_cast<std::size_t>(layout_.nonzeros()), 0);
    scaled_.assign(values_.size(), 0);
    x_.assign(n, 0);
    work_.assign(5 * n, 0);
    index_work_.assign(n, 0);
    pivots_.assign(n, 0);
    equilibration_.resize(layout_.n);
    inverse_norm_.resize(layout_.n);
    statistics_.nonzeros = layout_.nonzeros();
    return library_status(umfpack_di_symbolic(layout_.n, layout_.n, layout_.start.data(), layout_.row.data(), nullptr,
                                              &symbolic_, control_, nullptr));
  }

  LinearStatus do_factor() override {
    if (!equilibration_.find(layout_, values_) || !equilibration_.scale(layout_, values_, scaled_))
      return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    ++statistics_.factorizations;
    statistics_.reciprocal_condition = 0;
    umfpack_di_free_numeric(&numeric_);
    double info[UMFPACK_INFO];
    const int answer = umfpack_di_numeric(layout_.start.data(), layout_.row.data(), scaled_.data(), symbolic_,
                                          &numeric_, control_, info);
    if (answer != UMFPACK_WARNING_singular_matrix)
      if (LinearStatus status = library_status(answer); !status.ok()) return status;
    statistics_.factor_nonzeros = static_cast<std::int64_t>(info[UMFPACK_LNZ] + info[UMFPACK_UNZ]) - layout_.n;
    // Entries are at most one and threshold pivoting lets them grow little: without a small pivot no ratio is small.
    if (info[UMFPACK_RCOND] >= kDoubtfulPivotRatio) return {};
    const PivotRatio ratio = worst_pivot();
    const int column = index_work_[static_cast<std::size_t>(ratio.k < 0 ? 0 : ratio.k)];
    if (answer == UMFPACK_WARNING_singular_matrix || is_singular(ratio.smallest)) return singular_status(column);
    statistics_.reciprocal_condition =
        1 /
        (one_norm(layout_, scaled_) * inverse_norm_.estimate([&](std::span<double> x) { substitute(UMFPACK_A, x); },
                                                             [&](std::span<double> x) { substitute(UMFPACK_At, x); }));
    if (is_doubtful(ratio.smallest) && !(statistics_.reciprocal_condition >= kSingularCondition))
      return singular_status(column);
    return {};
  }

  LinearStatus do_solve(std::span<double> b) override {
    equilibration_.scale_right_hand_side(b);
    substitute(UMFPACK_A, b);
    equilibration_.scale_solution(b);
    return {};
  }

  void substitute(int system, std::span<double> b) {
    umfpack_di_wsolve(system, layout_.start.data(), layout_.row.data(), scaled_.data(), x_.data(), b.data(), numeric_,
                      control_, nullptr, index_work_.data(), work_.data());
    std::copy(x_.begin(), x_.end(), b.begin());
  }

  // Leaves the column order in index_work_.
  PivotRatio worst_pivot() {
    int l_nonzeros = 0, u_nonzeros = 0, rows = 0, columns = 0, diagonal = 0;
    check(umfpack_di_get_lunz(&l_nonzeros, &u_nonzeros, &rows, &columns, &diagonal, numeric_) == UMFPACK_OK,
          "UMFPACK tells the size of its factors");
    for (auto* f : {&l_rows_, &u_columns_}) f->start.resize(static_cast<std::size_t>(layout_.n) + 1);
    l_rows_.index.resize(static_cast<std::size_t>(l_nonzeros));
    l_rows_.value.resize(static_cast<std::size_t>(l_nonzeros));
    u_columns_.index.resize(static_cast<std::size_t>(u_nonzeros));
    u_columns_.value.resize(static_cast<std::size_t>(u_nonzeros));
    int reciprocal = 0;
    check(umfpack_di_get_numeric(l_rows_.start.data(), l_rows_.index.data(), l_rows_.value.data(),
                                 u_columns_.start.data(), u_columns_.index.data(), u_columns_.value.data(), nullptr,
                                 index_work_.data(), pivots_.data(), &reciprocal, nullptr, numeric_) == UMFPACK_OK,
          "UMFPACK hands out its factors");
    std::ranges::fill(work_, 0.0);
    return pivot_ratio(l_rows_, u_columns_, pivots_, std::span(work_).first(static_cast<std::size_t>(layout_.n)));
  }

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

  CscLayout layout_;
  Equilibration equilibration_;
  InverseNorm inverse_norm_;
  std::vector<double> scaled_, x_, work_, pivots_;
  std::vector<int> index_work_;
  CompressedFactor l_rows_, u_columns_;
  double control_[UMFPACK_CONTROL];
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack() {
  return std::make_unique<Umfpack>();
}

}  // namespace poinsot
