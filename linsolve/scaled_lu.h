// What all sparse and dense LU back ends share: layout, scaling, and the judgement whether the matrix is regular.
//
// The back end factorizes D_r A D_c in compressed sparse columns. The first fresh factorization, and later ones with a
// pivot that is much smaller than before, are judged by Bauer's condition (condition.h); where a small pivot could come
// from a bad scaling, the matrix gets one of its own, which is improved, and is factorized once more. Scalings of
// matrices before are never improved on: again and again that would leave the range of numbers. Others pass by their
// pivots: entries are of size one, pivoting lets them grow little, and all that is left of some pivot of a singular
// matrix is rounding.
#pragma once

#include <span>
#include <vector>

#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/linear_solver.h"

namespace poinsot {

class ScaledLu : public LinearSolver {
 protected:
  // layout() stands, scaled() has its size.
  virtual LinearStatus do_symbolic() = 0;
  // Factorizes scaled() with fresh pivots; zeros among them are no failure here.
  virtual LinearStatus do_fresh() = 0;
  // Factorizes scaled() with the pivots of the last fresh factorization; false where these are not to be trusted any
  // more, or where the back end knows no such thing.
  virtual bool do_refactor() { return false; }
  virtual void do_substitute(std::span<double> b) = 0;
  virtual void do_substitute_transposed(std::span<double> b) = 0;
  // Pivot k of the last fresh factorization, and the column of the matrix that has it (or −1).
  virtual double pivot(int k) = 0;
  virtual int pivot_column(int k) = 0;

  // Whether the permutation k → to(k) of [first, last) is odd.
  template <class To>
  bool odd(int first, int last, To&& to) {
    bool answer = false;
    seen_.resize(static_cast<std::size_t>(layout_.n));
    for (int k = first; k < last; ++k) seen_[static_cast<std::size_t>(k)] = 0;
    for (int k = first; k < last; ++k) {
      if (seen_[static_cast<std::size_t>(k)]) continue;
      seen_[static_cast<std::size_t>(k)] = 1;
      for (int next = to(k); next != k; next = to(next)) {  // a cycle of n is n − 1 exchanges
        seen_[static_cast<std::size_t>(next)] = 1;
        answer = !answer;
      }
    }
    return answer;
  }
  const CscLayout& layout() const { return layout_; }
  std::span<double> scaled() { return scaled_; }
  static LinearStatus singular(int unknown);

 private:
  LinearStatus do_analyze(Pattern&& pattern) final;
  LinearStatus do_factor() final;
  LinearStatus do_solve(std::span<double> b) final;
  LinearStatus do_solve_transposed(std::span<double> b) final;

  LinearStatus factor_fresh();
  LinearStatus factor_scaled();
  double estimate();
  int suspect();

  CscLayout layout_;
  Equilibration equilibration_, scaling_before_;
  Condition condition_;
  std::vector<double> scaled_;
  std::vector<char> seen_;
  bool scaling_known_ = false;  // from earlier values
  bool pivots_known_ = false;
  bool examined_ = false;  // the condition was found good before; now smaller pivots than these raise doubts:
  double doubtful_ = 0;
  double smallest_ = 0;  // pivot of the last fresh factorization
};

}  // namespace poinsot
