#include "bench/study/scene_waste.h"

#include <fmt/format.h>

#include "bench/study/name_list.h"
#include "bench/study/scene_check.h"
#include "core/index.h"
#include "integrators/start/rank.h"

namespace poinsot::study {
namespace {

constexpr double kStill = 1e-9;  // of the mechanism's motion: rounding

}  // namespace

std::vector<std::string> scene_waste(const Scene& scene, const Motion& motion) {
  std::vector<std::string> sentences;
  const auto model = std::make_shared<const Model>(compile(scene));
  const RankAnalysis rank = analyze_rank(model, pose_meant(model), RankNames::all);
  if (const std::vector<int> dependent = rank.dependent_rows(); !dependent.empty()) {
    std::vector<std::string> names, reactions;
    for (const int row : dependent) names.push_back(describe_row(*model, row));
    for (const Undetermined& of : rank.undetermined) reactions.push_back(model->groups[index(of.group)].name);
    sentences.push_back(
        fmt::format("{} of {} constraint rows follow from the others and are set aside: {}; undetermined "
                    "are the reactions of {}",
                    dependent.size(), model->rows.size(), listed(names), listed(reactions)));
  }

  const Sizes scale = sizes(motion, *model);
  std::vector<std::string> still, not_turning;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    double moved = 0, turned = 0;
    for (const auto& bodies : motion.bodies) {
      const BodyState &now = bodies[b], &first = motion.bodies.front()[b];
      // A driver may come back to the same place at rest at every output time: its acceleration gives it away.
      moved = std::max({moved, (now.r - first.r).norm() / scale.length, now.rd.norm() / scale.velocity,
                        now.rdd.norm() / scale.acceleration});
      turned = std::max({turned, (now.A - first.A).norm(), now.w.norm() / scale.angular_velocity,
                         now.wd.norm() / scale.angular_acceleration});
    }
    const std::string name = fmt::format("'{}'", scene.bodies[b].name);
    if (moved < kStill && turned < kStill)
      still.push_back(name);
    else if (turned < kStill)
      not_turning.push_back(name);
  }
  if (!still.empty())
    sentences.push_back(fmt::format("not moving: {}; the ground can take the place of such a body", listed(still)));
  if (!not_turning.empty())
    sentences.push_back(
        fmt::format("never turning: {}; the inertia of such a body does not matter, and its rotation costs half of its "
                    "unknowns",
                    listed(not_turning)));
  for (const Group& group : model->groups)
    if (group.kind == GroupKind::joint && group.type == "fixed")
      sentences.push_back(fmt::format("joint '{}' makes one body of two, which a scene can do for less", group.name));
  return sentences;
}

}  // namespace poinsot::study
