#include "integrators/start/violation.h"

#include <fmt/format.h>

#include <cmath>

#include "core/index.h"
#include "formulations/registry.h"

namespace poinsot {

std::string describe_residual(const Model& model, int row, double value, int order) {
  static constexpr const char* kUnits[] = {" rad", " m", " m²", " m", " rad", ""};  // by RowType; of unit directions
  const RowType type = model.rows[index(row)].type;
  if (type == RowType::pfaffian) return fmt::format("{:.3g} m/s", value);
  return fmt::format("{:.3g}{}{}", value, kUnits[static_cast<int>(type)], order == 1 ? "/s" : "");
}

std::vector<BodyState> given_state(const Model& model) {
  std::vector<BodyState> states;
  for (const Body& body : model.bodies) {
    states.push_back({.r = body.position, .A = body.orientation, .rd = body.velocity, .w = body.angular_velocity});
  }
  return states;
}

Violation violation(const std::shared_ptr<const Model>& model, const std::vector<BodyState>& states) {
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, {});
  std::vector<double> q(index(problem->nq())), v(index(problem->nv()));
  problem->from_bodies(states, q, v);
  problem->set_position(0, q);
  problem->set_velocity(v);
  std::vector<double> r(index(problem->nc()));
  Violation largest;
  const auto find_largest = [&](double& most, int& row) {
    for (std::size_t k = 0; k < r.size(); ++k)
      if (!(std::abs(r[k]) <= most)) most = std::abs(r[k]), row = static_cast<int>(k);
  };
  problem->position_residual(r);
  find_largest(largest.position, largest.position_row);
  problem->velocity_residual(r);
  find_largest(largest.velocity, largest.velocity_row);
  return largest;
}

}  // namespace poinsot
