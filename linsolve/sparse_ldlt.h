// A = L D Lᵀ of a sparse symmetric matrix that is a sum of small dense ones over cliques of its unknowns.
//
// Up-looking, without pivoting, in AMD's order (T. Davis, Algorithm 849: a concise sparse Cholesky factorization
// package, 2005): for positive definite matrices. All symbolic work in analyze().
#pragma once

#include <span>
#include <vector>

namespace poinsot {

class SparseLdlt {
 public:
  // Clique c has the members member[start[c]] … member[start[c+1]−1]. False where the factor has more entries than
  // 32-bit indices can count.
  bool analyze(int n, std::span<const int> start, std::span<const int> member);

  // Places in values() of the entries (a, b), a ≥ b by their place in the clique, column by column; clique by clique.
  std::span<const int> places() const { return places_; }
  std::span<double> values() { return values_; }

  // Not a number and zero are among the pivots where there is no factorization.
  void factor();
  std::span<const double> pivots() const { return d_; }
  // An unknown whose pivot is at most `part` of its diagonal entry, or −1.
  int cancelled(double part) const;
  void solve(std::span<double> b);

  int nonzeros() const { return static_cast<int>(l_.size() + d_.size()); }

 private:
  bool find_structure();

  int n_ = 0;
  std::vector<int> order_;        // unknown by position
  std::vector<int> start_, row_;  // upper triangle of the permuted matrix by columns, rows in no order
  std::vector<int> places_, parent_;
  std::vector<int> l_start_, l_row_, filled_, mark_, pattern_;
  std::vector<double> values_, l_, d_, y_;
};

}  // namespace poinsot
