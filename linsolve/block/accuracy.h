// How good the block solver's solutions are, by what they leave of the right-hand side.
//
// Two measures of one residual b − A x, each against the sizes of b and x in its units:
//
//   equilibrated   every row and column of A has a largest entry of one (equilibration.h): what is to be small always;
//   by masses      every body's block M has, and rows of constraints G over it: the units in which elimination of
//                  bodies and then of constraints is stable, of which the forces in b and multipliers are the measure.
//
// In mechanisms that are light or small M is tiny beside G once the matrix is equilibrated, and rounding of the forces
// in M a = f − Gᵀλ, divided by M, is more than rounding of a. The accelerations are no better determined than that: a
// correction changes them by some 1e-14 of the largest, and would be found necessary again and again. Where only one of
// many bodies is light the others may determine its motion all the better: G a = γ is to hold as well as a's own size
// asks for, however large the forces are.
#pragma once

#include <span>
#include <vector>

#include "linsolve/csc_layout.h"
#include "linsolve/residual.h"

namespace poinsot::block {

// Residuals, relative; rounding of a sum of a few terms leaves about 1e-15.
inline constexpr double kSmallResidual = 2e-15;  // above, residuals of later solutions are looked at
inline constexpr double kGoodResidual = 1e-14;   // above, a solution is refined: about klu's own largest
inline constexpr double kFairResidual = 1e-12;   // above, other pivots are tried: refinement would take more than one
                                                 // step
// Where nothing helps and all solutions would be refined, up to here they are good enough: klu's own largest along
// motions of planar loops are 2e-15 to 6e-13.
inline constexpr double kGoodEnough = 5e-14;
inline constexpr double kLargeResidual = 1e-13;  // above after refinement, it is not accepted

class Accuracy {
 public:
  // The structure of A, and the body or group of constraints of each unknown.
  void resize(const CscLayout& layout, std::span<const int> node);
  // Finds the units, those by masses where they are asked for.
  void measure_by(const CscLayout& layout, std::span<const double> values, bool masses);

  // Size of the residual in the equilibrated matrix's units; the residual is left in residual().
  double size(const CscLayout& layout, std::span<const double> values, std::span<const double> b,
              std::span<const double> x) {
    return residual_.size(layout, values, b, x);
  }
  std::span<double> residual() { return residual_.vector(); }
  // Whether x is good by masses, whose residual was found last and has this size.
  bool good_by_masses(double size, std::span<const double> b, std::span<const double> x) const;

  // Units of rows; of unknowns.
  std::span<const double> rows() const { return residual_.rows(); }
  double column(std::size_t j) const { return residual_.column(j); }
  std::span<const double> by_masses() const { return by_masses_; }

 private:
  void find_masses(const CscLayout& layout, std::span<const double> values, std::span<const double> columns);

  Residual residual_;
  std::span<const int> node_;
  std::vector<char> of_body_;  // unknowns with an entry on the diagonal
  std::vector<double> by_masses_, largest_;
};

}  // namespace poinsot::block
