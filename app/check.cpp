#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/study/scene_check.h"
#include "core/printable.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"

namespace poinsot::app {
using namespace study;
namespace {

std::string count(std::size_t n, std::string_view one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

// "joint 'hinge', driver 'motor'": the groups that rows belong to, the first few of them. Rows of a group lie together.
std::string groups_text(const Model& model, std::span<const int> rows) {
  constexpr int most = 8;
  constexpr const char* kinds[] = {"constraint", "joint", "driver"};
  std::string text;
  int groups = 0, last = -1;
  for (const int row : rows) {
    const int k = model.rows[static_cast<std::size_t>(row)].group;
    if (k == std::exchange(last, k) || ++groups > most) continue;
    const Group& group = model.groups[static_cast<std::size_t>(k)];
    text += fmt::format("{}{} '{}'", groups > 1 ? ", " : "", kinds[static_cast<int>(group.kind)], group.name);
  }
  return groups > most ? fmt::format("{} and {} more", text, groups - most) : text;
}

void print_header(const Model& model) {
  const std::size_t forces = model.point_forces.size() + model.torques.size() + model.springs.size() +
                             model.torsions.size() + model.drags.size();
  fmt::print("{}: {} {}, {}, {}\n", printable(model.name), model.bodies.size(),
             model.bodies.size() == 1 ? "body" : "bodies", count(model.rows.size(), "constraint row"),
             count(forces, "force"));
}

void print_measures(const SceneCheck& found) {
  const Vector3 &x = found.extent, &g = found.model->gravity;
  fmt::print("mass: {:.6g} kg; extent: {:.4g} x {:.4g} x {:.4g} m; gravity: {}\n", found.mass, x.x(), x.y(), x.z(),
             g.isZero(0) ? "none" : fmt::format("[{:g}, {:g}, {:g}] m/s2", g.x(), g.y(), g.z()));
}

// Of the first joints; in a scene of thousands nobody reads them all.
void print_joints(const Model& model) {
  constexpr int most = 20;
  int joints = 0;
  for (const Group& group : model.groups) {
    if (group.kind != GroupKind::joint || ++joints > most) continue;
    fmt::print("joint '{}' leaves free: {}\n", group.name, left_free(group));
  }
  if (joints > most) fmt::print("... and {} more joints\n", joints - most);
}

void print_constraints(const SceneCheck& found) {
  const Model& model = *found.model;
  const RankAnalysis& analysis = found.rank;
  const std::vector<Conflict>& conflicts = analysis.conflicts;
  fmt::print("degrees of freedom: {}\n", analysis.degrees_of_freedom());
  if (analysis.singular_position())
    fmt::print("  the initial pose is a singular position: {} independent rows here, {} beside it\n",
               analysis.rank_here, analysis.rank);
  for (const Dependency& d : analysis.singular)
    fmt::print("  {} is singular here: {}\n", describe_row(model, d.row),
               d.others.empty() ? "its gradient vanishes" : "it follows from " + groups_text(model, d.others));
  const std::size_t redundant = analysis.dependent.size() - conflicts.size();
  fmt::print("redundant constraints: {}\n", redundant == 0 ? "none" : count(redundant, "row"));
  if (!analysis.named)
    fmt::print("  {} dependent rows in a mechanism so connected: what each follows from is not worked out\n",
               analysis.dependent.size());
  const auto from = [&](const Dependency& d) { return analysis.named ? groups_text(model, d.others) : "other rows"; };
  // Both lists are by row.
  auto conflict = conflicts.begin();
  for (const Dependency& d : analysis.dependent) {
    if (conflict != conflicts.end() && conflict->row == d.row)
      ++conflict;
    else
      fmt::print("  {} follows from {}\n", describe_row(model, d.row), from(d));
  }
  fmt::print("conflicting constraints: {}\n", conflicts.empty() ? "none" : count(conflicts.size(), "row"));
  conflict = conflicts.begin();
  for (const Dependency& d : analysis.dependent) {
    if (conflict == conflicts.end() || conflict->row != d.row) continue;
    fmt::print("  {} contradicts {}: off by {} where those hold\n", describe_row(model, d.row), from(d),
               describe(*conflict));
    ++conflict;
  }
}

void print_undetermined(const SceneCheck& found) {
  if (found.rank.undetermined.empty()) return;
  std::vector<int> rows;
  for (const int group : found.rank.undetermined)
    rows.push_back(found.model->groups[static_cast<std::size_t>(group)].first_row);
  fmt::print("reactions that redundant rows leave undetermined: {}\n", groups_text(*found.model, rows));
}

void print_doubt(const SceneCheck& found) {
  const RankAnalysis& analysis = found.rank;
  if (analysis.doubtful < 0) return;
  fmt::print("neither dependent nor clearly independent: {}, of which {:.0e} is left beside the others\n",
             describe_row(*found.model, analysis.doubtful), analysis.doubt);
}

void print_state(const SceneCheck& found) {
  const auto line = [&](const char* what, double largest, int row, int order) {
    if (largest <= kSatisfied)
      fmt::print("{}: consistent, largest violation {:.2g}\n", what, largest);
    else
      fmt::print("{}: violates {} by {}, the most of all\n", what, describe_row(*found.model, row),
                 describe_residual(*found.model, row, largest, order));
  };
  const Violation& v = found.violation;
  line("initial pose", v.position, v.position_row, 0);
  line("initial velocities", v.velocity, v.velocity_row, 1);
}

void print_derivatives(const SceneCheck& found) {
  std::vector<std::string_view> names;
  for (const FormulationEntry& formulation : formulations()) names.push_back(formulation.name);
  fmt::print("derivatives: {} compared ({}), {}\n", found.derivatives, fmt::join(names, ", "),
             found.wrong.empty() ? fmt::format("all right, largest relative difference {:.2g}", found.derivative_error)
                                 : fmt::format("{} wrong", found.wrong.size()));
  for (const auto& [formulation, derivative] : found.wrong)
    fmt::print("  {}: {}: {} is off by {:.3g}\n", formulation, derivative.name, derivative.what, derivative.error);
}

int run_check(const std::string& file, const ParameterValues& set) {
  const SceneCheck found = check_scene(read_scene(file, set));
  for (const std::string& notice : found.notices) print_notice(notice);
  print_header(*found.model);
  print_measures(found);
  print_joints(*found.model);
  print_constraints(found);
  print_undetermined(found);
  print_doubt(found);
  print_state(found);
  if (!found.rank.conflicts.empty()) {
    print_error(fmt::format("{}: the constraints conflict; remove or correct one of those named", file));
    return kWrongInput;
  }
  if (!found.refusal.empty()) {
    print_error(found.refusal);
    return kWrongInput;
  }
  if (!found.consistent())
    for (const std::string& notice : found.start.notices) fmt::print("  {}\n", notice);
  print_derivatives(found);
  if (found.sound()) return kDone;
  // Derivatives that are not finite are why the start fails where they are: they are named first.
  print_error(found.wrong.empty() || found.start.status.failure == Failure::not_finite
                  ? found.start.status.message
                  : fmt::format("{}: derivatives are wrong or not finite at t = 0; try functions of time that have two "
                                "derivatives there",
                                file));
  return kNumericsFailed;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "check", "degrees of freedom, redundant and conflicting constraints, initial state, derivatives");
  const auto file = std::make_shared<std::string>();
  const auto set = std::make_shared<std::vector<std::string>>();
  add_scene(*command, *file);
  add_set(*command, *set);
  command->callback([file, set, &status] { status = run_check(*file, values_set(*set)); });
}

}  // namespace poinsot::app
