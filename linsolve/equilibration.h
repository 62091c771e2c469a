// Row and column factors that bring a matrix to entries of size one: (D_r A D_c) y = D_r b, x = D_c y.
//
// Forces, lengths and 1/h² meet in one matrix; pivots and condition numbers mean something only after scaling. The
// factors are powers of two, so scaling rounds nothing. Ruiz' iteration: every sweep divides each row and column by the
// root of its largest entry (D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices,
// 2001).
#pragma once

#include <span>
#include <vector>

#include "linsolve/csc_layout.h"

namespace poinsot {

class Equilibration {
 public:
  void resize(int n);

  // Finds the factors; false where an entry is not finite.
  bool find(const CscLayout& layout, std::span<const double> values);
  // Factors from the geometric mean of the largest and the smallest entry: brings out blocks that find() leaves tiny
  // beside others, as M beside G over h², and exaggerates entries that are nothing but rounding. The entries are
  // finite.
  void find_by_means(const CscLayout& layout, std::span<const double> values);
  // scaled ← D_r A D_c in the same layout, with factors that may come from other values. The magnitude of its largest
  // entry; NaN where an entry is not finite.
  double scale(const CscLayout& layout, std::span<const double> values, std::span<double> scaled);
  // D_r ← D_r / rows, D_c ← D_c · columns.
  void improve(std::span<const double> rows, std::span<const double> columns);

  void scale_right_hand_side(std::span<double> b) const;  // b ← D_r b
  void scale_solution(std::span<double> y) const;         // y ← D_c y

  std::span<const double> row() const { return row_; }
  std::span<const double> col() const { return col_; }

 private:
  template <bool means>
  bool sweep(const CscLayout& layout, std::span<const double> values);
  void multiply(const CscLayout& layout);

  std::vector<double> row_, col_, row_max_, col_max_, row_min_, col_min_;
  std::vector<double> by_entry_;  // row · col, once something has been scaled by them
};

}  // namespace poinsot
