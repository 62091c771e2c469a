// The numbers of a block elimination: values in, factors, solutions out, along a Schedule.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linsolve/block/assembly.h"
#include "linsolve/block/kernels.h"
#include "linsolve/block/schedule.h"

namespace poinsot::block {

class Factor {
 public:
  void resize(const Schedule& schedule);

  // Factors for the rows that make their entries comparable; pivots are chosen by them, values stay as they are.
  void weigh_rows(const Schedule& schedule, std::span<const double> weight);
  // Pivot blocks are not inverted any more, from the next factorization on, which is due.
  void drop_inverses();
  // Factorizes, in the order of rows of the last factorization as far as that serves, or choosing it afresh, which
  // later ones are compared with. Nothing stops at a bad pivot; the drift tells.
  // b, where it is given, is eliminated on the way: back() makes it the solution. `only`: L is not kept, and fronts lie
  // where that of the one before was, which saves memory much writing.
  Drift factor(const Schedule& schedule, std::span<const double> values, bool keep_order,
               std::span<const double> b = {}, bool only = false);
  bool kept() const { return kept_; }  // solve() may be called
  // b ← A⁻¹ b
  void solve(const Schedule& schedule, std::span<double> b);
  void back(const Schedule& schedule, std::span<double> b);

 private:
  // In doubles: where L of a front starts, and how far on the next front lies.
  static int lower(const Front& f) { return f.pivots * (f.others + f.pivots); }
  int step(const Front& f) const { return lower(f) + (kept_ ? f.pivots * f.rows : 0); }
  void take(const Schedule& schedule, std::span<const double> b);

  std::vector<double> store_, stack_, update_, t_;
  std::vector<double> y_;      // a right-hand side, by position
  std::vector<float> then_;    // 1/|pivot| of an examined factorization, in the units of rows, by position
  std::vector<float> weight_;  // by position
  std::vector<std::uint16_t> order_;
  std::vector<Places> places_;   // by front: those of its first child where that lays it down
  std::vector<char> moved_;      // by front: its rows are not in the order 0, 1, 2, … but in that of order_
  std::vector<char> whole_;      // by front: its pivot block is inverted as a whole
  bool kept_ = true;             // L of all fronts
  const double* end_ = nullptr;  // of the last front
  bool inverses_ = true;
};

}  // namespace poinsot::block
