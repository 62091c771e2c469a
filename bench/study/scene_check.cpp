#include "bench/study/scene_check.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/input_error.h"
#include "formulations/registry.h"
#include "integrators/settings.h"
#include "integrators/stepping/consistent.h"

namespace poinsot::study {
namespace {

// Far above what the projection leaves, far below what a scene means to say; relative to the mechanism's size.
constexpr double kHolds = 1e-6;

void compare_derivatives(SceneCheck& result, std::span<const BodyState> states) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const DerivativeCheck& derivative : formulation.check_derivatives(*result.model, states)) {
      ++result.derivatives;
      if (derivative.ok)
        result.derivative_error = std::max(result.derivative_error, derivative.error);
      else
        result.wrong.push_back({std::string(formulation.name), derivative});
    }
  }
}

}  // namespace

std::vector<Conflict> find_conflicts(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                                     const RankAnalysis& analysis) {
  const std::vector<int> dependent = analysis.dependent_rows();
  if (dependent.empty()) return {};
  const std::unique_ptr<Problem> independent = intrinsic_formulation().make(model, dependent);
  const std::unique_ptr<Problem> whole = intrinsic_formulation().make(model, {});
  std::vector<double> q(static_cast<std::size_t>(whole->nq())), v(static_cast<std::size_t>(whole->nv()));
  check(independent->from_bodies(states, q, v).ok(), "it represents every orientation");
  Consistent consistent(*independent, LinearChoice());
  // A projection that fails leaves the state where it was, and the rows are measured there.
  const std::vector<double> q_given = q, v_given = v;
  if (!consistent.project_position(0, q).ok()) q = q_given;
  independent->set_position(0, q);
  independent->set_velocity(v);
  if (!consistent.project_velocity(0, v).ok()) v = v_given;

  whole->set_position(0, q);
  whole->set_velocity(v);
  std::vector<double> Phi(static_cast<std::size_t>(whole->nc())), rate(Phi.size());
  whole->position_residual(Phi);
  whole->velocity_residual(rate);
  double size = 1;
  for (const BodyState& state : states) size = std::max(size, state.r.cwiseAbs().maxCoeff());
  std::vector<Conflict> conflicts;
  for (const int row : dependent) {
    const auto k = static_cast<std::size_t>(row);
    if (std::abs(Phi[k]) > kHolds * size)
      conflicts.push_back({row, std::abs(Phi[k]), true});
    else if (std::abs(rate[k]) > kHolds * size)
      conflicts.push_back({row, std::abs(rate[k]), false});
  }
  return conflicts;
}

SceneCheck check_scene(const Scene& scene) {
  SceneCheck result;
  result.model = std::make_shared<const Model>(compile(scene));
  const std::vector<BodyState> given = given_state(*result.model);
  result.rank = analyze_rank(result.model, given);
  result.conflicts = find_conflicts(result.model, given, result.rank);
  result.violation = violation(result.model, given);
  if (!result.conflicts.empty()) return result;
  try {
    result.start = find_initial_state(result.model, Settings{});
  } catch (const InputError& refused) {
    result.refusal = refused.what();
    return result;
  }
  compare_derivatives(result, result.start.status.ok() ? result.start.bodies : given);
  return result;
}

}  // namespace poinsot::study
