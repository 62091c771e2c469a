// A mechanism without degrees of freedom: as many constraints as velocities, so that G is square and
//
//   [ K  Gᵀ ] [ v ]   [ f ]
//   [ G  0  ] [ λ ] = [ γ ]      is solved by   v = G⁻¹ γ,   λ = G⁻ᵀ (f − K v).
//
// One factorization of G, half the size, instead of the whole matrix; K is only multiplied with. The block above G is
// compared with Gᵀ number by number at every factorization; where it differs (velocity rows, some force laws) this
// answers no and another method has to do.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "linsolve/csc_layout.h"
#include "linsolve/klu_solver.h"

namespace poinsot {

class Determined {
 public:
  // Whether the pattern has this form. Keeps a reference to nothing.
  bool analyze(const CscLayout& layout);
  bool fits(std::span<const double> values) const;
  // `values` fit; the unknown of a failure is one of the whole system.
  LinearStatus factor(std::span<const double> values);
  // The caller tests whether the solution is finite.
  void solve(const CscLayout& layout, std::span<const double> values, std::span<double> b);

  const LinearStatistics& statistics() const { return klu_.statistics(); }

 private:
  std::vector<int> velocities_, multipliers_;  // their places in the whole system, ascending
  std::vector<int> velocity_of_;               // by unknown, −1 for a multiplier
  std::vector<std::pair<int, int>> g_;         // entries of G: place in the whole, place in klu_
  std::vector<std::pair<int, int>> mirror_;    // entries of G and Gᵀ that have to be equal
  Klu klu_;
  std::vector<double> v_, f_;
};

}  // namespace poinsot
