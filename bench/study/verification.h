// What is known of how accurate a run is: what its method says of itself, and how far the run is from the same one
// computed more finely, with half the step or a tenth of the tolerances.
//
// Distances are the largest over the output times that both have (some thousand at most), |Δr|, the angle of AᵀA', |Δṙ|
// and so on, in SI units. With equal steps a third run, with a quarter of the step, shows the order: the distances d₁
// from h to h/2 and d₂ from h/2 to h/4 are d₁/d₂ = 2^p of each other at order p, and the error of the run itself is
// about d₁ 2^p/(2^p − 1). Where d₁/d₂ is that of an order higher than the method's by more than about one, d₁ is not of
// the errors that make its order (accelerations and reactions of the first step are of another kind than those after,
// by Euler's methods above all): then neither order nor error is told.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "integrators/settings.h"

namespace poinsot::study {

// The method's own word: "not estimated" of equal steps. Without a full stop.
std::string accuracy(const Settings& settings);

struct Verification {
  struct Quantity {
    std::string_view name, unit;
    double apart = 0;
    std::string where = {};                        // body, joint, driver or constraint
    double t = 0;                                  // s
    std::optional<double> order = {}, error = {};  // where they can be told
    bool order_unseen = false;                     // the distances shrink as none of the method's errors does
  };
  std::string against;  // "half the step, h = 0.0005 s"
  std::string failure;  // why there is nothing, or no order
  std::size_t times = 0;
  bool steps = false;                // equal ones, which have an order
  std::vector<Quantity> quantities;  // empty where there is nothing
};

// Of a run that came to its end. What fails, or is interrupted, is told in the result.
Verification verify(const Scene& scene, const Settings& settings);

}  // namespace poinsot::study
