// The bodies' part of the Schur complement solver: K⁻¹ body by body, and what each adds to S = G K⁻¹ Gᵀ.
//
// A body has the unknowns of a node with entries on the diagonal (rp: the normalization row among them) and a matrix K;
// every other node is a group of constraints. Kept are K's factors, Y = K⁻¹ B and Cᵀ, B and C being the body's parts of
// the constraints' columns and rows.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "linsolve/csc_layout.h"
#include "linsolve/sparse_ldlt.h"

namespace poinsot {

class SchurBodies {
 public:
  // Refuses what is not [K Gᵀ; G 0] with a block of K for each body. Sets up the complement, too.
  LinearStatus analyze(const CscLayout& layout, std::span<const int> node, SparseLdlt& complement);
  // Writes the complement's values. Refuses what makes it unsymmetric or negative.
  LinearStatus eliminate(std::span<const double> values, SparseLdlt& complement);
  // b ← A⁻¹ b with the factorized complement.
  void substitute(SparseLdlt& complement, std::span<double> b);

  std::span<const double> determinants() const { return determinant_; }  // of the K
  int unknown_of(int multiplier) const { return multiplier_[static_cast<std::size_t>(multiplier)]; }
  std::int64_t nonzeros() const { return static_cast<std::int64_t>(store_.size()); }

 private:
  struct Body {
    int unknowns, rows;                         // numbers of unknowns and of constraint rows on it
    int first_unknown, first_row, first_entry;  // where its lists start
    std::int64_t store;                         // K, then B and Y, then Cᵀ, columns one after the other
  };

  LinearStatus find_bodies(const CscLayout& layout, std::span<const int> node);
  void number_entries(const CscLayout& layout);

  std::vector<Body> bodies_;                // one more as an end
  std::vector<int> unknown_, row_;          // by body: its unknowns; the multipliers on it, ascending
  std::vector<int> body_of_, number_;       // by unknown: its body, −1 for a multiplier; its number there
  std::vector<int> multiplier_;             // their unknowns
  std::vector<std::pair<int, int>> entry_;  // by body: from places in values to places in its store
  std::vector<double> store_, determinant_, z_, lambda_, y_;
  std::vector<int> swap_;  // by body: row exchanges of K's factors
};

}  // namespace poinsot
