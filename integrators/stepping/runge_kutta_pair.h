// Coefficients of an embedded explicit Runge–Kutta pair, sparse: what is zero is not listed.
//
//   k_i = f(t_n + c_i h, y_n + h Σ_j a_ij k_j),   y_{n+1} = y_n + h Σ b_j k_j,   k_{s+1} = f(t_n + h, y_{n+1})
//
// k_{s+1} is the next step's first stage; the last of the others has c = 1, too (stiffness.h). Dense output (Hairer,
// Nørsett, Wanner, "Solving Ordinary Differential Equations I", sec. II.6), s in [0, 1]:
//   y(t_n + s h) = y_n + s (r1 + (1 − s)(r2 + s (r3 + (1 − s)(r4 + …)))),
//   r1 = Δy, r2 = h k_1 − Δy, r3 = 2 Δy − h (k_1 + k_{s+1}), r_{4+i} = h Σ_j d_ij k_j
#pragma once

#include <span>
#include <string_view>

#include "integrators/stepping/step_control.h"

namespace poinsot {

struct Term {
  int stage;  // of k, counted from 0
  double weight;
};
using Terms = std::span<const Term>;

struct Stage {
  double c;
  Terms a;
};

struct RungeKuttaPair {
  std::string_view name;
  int order;
  std::span<const Stage> stages;  // without k_{s+1}
  Terms b;
  Terms error;                          // (y_{n+1} − embedded y_{n+1})/h
  Terms third_order_error;              // DOP853 blends two estimates; empty elsewhere
  std::span<const Stage> dense_stages;  // after k_{s+1}, for dense output only
  std::span<const Terms> dense;         // d
  StepRule rule;
  double stability;  // |h λ| up to which its domain of stability reaches, about
};

}  // namespace poinsot
