// KLU (T. Davis and E. Palamadai Natarajan, Algorithm 907): fresh pivots once, then refactorizations that keep them.
//
// Pivots chosen for other values can turn bad. After each refactorization every pivot is compared with its value at the
// last fresh factorization; a pivot a hundred times smaller or larger, or a hundredfold loss of reciprocal growth,
// is answered by fresh pivots for the same values. Growth changes along a motion as slowly as pivots do: it is looked
// at after the first refactorization and one in eight from then on (after each it was 7 % of the four link's steps).
#pragma once

#include <klu.h>

#include <cstdint>
#include <span>
#include <vector>

#include "linsolve/scaled_lu.h"

namespace poinsot {

class Klu final : public ScaledLu {
 public:
  Klu();
  ~Klu() override;
  std::uint64_t orientation() override;

 private:
  LinearStatus do_symbolic() override;
  LinearStatus do_fresh() override;
  bool do_refactor() override;
  void do_substitute(std::span<double> b) override;
  void do_substitute_transposed(std::span<double> b) override;
  double pivot(int k) override { return fresh_pivots_[static_cast<std::size_t>(k)]; }
  int pivot_column(int k) override { return symbolic_->Q[k]; }

  void add_rival(int ordering, bool block_triangular);
  void compare();
  static std::int64_t entries(const klu_numeric& n) { return std::int64_t{n.lnz} + n.unz + n.nzoff - n.n; }
  bool pivots_still_good();
  double reciprocal_growth();
  std::span<const double> pivots() const;
  LinearStatus library_status() const;
  // KLU only reads these, though its interface does not say so.
  int* start() { return const_cast<int*>(layout().start.data()); }
  int* row() { return const_cast<int*>(layout().row.data()); }
  void release();
  void release_rivals();

  std::vector<double> fresh_pivots_;
  std::vector<int> first_place_;  // of every row, by the first pivots chosen
  std::vector<char> reversed_;    // by diagonal block: the rows' order is an odd permutation of the first one
  bool order_known_ = false;      // reversed_ is that of the last fresh factorization
  double fresh_growth_ = 0;
  int since_growth_ = 0;  // refactorizations since it was looked at
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  std::vector<klu_symbolic*> rivals_;  // until the first factorization
  klu_numeric* numeric_ = nullptr;
};

}  // namespace poinsot
