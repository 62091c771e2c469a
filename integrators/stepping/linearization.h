// The equations of motion linearized at a point, on one sparse pattern: what integrators with matrices of their own
// are made of.
//
//   M,   D = ∂(M a + Gᵀλ − Q)/∂v,   K = ∂(M a + Gᵀλ − Q)/∂q,   Gᵀ, G   at fixed (a, λ), T = I
//
// Entries are numbered as in [M Gᵀ; G 0]; those with row and column below nv belong to M, D and K, the others to G.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/index.h"
#include "formulations/problem.h"
#include "linsolve/csc_layout.h"

namespace poinsot {

class Linearization {
 public:
  explicit Linearization(const Problem& problem);

  // At the point where the problem stands.
  void assemble(Problem& problem, std::span<const double> a, std::span<const double> lambda);
  // out += D dv + K dq, by body
  void add_forces(std::span<const double> dv, std::span<const double> dq, std::span<double> out) const;

  // visit(row, column, M, D, K) for entries of the body part, gradient(row of λ, column of v, G) for the others.
  template <class Body, class Gradient>
  void visit(Body&& body, Gradient&& gradient) const {
    for (int j = 0; j < layout_.n; ++j) {
      for (int k = layout_.start[index(j)]; k < layout_.start[index(j + 1)]; ++k) {
        const int i = layout_.row[index(k)];
        if (i < nv_ && j < nv_) {
          body(i, j, M_[index(k)], D_[index(k)], K_[index(k)]);
        } else if (i >= nv_) {
          gradient(i - nv_, j, D_[index(k)]);
        }
      }
    }
  }

 private:
  int nv_;
  CscLayout layout_;
  std::vector<double> M_, D_, K_;
};

// Entries of a matrix as a pattern of single numbers, and the same entries again as values: a traversal that calls
// entry(row, column, value) in a fixed order is run with a recorder once and with a writer for every matrix.
struct EntryRecorder {
  std::vector<Block>& blocks;
  void operator()(int row, int column, double) { blocks.push_back({row, column, 1, 1}); }
};
// Sets the values: entries at one place add up.
struct EntryWriter {
  EntryWriter(std::span<const int> slots, std::span<double> of) : slot(slots.data()), values(of.data()) {
    std::ranges::fill(of, 0.0);
  }
  void operator()(int, int, double value) { values[*slot++] += value; }

  const int* slot;
  double* values;
};

}  // namespace poinsot
