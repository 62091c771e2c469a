// When a factorized matrix counts as singular to working precision, the same for every linear solver.
//
// Two measures of P A Q = L U:
//   pivot ratio    |u_kk| / (|u_kk| + Σ_{j<k} |l_kj| |u_jk|): what cancellation left of pivot k. Rounding alone leaves
//                  about 1e-16 of a pivot that should be zero; the ratio does not change when rows or columns are
//                  scaled, nor with the number of unknowns;
//   reciprocal condition 1 / (‖A‖₁ ‖A⁻¹‖₁) of the equilibrated matrix (Hager and Higham's estimate).
//
// Neither decides alone. The condition number of a regular chain of N bodies grows as N⁴ (a unit turn at the hinge of a
// rigid chain moves N masses with lever arms up to N), beyond 1e16 at N = 10⁴, with perfectly good pivots. And a light
// body between heavy ones honestly leaves 1e-8 of a pivot at a condition of 1e8. Redundant constraints show in both:
// their pivots are rounding (< 1e-13), or, where masses of very different size blow the rounding up, small and
// accompanied by a condition beyond working precision.
#pragma once

#include <span>
#include <vector>

#include "linsolve/linear_solver.h"

namespace poinsot {

inline constexpr double kSingularPivotRatio = 1e-13;
inline constexpr double kDoubtfulPivotRatio = 1e-7;  // then the condition is asked for as well
inline constexpr double kSingularCondition = 1e-15;  // reciprocal

struct PivotRatio {
  double smallest = 1;
  int k = -1;  // the step of the elimination that has it
};

// Sparse triangular factors as libraries hand them out. Diagonals may be stored with either; they are skipped.
struct CompressedFactor {
  std::vector<int> start, index;
  std::vector<double> value;
};

// Needs L by rows and U by columns; `work` has n entries, zero before and after.
PivotRatio pivot_ratio(const CompressedFactor& l_rows, const CompressedFactor& u_columns,
                       std::span<const double> pivots, std::span<double> work);
// Rows from columns or the other way round. `out` keeps its memory from call to call.
void transpose(const CompressedFactor& in, CompressedFactor& out);

LinearStatus singular_status(int unknown);
inline bool is_singular(double smallest_pivot_ratio) {
  return !(smallest_pivot_ratio >= kSingularPivotRatio);
}
inline bool is_doubtful(double smallest_pivot_ratio) {
  return smallest_pivot_ratio < kDoubtfulPivotRatio;
}

}  // namespace poinsot
