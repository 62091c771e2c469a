#include "linsolve/klu_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "linsolve/back_ends.h"

namespace poinsot {
namespace {

constexpr double kPivotChange = 100;
constexpr int kGrowthSeldom = 8;  // refactorizations from one look at growth to the next

}  // namespace

Klu::Klu() {
  klu_defaults(&common_);
  common_.scale = -1;  // the matrix comes scaled and checked
  common_.halt_if_singular = 0;
  common_.tol = 0.1;  // with the default of 1e-3 backward errors reach 1e-11 on loops
}

Klu::~Klu() {
  release();
}

// Orders compete at the first factorization, and the one with the fewest entries in the factors stays: AMD after a
// permutation to block triangular form (trees, determined mechanisms), COLAMD (ladders), and AMD as the matrix stands
// (loops, ida's matrices), which by its fill can take seconds on a ladder of 1000 and gains nothing where there are
// diagonal blocks. The search for the block triangular form takes time in the square of n on saddle points.
LinearStatus Klu::do_symbolic() {
  constexpr int kLargestSearched = 20000, kLargestAsItStands = 3000;
  release();
  fresh_pivots_.assign(static_cast<std::size_t>(layout().n), 0);
  first_place_.clear();
  if (layout().n <= kLargestSearched) add_rival(0, true);
  add_rival(1, false);
  if (rivals_.empty()) return library_status();
  if (layout().n <= kLargestAsItStands && rivals_.front()->nblocks == 1) add_rival(0, false);
  symbolic_ = rivals_.front();
  rivals_.erase(rivals_.begin());
  return {};
}

void Klu::add_rival(int ordering, bool block_triangular) {
  common_.ordering = ordering;
  common_.btf = block_triangular;
  if (klu_symbolic* one = klu_analyze(layout().n, start(), row(), &common_)) rivals_.push_back(one);
}

bool Klu::do_refactor() {
  return klu_refactor(start(), row(), scaled().data(), symbolic_, numeric_, &common_) && common_.status == KLU_OK &&
         pivots_still_good();
}

LinearStatus Klu::do_fresh() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  numeric_ = klu_factor(start(), row(), scaled().data(), symbolic_, &common_);
  if (!numeric_) return library_status();
  if (!rivals_.empty()) compare();
  statistics_.factor_nonzeros = entries(*numeric_);
  std::ranges::copy(pivots(), fresh_pivots_.begin());
  fresh_growth_ = reciprocal_growth();
  since_growth_ = kGrowthSeldom - 1;  // the first values after these may be far from them, as of another step
  order_known_ = false;
  return {};
}

// Rows stay in their diagonal block whatever the pivots, and the order of the columns stays.
std::uint64_t Klu::orientation() {
  const int *first = symbolic_->R, *row_at = numeric_->Pnum;
  const std::size_t blocks = static_cast<std::size_t>(symbolic_->nblocks);
  if (first_place_.empty()) {
    first_place_.resize(fresh_pivots_.size());
    for (int k = 0; k < layout().n; ++k) first_place_[static_cast<std::size_t>(row_at[k])] = k;
  }
  if (!order_known_) {
    reversed_.resize(blocks);
    const auto to = [&](int k) { return first_place_[static_cast<std::size_t>(row_at[k])]; };
    for (std::size_t b = 0; b < blocks; ++b) reversed_[b] = odd(first[b], first[b + 1], to);
    order_known_ = true;
  }
  std::uint64_t all = 1;
  for (std::size_t b = 0; b < blocks; ++b) {
    bool negative = reversed_[b] != 0;
    for (int k = first[b]; k < first[b + 1]; ++k) negative ^= pivots()[static_cast<std::size_t>(k)] < 0;
    all = 0x9E3779B97F4A7C15U * all + (negative ? 2 : 1);
  }
  return all;
}

void Klu::compare() {
  for (klu_symbolic*& rival : rivals_) {
    klu_numeric* other = klu_factor(start(), row(), scaled().data(), rival, &common_);
    if (other && entries(*other) < entries(*numeric_)) {
      std::swap(numeric_, other);
      std::swap(symbolic_, rival);
    }
    if (other) klu_free_numeric(&other, &common_);
  }
  release_rivals();
}

void Klu::release_rivals() {
  for (klu_symbolic* rival : rivals_) klu_free_symbolic(&rival, &common_);
  rivals_.clear();
}

void Klu::do_substitute(std::span<double> b) {
  klu_solve(symbolic_, numeric_, layout().n, 1, b.data(), &common_);
}

void Klu::do_substitute_transposed(std::span<double> b) {
  klu_tsolve(symbolic_, numeric_, layout().n, 1, b.data(), &common_);
}

bool Klu::pivots_still_good() {
  bool good = true;
  for (std::size_t k = 0; k < fresh_pivots_.size(); ++k) {
    const double now = std::abs(pivots()[k]), then = std::abs(fresh_pivots_[k]);
    good = good && now * kPivotChange >= then && now <= then * kPivotChange;
  }
  if (!good || ++since_growth_ < kGrowthSeldom) return good;
  since_growth_ = 0;
  return reciprocal_growth() * kPivotChange >= fresh_growth_;
}

// min over columns of max|A| / max|U|.
double Klu::reciprocal_growth() {
  klu_rgrowth(start(), row(), scaled().data(), symbolic_, numeric_, &common_);
  return common_.rgrowth;
}

std::span<const double> Klu::pivots() const {
  return {static_cast<const double*>(numeric_->Udiag), fresh_pivots_.size()};
}

LinearStatus Klu::library_status() const {
  if (common_.status == KLU_OUT_OF_MEMORY) return {LinearFailure::out_of_memory, -1, "not enough memory for KLU"};
  check(common_.status == KLU_TOO_LARGE, "KLU accepts the matrix");
  return {LinearFailure::refused, -1, "the factors have more entries than KLU's 32-bit indices can count"};
}

void Klu::release() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  release_rivals();
}

std::unique_ptr<LinearSolver> make_klu() {
  return std::make_unique<Klu>();
}

}  // namespace poinsot
