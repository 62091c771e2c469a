// The stabilized index-2 form of Gear, Gupta and Leimkuhler as an implicit system F(t, y, ẏ) = 0, y = (q, v, λ, μ).
//
//   q̇ − v + Gᵀμ = 0,   M v̇ + Gᵀλ − Q = 0,   G v − ν = 0,   Φ = 0
//
// Positions and velocities both stay on their constraints; μ is 0 on the motion. Rows that constrain velocities only
// have no Φ: theirs is μ = 0. For formulations whose coordinates are a vector space with q̇ = v (rp). Source: Gear,
// Gupta & Leimkuhler, J. Comp. Appl. Math. 12–13 (1985).
//
// The matrix α ∂F/∂ẏ + ∂F/∂y is written as
//   ⎡ α I          −I        0    Gᵀ ⎤
//   ⎢ K            α M + D   Gᵀ   0  ⎥
//   ⎢ ∂(G v−ν)/∂q  G         0    0  ⎥
//   ⎣ G            0         0    0  ⎦
// It lacks ∂(Gᵀμ)/∂q, which vanishes with μ.
#pragma once

#include <span>
#include <vector>

#include "integrators/state.h"
#include "integrators/stepping/linearization.h"

namespace poinsot {

class StabilizedIndex2 {
 public:
  explicit StabilizedIndex2(Problem& problem);

  int size() const { return 2 * (nv_ + nc_); }
  // y and ẏ of a consistent state.
  void start(const State& state, std::span<double> y, std::span<double> y_dot) const;
  std::span<const double> q(std::span<const double> y) const { return y.first(nv()); }
  std::span<const double> v(std::span<const double> y) const { return y.subspan(nv(), nv()); }

  void residual(double t, std::span<const double> y, std::span<const double> y_dot, std::span<double> F);

  Pattern pattern();
  std::vector<int> unknowns() const;  // of the problem, to which the unknowns belong
  void assemble(double t, double alpha, std::span<const double> y, std::span<const double> y_dot,
                std::span<const int> slots, std::span<double> values);

 private:
  std::size_t nv() const { return static_cast<std::size_t>(nv_); }
  std::size_t nc() const { return static_cast<std::size_t>(nc_); }
  std::span<const double> lambda(std::span<const double> y) const { return y.subspan(2 * nv(), nc()); }
  std::span<const double> mu(std::span<const double> y) const { return y.last(nc()); }
  void stand(double t, std::span<const double> y);
  template <class Sink>
  void write(double alpha, Sink&& entry) const;

  Problem& problem_;
  int nv_, nc_;
  std::vector<int> velocity_rows_;
  Linearization linear_;
  CscLayout rates_layout_;
  std::vector<double> rates_;
};

}  // namespace poinsot
