// By how much a state violates the constraints: the residuals of its rows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

// The bodies as the model gives them.
std::vector<BodyState> given_state(const Model& model);

// Largest |Φ| and |G v − ν| of a state, and the model rows where they occur; dropped rows are measured, too.
struct Violation {
  double position = 0, velocity = 0;
  int position_row = -1, velocity_row = -1;
};
Violation violation(const std::shared_ptr<const Model>& model, const std::vector<BodyState>& states);

// The residual of a row (order 0) or its rate (1) with its unit, for directions of unit length: "0.242 m²".
std::string describe_residual(const Model& model, int row, double value, int order);

// Violations up to this are rounding of the scene's numbers and are left as they are (m, rad, m/s, rad/s).
inline constexpr double kSatisfied = 1e-10;

}  // namespace poinsot
