// Solutions of A x = b that are looked at and corrected: x ← x + A⁻¹ r, r = b − A x, sizes of r as in residual.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/index.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/residual.h"

namespace poinsot::block {

// Residuals, relative; rounding of a sum of a few terms leaves about 1e-15.
constexpr double kSmallResidual = 2e-15;  // above, residuals of later solutions are looked at
constexpr double kGoodResidual = 1e-14;   // above, a solution is refined: about klu's own largest
constexpr double kFairResidual = 1e-12;   // above, other pivots are tried: refinement would take more than one step
constexpr double kLargeResidual = 1e-13;  // above after refinement, it is not accepted

class Refinement {
 public:
  // Of a matrix whose structure and values have to live as long.
  Refinement(const CscLayout& layout, const std::vector<double>& values) : layout_(layout), values_(values) {}

  void resize() {
    residual_.resize(layout_);
    b_.reserve(index(layout_.n));
  }
  void measure_by(const Equilibration& units) { residual_.measure_by(units.row(), units.col()); }
  std::span<const double> rows() const { return residual_.rows(); }
  double column(std::size_t j) const { return residual_.column(j); }

  // A right-hand side, whose solution is to be looked at.
  void begin(std::span<const double> b) { b_.assign(b.begin(), b.end()); }
  std::span<const double> b() const { return b_; }
  double residual(std::span<const double> x) { return residual_.size(layout_, values_, b_, x); }

  // By the residual that was found last; solve(r) leaves A⁻¹ r in r.
  template <class Solve>
  void correct(std::span<double> x, Solve&& solve) {
    const std::span<double> r = residual_.vector();
    solve(r);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += r[i];
  }

  // Until the residual is no larger than `good`, a few times at most; the residual.
  template <class Solve>
  double refine(std::span<double> x, double good, std::int64_t& corrections, Solve&& solve) {
    double size = HUGE_VAL;
    for (int step = 0; step < kMost && !(size <= good); ++step) {
      correct(x, solve);
      ++corrections;
      size = residual(x);
    }
    return size;
  }

 private:
  static constexpr int kMost = 3;  // each gains three digits or more of kFairResidual; beyond, they do not converge

  const CscLayout& layout_;
  const std::vector<double>& values_;
  Residual residual_;
  std::vector<double> b_;
};

}  // namespace poinsot::block
