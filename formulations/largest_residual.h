// How far bodies are from the constraints: of the bodies that are given out, which are rigid.
//
// In rp an orientation whose p is no unit is given out as that of p/|p|, and the rate along p turns nothing. Rows are
// computed of A(p), which stretches by pᵀp, and of methods of first order p·ṗ is of the order of the step: to first
// order that is taken out of each, Φ − e (pᵀp − 1) and G v without the rate of stretch, e being the row's gradient
// along the stretch (formulations/rp.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "formulations/mechanism.h"

namespace poinsot {

template <Formulation F>
LargestResidual largest_residual_of(const Mechanism<F, double>& mechanism) {
  using Gradient = typename Rows<F, double>::Gradient;
  static thread_local std::vector<double> nu;  // kept: with a sample at every step, steps still allocate nothing
  nu.resize(index(mechanism.nc()));
  const auto& c = mechanism.c;
  Rows<F, double>::nu(c, nu.data());

  LargestResidual most;
  Rows<F, double>::holonomic(c, [&](const Gradient& g, auto has_r, double Phi) {
    double rate = 0;
    const auto add = [&](int body, const auto& e) {
      if (body == kGround) return;
      rate += e.template head<3>().dot(c.rate[index(body)].wg);
      if constexpr (F::normalized) Phi -= e[3] * (c.at[index(body)].p.squaredNorm() - 1);
    };
    add(g.i, g.ei);
    add(g.j, g.ej);
    if constexpr (has_r) rate += g.g.dot(c.rd(g.j) - c.rd(g.i));
    most.position = std::max(most.position, std::abs(Phi));
    most.velocity = std::max(most.velocity, std::abs(rate - nu[index(g.row)]));
  });
  Rows<F, double>::velocity(
      c, [&](const Gradient&, auto, double psi) { most.velocity = std::max(most.velocity, std::abs(psi)); });
  return most;
}

}  // namespace poinsot
