// The residual b − A x of a solve and its size, in the units of the equilibrated system.
#pragma once

#include <span>
#include <vector>

#include "linsolve/csc_layout.h"

namespace poinsot {

class Residual {
 public:
  // The structure of A.
  void resize(const CscLayout& layout);
  // Factors of rows; sizes of unknowns (the column factors of an equilibration).
  void measure_by(std::span<const double> rows, std::span<const double> columns);
  std::span<const double> rows() const { return rows_; }
  double column(std::size_t j) const { return 1 / per_column_[j]; }

  // Both leave b − A x in vector(). The size is the largest |b − A x| against the largest of |A||x| and |b|; in a row
  // of very many entries, as a hub has, |A||x| and the rounding of A x are as many times larger, or what its own terms
  // add up to, whichever makes less of it.
  void find(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
            std::span<const double> x);
  double size(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
              std::span<const double> x);
  std::span<double> vector() { return r_; }

 private:
  double in_sums(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
                 std::span<const double> x, double size);

  std::vector<int> panels_;    // columns in a row that have the same rows, and are taken together
  std::vector<double> terms_;  // by row: how many times more entries than few; empty where all have few
  std::vector<double> rows_, per_column_, r_;
  std::vector<double> by_terms_;  // rows by their terms; empty where all have few
  std::vector<double> sums_;      // of the terms of rows that have many
};

}  // namespace poinsot
