// The derivative check of `poinsot check`: every analytic derivative of a scene at its own state against dual numbers.
//
// Each constraint, joint, driver and force is taken alone with the bodies it acts on, without masses, so that what is
// compared is its own and the cost grows with their number only. What is differentiated is Φ, G v − ν and Gᵀλ − Q as
// the program evaluates them; what is compared are G, ν, γ and the blocks of the Newton matrix.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

struct DerivativeCheck {
  std::string name;       // "constraint 'driver'", "joint 'revolute1'", "force 'spring1'"
  std::string_view what;  // which derivative
  double error = 0;       // largest difference, relative to the size of the terms it is made of
  bool ok = false;        // at most kDerivativeTolerance
};

// Both sides are sums of a few dozen products, rounded differently: they agree to about 1e-15 of the size of the terms.
// A wrong or forgotten term is of that size itself. 1e-9 is far from both.
inline constexpr double kDerivativeTolerance = 1e-9;
// The sensitivity that a callback gives is compared with differences of its loads, which rounding leaves eight digits.
inline constexpr double kDifferenceTolerance = 1e-5;

// Every constraint, joint, driver and force of the model at the states, in formulation F. Defined in
// derivative_checker.h; for the formulations in the list derivative_checks.cpp has them all.
template <class F>
std::vector<DerivativeCheck> check_derivatives_in(const Model& model, std::span<const BodyState> states);

}  // namespace poinsot
