#include "bench/study/scene_check.h"

#include <algorithm>

#include "core/input_error.h"
#include "formulations/registry.h"
#include "integrators/start/rough_pose.h"

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

// Where the rows are looked at: a pose that is no more than a guess is closed first.
std::vector<BodyState> pose_meant(const SceneCheck& result, std::vector<BodyState> given) {
  if (result.violation.position <= kSatisfied || !std::ranges::any_of(result.model->groups, &Group::body_fixed))
    return given;
  ClosedPose pose = close_mechanism(*result.model, given);
  return pose.closed ? std::move(pose.states) : given;
}

}  // namespace

SceneCheck check_scene(const Scene& scene) {
  SceneCheck result;
  result.model = std::make_shared<const Model>(compile(scene));
  const std::vector<BodyState> given = given_state(*result.model);
  result.violation = violation(result.model, given);
  result.rank = analyze_rank(result.model, pose_meant(result, given), RankNames::all);
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
