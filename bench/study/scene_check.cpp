#include "bench/study/scene_check.h"

#include <algorithm>

#include "core/input_error.h"
#include "formulations/registry.h"

namespace poinsot::study {
namespace {

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

SceneCheck check_scene(const Scene& scene) {
  SceneCheck result;
  result.model = std::make_shared<const Model>(compile(scene));
  const std::vector<BodyState> given = given_state(*result.model);
  result.rank = analyze_rank(result.model, given, RankNames::all);
  result.violation = violation(result.model, given);
  if (!result.rank.conflicts.empty()) return result;
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
