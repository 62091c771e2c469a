// The elimination of few bodies at once, and then of all their constraints as one dense matrix.
//
//   [ K  B ] [ v ]   [ f ]      L = G K⁻¹,   S = L B:      λ = S⁻¹ (L f − γ),   v = K⁻¹ (f − B λ)
//   [ G  0 ] [ λ ] = [ γ ]
//
// In the order of a tree (order.h) pivots wait for one another from the first to the last, 22 on a double pendulum, and
// every few of them an update between fronts. Here blocks of K, into which M falls apart (r and x of each body), wait
// for nothing and are inverted only when their values have changed, in rA never; what is left are the 10 pivots of S.
// That S is dense costs little while it fits into the machine's registers.
//
// Values are written where they are needed, G and B as dense matrices. For matrices that another elimination has
// examined; whether this one serves as well is found out in solver.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linsolve/block/pivots.h"
#include "linsolve/block/schur_kernels.h"
#include "linsolve/csc_layout.h"
#include "linsolve/pattern.h"

namespace poinsot::block {

class Schur {
 public:
  // False where the structure is another, or there are too many unknowns. `layout` is that of the pattern, its slots
  // included.
  bool lay_out(const Pattern& pattern, const CscLayout& layout);
  std::span<const int> slots() const { return slots_; }  // of the pattern's blocks
  std::span<double> values() { return {K_, values_}; }
  void copy_values(std::span<double> to) const;  // in the layout
  void take_values(std::span<const double> from);

  // Chooses the order of rows within blocks of K, in the given units, and the pivots that those of later factorizations
  // are compared with. False where a pivot is what rounding has left.
  bool choose(std::span<const double> units);
  // False where one of them is not within a factor `range` of what it was then, and b cannot be solved for.
  bool factor(double range);
  // b ← A⁻¹ b with the values of the last factorization.
  void solve(std::span<double> b);

 private:
  struct Part {        // a block of K
    int size, column;  // of its unknowns in columns_
    int block;         // where its numbers stand
    bool moved;        // its rows are in another order than 0, 1, 2, …
  };
  struct Strip {  // values that stay together
    int source, target, length;
  };

  bool find_parts(const Pattern& pattern, const CscLayout& layout);
  bool place_values(const Pattern& pattern, const CscLayout& layout);
  void find_panels(const CscLayout& layout);
  bool inertia_changed();
  Choice choice(const Part& part);
  bool invert_parts();
  void find_left();
  bool choose_pivots();

  std::size_t kernel_ = 0;
  int rows_ = 0, step_ = 0;         // of S, and from one of its columns to the next
  int singles_ = 0;                 // blocks of one number, which come first
  std::vector<int> unknown_, row_;  // eliminated, and those of S, with others up to what the kernel takes
  std::vector<int> columns_;        // of G and L, block by block
  std::vector<Part> parts_;         // the larger ones
  std::vector<int> slots_;
  std::vector<Strip> strips_;  // from the values here to those of the layout
  std::vector<std::uint8_t> panel_;
  std::vector<const std::uint8_t*> panel_end_;
  std::vector<double> room_;  // of the following, each of which begins with a line of the cache
  double *K_ = nullptr, *G_ = nullptr, *B_ = nullptr;  // the values: blocks; columns; columns
  double *K_then_ = nullptr, *inverse_ = nullptr;      // blocks that are inverted, and their inverses
  double *L_ = nullptr, *S_ = nullptr, *border_ = nullptr, *lambda_ = nullptr, *forces_ = nullptr;
  double *pivots_ = nullptr, *chosen_ = nullptr;  // of S; 1/|pivot| as they were chosen
  std::size_t values_ = 0, numbers_ = 0;          // of K, G and B; of K
  std::vector<std::uint16_t> order_;              // of rows within blocks of K, part by part
  std::vector<float> units_, then_;               // of these rows; 1/|pivot| as they were chosen
  Drift drift_;                                   // of the blocks that are inverted
  std::vector<double> dense_, size_;              // S, and of its diagonal, while pivots are chosen
};

}  // namespace poinsot::block
