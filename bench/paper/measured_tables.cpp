#include "bench/paper/measured_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/paper/cell_rows.h"
#include "bench/paper/mechanisms.h"
#include "bench/paper/paper_tables.h"
#include "bench/paper/phase_tables.h"
#include "core/interruption.h"
#include "core/provenance.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "linsolve/registry.h"

namespace poinsot::paper {
using namespace study;
namespace {

// The paper's settings.
constexpr const char* kIntegrator = "implicit_euler";
constexpr double kStep = 1e-3, kEnd = 3;
constexpr const char* kWhole = "whole";  // of linsolve/linear_system.h's registry
constexpr double kKinematicsTolerance = 1e-10, kDynamicsTolerance = 1e-3;

std::vector<Cell> make_cells(std::span<const Scene> scenes, Analysis analysis, const TablesRequest& request,
                             std::span<const LinearChoice> choices) {
  std::vector<Cell> cells;
  for (std::size_t m = 0; m < kMechanisms.size(); ++m) {
    if (analysis == Analysis::kinematics && !kMechanisms[m].driven) continue;
    for (const LinearChoice& choice : choices) {
      // "whole" is another system only where there is G.
      if (choice.system == kWhole && !kMechanisms[m].driven) continue;
      for (const auto& policy : jacobians())
        for (const FormulationEntry& formulation : formulations()) {
          Settings settings;
          settings.analysis = analysis;
          settings.formulation = formulation.name;
          settings.integrator = kIntegrator;
          settings.retry = false;  // the method as it is
          settings.jacobian = policy.name;
          settings.stopping = "correction";
          settings.linear_solver = choice.solver;
          settings.linear_system = choice.system;
          settings.step = kStep;
          settings.end = request.end();
          settings.tolerance = analysis == Analysis::kinematics ? kKinematicsTolerance : kDynamicsTolerance;
          cells.push_back({kMechanisms[m].file, &scenes[m], settings, {}, {}, false});
        }
    }
  }
  return cells;
}

void measure_told(std::vector<Cell>& cells, int repetitions, const ProgressCallback& progress) {
  RunCounter counter(cells.size() * static_cast<std::size_t>(repetitions + 1), progress);
  measure(cells, {repetitions, true, [&](std::size_t) { counter.next(); }});
}

std::vector<std::string> foot(const TablesRequest& request, int core) {
  std::vector<std::string> lines = origin_lines(core);
  lines.push_back(fmt::format(
      "settings: h = {:g} s, {:g} s simulated, tolerance {:g} (kinematics) and {:g} (dynamics), integrator {}, "
      "linear solver {} where no other is named{}",
      kStep, request.end(), kKinematicsTolerance, kDynamicsTolerance, kIntegrator, request.linear_solver,
      request.quick ? "; --quick, a tenth of the time and few repetitions" : ""));
  lines.push_back(fmt::format(
      "timing: the time-stepping loop without reading and writing; a warm-up, then {} interleaved repetitions, median",
      request.runs()));
  return lines;
}

std::string introduction() {
  std::string text =
      "Like for like is the `simplified` matrix: that is what the original codes use, factored once a step. A step is "
      "one time step with all its Newton iterations. Newton matrices:\n";
  for (const auto& policy : jacobians()) text += fmt::format("\n- `{}`: {}", policy.name, policy.about);
  return text;
}

std::vector<std::string> failures_of(std::span<const Cell> cells) {
  std::vector<std::string> failures;
  for (const Cell& cell : cells)
    if (!cell.failure.empty() && !cell.refused)
      failures.push_back(fmt::format("no figure for {}, {}, {}, {}, {}: {}", cell.name,
                                     analysis_name(cell.settings.analysis), cell.settings.formulation,
                                     cell.settings.jacobian, cell.settings.linear_solver, cell.failure));
  return failures;
}

// Interrupted before: a table would say nothing.
bool nothing_of(std::span<const Cell> cells) {
  return interruption_requested && std::ranges::all_of(cells, [](const Cell& cell) { return cell.runs.empty(); });
}

}  // namespace

double TablesRequest::end() const {
  return quick ? kEnd / 10 : kEnd;
}
int TablesRequest::runs() const {
  return quick ? std::min(repetitions, 5) : repetitions;
}

MeasuredTables measure_tables(const TablesRequest& request, int core, const ProgressCallback& progress) {
  std::vector<Scene> scenes;
  for (const PaperMechanism& mechanism : kMechanisms)
    scenes.push_back(read_scene(request.models / fmt::format("{}.json", mechanism.file)));
  MeasuredTables result;
  Report& report = result.report;
  report = {"The paper's tables, regenerated", introduction(), {constraint_counts(scenes)}, foot(request, core)};
  const std::vector<LinearChoice> chosen{{request.linear_solver, Settings{}.linear_system}};
  std::vector<LinearChoice> choices;
  for (const LinearSolverEntry& entry : linear_solvers()) {
    choices.push_back({std::string(entry.name), Settings{}.linear_system});
    if (entry.takes_jacobian) choices.push_back({std::string(entry.name), kWhole});
  }

  std::vector<Cell> all;
  for (const Analysis analysis : {Analysis::kinematics, Analysis::dynamics}) {
    std::vector<Cell> cells = make_cells(scenes, analysis, request, chosen);
    measure_told(cells, request.runs(), progress);
    if (nothing_of(cells)) continue;
    for (const auto make : {speed_up_table, iterations_table, phases_table, advantage_table})
      report.tables.push_back(make(cells, analysis));
    report.tables.push_back(against_original_table(cells, analysis, processor()));
    all.insert(all.end(), cells.begin(), cells.end());
  }
  std::vector<Cell> cells = make_cells(scenes, Analysis::dynamics, request, choices);
  measure_told(cells, request.runs(), progress);
  if (!nothing_of(cells)) report.tables.push_back(linear_solvers_table(cells));
  all.insert(all.end(), cells.begin(), cells.end());

  result.raw = raw_table(all);
  result.failures = failures_of(all);
  for (const std::string& failure : result.failures) report.text += fmt::format("\n\n{}", failure);
  return result;
}

}  // namespace poinsot::paper
