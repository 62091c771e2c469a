#include "bench/study/scene_check_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/study/name_list.h"
#include "core/counted.h"
#include "core/printable.h"
#include "core/reaction_components.h"
#include "formulations/registry.h"

namespace poinsot::study {
namespace {
using Ordered = nlohmann::ordered_json;

// "joint 'hinge'", "driver 'motor'": the groups that rows belong to. Rows of a group lie together.
std::vector<std::string> groups_of(const Model& model, std::span<const int> rows) {
  constexpr const char* kinds[] = {"constraint", "joint", "driver"};
  std::vector<std::string> groups;
  int last = -1;
  for (const int row : rows) {
    const int k = model.rows[static_cast<std::size_t>(row)].group;
    if (k == std::exchange(last, k)) continue;
    const Group& group = model.groups[static_cast<std::size_t>(k)];
    groups.push_back(fmt::format("{} '{}'", kinds[static_cast<int>(group.kind)], group.name));
  }
  return groups;
}

std::string groups_text(const Model& model, std::span<const int> rows) {
  return listed(groups_of(model, rows));
}

void add_header(std::string& text, const Model& model) {
  const std::size_t forces = model.point_forces.size() + model.torques.size() + model.springs.size() +
                             model.torsions.size() + model.drags.size() + model.callbacks.size();
  text += fmt::format("{}: {}, {}, {}\n", printable(model.name), counted(model.bodies.size(), "body", "bodies"),
                      counted(model.rows.size(), "constraint row"), counted(forces, "force"));
}

void add_measures(std::string& text, const SceneCheck& found) {
  const Vector3 &x = found.extent, &g = found.model->gravity;
  text += fmt::format("mass: {:.6g} kg; extent: {:.4g} x {:.4g} x {:.4g} m; gravity: {}\n", found.mass, x.x(), x.y(),
                      x.z(), g.isZero(0) ? "none" : fmt::format("[{:g}, {:g}, {:g}] m/s2", g.x(), g.y(), g.z()));
}

// Of the first joints; in a scene of thousands nobody reads them all.
void add_joints(std::string& text, const Model& model) {
  constexpr int most = 20;
  int joints = 0;
  for (const Group& group : model.groups) {
    if (group.kind != GroupKind::joint || ++joints > most) continue;
    text += fmt::format("joint '{}' leaves free: {}\n", group.name, left_free(group));
  }
  if (joints > most) text += fmt::format("... and {} more joints\n", joints - most);
}

void add_constraints(std::string& text, const SceneCheck& found) {
  const Model& model = *found.model;
  const RankAnalysis& analysis = found.rank;
  const std::vector<Conflict>& conflicts = analysis.conflicts;
  text += fmt::format("degrees of freedom: {}\n", analysis.degrees_of_freedom());
  if (analysis.singular_position())
    text += fmt::format("  the initial pose is a singular position: {} independent rows here, {} beside it\n",
                        analysis.rank_here, analysis.rank);
  for (const Dependency& d : analysis.singular)
    text += fmt::format("  {} is singular here: {}\n", describe_row(model, d.row),
                        d.others.empty() ? "its gradient vanishes" : "it follows from " + groups_text(model, d.others));
  for (const Dependency& d : analysis.touching)
    text += fmt::format("  {} follows from {} along the motion that begins here, to the first order of it\n",
                        describe_row(model, d.row), groups_text(model, d.others));
  const std::size_t redundant = analysis.dependent.size() - conflicts.size();
  text += fmt::format("redundant constraints: {}\n", redundant == 0 ? "none" : counted(redundant, "row"));
  if (!analysis.named)
    text += fmt::format("  {} dependent rows in a mechanism so connected: what each follows from is not worked out\n",
                        analysis.dependent.size());
  const auto from = [&](const Dependency& d) { return analysis.named ? groups_text(model, d.others) : "other rows"; };
  const auto alone = [&](const Dependency& d) { return analysis.named && d.others.empty(); };
  const auto conflict_of = [&](const Dependency& d) { return std::ranges::find(conflicts, d.row, &Conflict::row); };
  for (const Dependency& d : analysis.dependent)
    if (conflict_of(d) == conflicts.end())
      text += fmt::format("  {} {}\n", describe_row(model, d.row),
                          alone(d) ? "has no gradient here" : "follows from " + from(d));
  text += fmt::format("conflicting constraints: {}\n", conflicts.empty() ? "none" : counted(conflicts.size(), "row"));
  for (const Dependency& d : analysis.dependent)
    if (const auto conflict = conflict_of(d); conflict != conflicts.end())
      text += alone(d) ? fmt::format("  {} is violated and has no gradient here: no way leads to where it holds\n",
                                     describe_row(model, d.row))
                       : fmt::format("  {} contradicts {}: off by {} where those hold\n", describe_row(model, d.row),
                                     from(d), describe(*conflict));
}

std::vector<int> undetermined_rows(const SceneCheck& found) {
  std::vector<int> rows;
  for (const Undetermined& reaction : found.rank.undetermined)
    rows.push_back(found.model->groups[static_cast<std::size_t>(reaction.group)].first_row);
  return rows;
}

// Each with its components, where others of them are unique.
void add_undetermined(std::string& text, const SceneCheck& found) {
  if (found.rank.undetermined.empty()) return;
  std::vector<std::string> reactions = groups_of(*found.model, undetermined_rows(found));
  for (std::size_t k = 0; k < reactions.size(); ++k) {
    const std::vector<std::string> components = found.rank.undetermined[k].components(*found.model);
    if (!components.empty() && components.size() < kReactionComponents.size())
      reactions[k] += fmt::format(" ({})", fmt::join(components, " "));
  }
  text += fmt::format("reactions that redundant rows leave undetermined: {}\n", printable(listed(reactions)));
}

void add_doubt(std::string& text, const SceneCheck& found) {
  const RankAnalysis& analysis = found.rank;
  if (analysis.doubt.row < 0) return;
  text += fmt::format("neither dependent nor clearly independent: {}, of which {:.0e} is left{}\n",
                      describe_row(*found.model, analysis.doubt.row), analysis.doubt.part,
                      analysis.doubt.vanishing ? "" : " beside the others");
}

void add_state(std::string& text, const SceneCheck& found) {
  const auto line = [&](const char* what, double largest, int row, int order) {
    if (largest <= kSatisfied)
      text += fmt::format("{}: consistent, largest violation {:.2g}\n", what, largest);
    else
      text += fmt::format("{}: violates {} by {}, the most of all\n", what, describe_row(*found.model, row),
                          describe_residual(*found.model, row, largest, order));
  };
  const Violation& v = found.violation;
  line("initial pose", v.position, v.position_row, 0);
  line("initial velocities", v.velocity, v.velocity_row, 1);
}

void add_derivatives(std::string& text, const SceneCheck& found) {
  text += fmt::format("derivatives: {} compared ({}), {}\n", found.derivatives, fmt::join(formulations().names(), ", "),
                      found.wrong.empty()
                          ? fmt::format("all right, largest relative difference {:.2g}", found.derivative_error)
                          : fmt::format("{} wrong", found.wrong.size()));
  for (const auto& [formulation, derivative] : found.wrong)
    text +=
        fmt::format("  {}: {}: {} is off by {:.3g}\n", formulation, derivative.name, derivative.what, derivative.error);
}

}  // namespace

std::string check_text(const SceneCheck& found) {
  std::string text;
  add_header(text, *found.model);
  add_measures(text, found);
  add_joints(text, *found.model);
  add_constraints(text, found);
  add_undetermined(text, found);
  add_doubt(text, found);
  add_state(text, found);
  if (!found.rank.conflicts.empty() || !found.refusal.empty()) return text;
  for (const std::string& notice : found.start.notices) text += fmt::format("  {}\n", printable(notice));
  add_derivatives(text, found);
  return text;
}

std::string verdict(const SceneCheck& found) {
  if (!found.rank.conflicts.empty()) return "the constraints conflict; remove or correct one of those named";
  if (!found.refusal.empty()) return found.refusal;
  if (found.sound()) return {};
  // Derivatives that are not finite are why the start fails where they are: they are named first.
  return found.wrong.empty() || found.start.status.failure == Failure::not_finite
             ? found.start.status.message
             : "derivatives are wrong or not finite at t = 0; try functions of time that have two derivatives there";
}

nlohmann::ordered_json check_json(const SceneCheck& found) {
  const Model& model = *found.model;
  const RankAnalysis& rank = found.rank;
  const auto dependencies = [&](std::span<const Dependency> all, bool conflicting) {
    Ordered list = Ordered::array();
    for (const Dependency& d : all) {
      const auto conflict = std::ranges::find(rank.conflicts, d.row, &Conflict::row);
      if ((conflict != rank.conflicts.end()) != conflicting) continue;
      Ordered& one =
          list.emplace_back(Ordered{{"row", describe_row(model, d.row)}, {"follows_from", groups_of(model, d.others)}});
      if (conflicting) one["off_by"] = describe(*conflict);
    }
    return list;
  };
  Ordered joints = Ordered::array();
  for (const Group& group : model.groups)
    if (group.kind == GroupKind::joint)
      joints.push_back({{"name", group.name}, {"leaves_free", std::string(left_free(group))}});
  std::vector<std::string> notices = found.notices;
  notices.insert(notices.end(), found.start.notices.begin(), found.start.notices.end());
  Ordered wrong = Ordered::array();
  for (const auto& [formulation, derivative] : found.wrong)
    wrong.push_back({{"formulation", formulation},
                     {"of", derivative.name},
                     {"what", derivative.what},
                     {"off_by", derivative.error}});
  auto components = Ordered::array();
  for (const Undetermined& reaction : rank.undetermined) components.push_back(reaction.components(model));
  return {{"scene", model.name},
          {"bodies", model.bodies.size()},
          {"rows", model.rows.size()},
          {"mass", found.mass},
          {"extent", {found.extent.x(), found.extent.y(), found.extent.z()}},
          {"gravity", {model.gravity.x(), model.gravity.y(), model.gravity.z()}},
          {"joints", joints},
          {"degrees_of_freedom", rank.degrees_of_freedom()},
          {"singular_position", rank.singular_position()},
          {"singular", dependencies(rank.singular, false)},
          {"touching", dependencies(rank.touching, false)},
          {"redundant", dependencies(rank.dependent, false)},
          {"conflicting", dependencies(rank.dependent, true)},
          {"undetermined_reactions", groups_of(model, undetermined_rows(found))},
          {"undetermined_components", components},
          {"violation", {{"position", found.violation.position}, {"velocity", found.violation.velocity}}},
          {"notices", notices},
          {"derivatives",
           {{"compared", found.derivatives}, {"largest_difference", found.derivative_error}, {"wrong", wrong}}},
          {"sound", found.sound()},
          {"message", verdict(found)}};
}

}  // namespace poinsot::study
