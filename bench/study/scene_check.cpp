#include "bench/study/scene_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <utility>

#include "core/check.h"
#include "core/input_error.h"
#include "core/places.h"
#include "core/scene_doubts.h"
#include "core/scene_types.h"
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

void measure(SceneCheck& result) {
  const Model& model = *result.model;
  Eigen::AlignedBox3d box;
  for (const Body& body : model.bodies) {
    result.mass += body.mass;
    box.extend(body.position);
  }
  const auto hold = [&](int of, const Vector3& s) { box.extend(initial_point(model, of, s)); };
  for (const Row& row : model.rows) {
    if (row.type == RowType::DP1 || row.type == RowType::angle) continue;  // directions hold no points
    hold(row.i, row.s_i);
    hold(row.j, row.s_j);
  }
  result.extent = box.sizes();
}

}  // namespace

std::string_view left_free(const Group& joint) {
  // In the order of kJointTypes.
  static constexpr std::string_view kLeftFree[] = {
      "turning about its axis",     "turning about every axis",
      "turning about its two axes", "turning about its axis and sliding along it",
      "sliding along its axis",     "nothing"};
  static_assert(std::size(kLeftFree) == std::size(kJointTypes));
  const auto* entry = std::ranges::find(kJointTypes, joint.type, &TypeName<JointType>::name);
  check(entry != std::end(kJointTypes), "the group is a joint");
  return kLeftFree[entry - kJointTypes];
}

bool without_freedom(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  const auto pfaffian = [](const Row& row) { return row.type == RowType::pfaffian; };
  return std::none_of(model->rows.begin(), model->rows.end(), pfaffian) &&
         analyze_rank(model, pose_meant(model), RankNames::none).degrees_of_freedom() == 0;
}

std::vector<BodyState> pose_meant(const std::shared_ptr<const Model>& model) {
  std::vector<BodyState> given = given_state(*model);
  if (violation(model, given).position <= kSatisfied) return given;
  const bool rough = std::ranges::any_of(model->groups, &Group::body_fixed);
  if (!rough && given.size() > kMostClosed) return given;
  ClosedPose pose = close_mechanism(*model, given);
  if (!pose.closed || (pose.from_beside && !rough)) return given;
  return std::move(pose.states);
}

namespace {

SceneCheck checked(const Scene& scene) {
  SceneCheck result;
  result.model = std::make_shared<const Model>(compile(scene));
  result.notices = scene.notices;
  std::ranges::move(scene_doubts(*result.model), std::back_inserter(result.notices));
  measure(result);
  const std::vector<BodyState> given = given_state(*result.model);
  result.violation = violation(result.model, given);
  result.rank = analyze_rank(result.model, pose_meant(result.model), RankNames::all);
  if (!result.rank.conflicts.empty()) return result;
  try {
    const bool as_given = result.violation.position <= kSatisfied;
    result.start = find_initial_state(result.model, Settings{}, as_given ? &result.rank : nullptr);
    if (as_given && !result.start.rank.touching.empty()) result.rank = result.start.rank;
  } catch (const InputError& refused) {
    result.refusal = refused.what();
    return result;
  }
  compare_derivatives(result, result.start.status.ok() ? result.start.bodies : given);
  return result;
}

}  // namespace

SceneCheck check_scene(const Scene& scene) {
  SceneCheck result = checked(scene);
  const auto place = [&](std::string& sentence) { sentence = with_key_paths(sentence, scene); };
  std::ranges::for_each(result.notices, place);
  std::ranges::for_each(result.start.notices, place);
  place(result.refusal);
  place(result.start.status.message);
  return result;
}

}  // namespace poinsot::study
