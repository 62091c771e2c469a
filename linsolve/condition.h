// How near a factorized matrix is to a singular one, whatever the units of its rows and columns.
//
// The measure is Bauer's: ρ(|A⁻¹||A|), the least condition number ‖D₁AD₂‖·‖(D₁AD₂)⁻¹‖ over all diagonal scalings. Its
// inverse is, up to a modest factor, the relative change of the entries that makes A singular (F. L. Bauer, Optimally
// scaled matrices, 1963; S. M. Rump, Structured perturbations and componentwise distance to singularity, 2003). It is
// found as a power iteration: entries changed at random by their own size, ΔA x = ±|A|d, change the solution by
// A⁻¹ ΔA x; d is then the size the unknowns took, and the growth from one round to the next is the estimate.
//
// The growth is that of the unknown that grows most, an upper estimate until d has settled, which along chains takes
// rounds in their number: a matrix is called singular only where more rounds, with more vectors each, find it so, too.
// In rp the estimate of the straight chain grows as N^3.5, since what is zero in rA by its alignment cancels there:
// 4e9 for 1000 bodies, 9e11 for 3000; scaled by the sizes that it has found, 3e10 for 30 000.
//
// An upper estimate is no verdict: skew chains of 10 000 bodies are above 1e12 and solved to 3e-9. Where it says
// singular the matrix is judged by what solutions attain: that of a random right-hand side is corrected once from its
// residual, accumulated in long double, and the size of the correction beside that of the solution, over ε, is the
// condition. Skew chains of 3000 to 100 000 bodies in rA and reps are between 1e11 and 1e12 so; of singular matrices
// the correction is as large as the solution, because it finds the same unknown direction anew.
//
// Why not the usual condition number: [M Gᵀ; G 0] with G over h² is equilibrated with M near 1e-17 and then looks
// singular; and the regular chain of N bodies has a condition number growing as N⁴ (a unit turn at the hinge of a rigid
// chain moves N masses with lever arms up to N). Measured on chains, trees and loops, masses from 1e-5 to 1e3 and rows
// over h² with h = 1e-6 included: regular 1e1 to 1e4, 2e5 for the straight chain of 100 000 bodies; with a redundant
// constraint 1e13 and more. A matrix above 1e12 is singular to working precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "linsolve/csc_layout.h"

namespace poinsot {

inline constexpr double kSingularCondition = 1e12;

class Condition {
 public:
  void resize(int n);

  // The estimate for the matrix `values`; `solve` replaces its argument, a span of n numbers, by A⁻¹ times it. Infinite
  // where the solves overflow. Takes 2 · kRounds solves, more for a matrix that looks singular. Starts from unknowns of
  // the sizes in `scale`, 1 where empty: the column factors of an equilibration.
  template <class Solve>
  double estimate(const CscLayout& layout, std::span<const double> values, Solve&& solve,
                  std::span<const double> scale = {}) {
    start(scale);
    for (int round = 0; round < kMostRounds; ++round) {
      multiply(layout, values);
      for (int vector = 0; vector < (round < kRounds ? 2 : 4); ++vector) {
        randomize();
        solve(std::span<double>(x_));
        collect(vector == 0);
      }
      advance(round);
      if (round + 1 >= kRounds && !(growth_ >= kSingularCondition && std::isfinite(growth_))) break;
    }
    multiply(layout, values);
    if (growth_ >= kSingularCondition && std::isfinite(growth_)) {
      double error = 0;
      for (int vector = 0; vector < 4; ++vector) {
        randomize();
        b_ = x_;
        solve(std::span<double>(x_));
        next_ = x_;
        find_residual(layout, values);
        solve(std::span<double>(x_));
        error = std::max(error, size(x_) / size(next_));
      }
      growth_ = error / std::numeric_limits<double>::epsilon();
    }
    return growth_;
  }

  // After estimate(): the size of the unknowns, and of the terms in the rows; D_r = 1/rows, D_c = columns scale well.
  std::span<const double> columns() const { return d_; }
  std::span<const double> rows() const { return w_; }
  // The unknown of largest size: where the matrix is singular and well scaled, one that its equations leave open.
  int suspect() const { return suspect_; }

 private:
  static constexpr int kRounds = 2;  // the first finds the scale, the second measures
  static constexpr int kMostRounds = 6;

  void start(std::span<const double> scale);
  void multiply(const CscLayout& layout, std::span<const double> values);       // w ← |A| d
  void randomize();                                                             // x ← ±w, also in size
  void collect(bool first);                                                     // next ← |x|, the larger of two
  void advance(int round);                                                      // d ← next, and its growth
  void find_residual(const CscLayout& layout, std::span<const double> values);  // x ← b − A next
  double size(const std::vector<double>& x) const;                              // the largest |x_i|/d_i

  std::vector<double> d_, w_, x_, next_, b_;
  std::uint64_t random_ = 0;
  double growth_ = 0;
  int suspect_ = -1;
};

}  // namespace poinsot
