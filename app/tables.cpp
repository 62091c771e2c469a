#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "app/models_directory.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/paper/cell_rows.h"
#include "bench/paper/paper_tables.h"
#include "bench/paper/phase_tables.h"
#include "bench/study/output_file.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "integrators/settings_reader.h"
#include "linsolve/registry.h"

namespace poinsot::app {
using namespace study;
using namespace paper;
namespace {
namespace fs = std::filesystem;

// The paper's settings.
constexpr double kStep = 1e-3, kEnd = 3;
constexpr double kKinematicsTolerance = 1e-10, kDynamicsTolerance = 1e-3;

struct Options {
  std::string out = "results", models, linear_solver = Settings{}.linear_solver;
  int repetitions = 11;
  bool quick = false, quiet = false;

  double end() const { return quick ? kEnd / 10 : kEnd; }
  int runs() const { return quick ? std::min(repetitions, 5) : repetitions; }
};

std::vector<Cell> make_cells(std::span<const Scene> scenes, Analysis analysis, const Options& options,
                             std::span<const std::string> solvers) {
  std::vector<Cell> cells;
  for (std::size_t m = 0; m < kMechanisms.size(); ++m) {
    if (analysis == Analysis::kinematics && !kMechanisms[m].driven) continue;
    for (const std::string& solver : solvers)
      for (const auto& policy : jacobians())
        for (const FormulationEntry& formulation : formulations()) {
          Settings settings;
          settings.analysis = analysis;
          settings.formulation = formulation.name;
          settings.jacobian = policy.name;
          settings.linear_solver = solver;
          settings.step = kStep;
          settings.end = options.end();
          settings.tolerance = analysis == Analysis::kinematics ? kKinematicsTolerance : kDynamicsTolerance;
          cells.push_back({kMechanisms[m].file, &scenes[m], settings, {}, {}, false});
        }
  }
  return cells;
}

std::vector<std::string> foot(const Options& options, int core) {
  std::vector<std::string> lines = origin_lines(core);
  lines.push_back(fmt::format(
      "settings: h = {:g} s, {:g} s simulated, tolerance {:g} (kinematics) and {:g} (dynamics), integrator {}, "
      "linear solver {} where no other is named",
      kStep, options.end(), kKinematicsTolerance, kDynamicsTolerance, Settings{}.integrator, options.linear_solver));
  lines.push_back(fmt::format(
      "timing: the time-stepping loop without reading and writing; a warm-up, then {} interleaved repetitions, median",
      options.runs()));
  return lines;
}

std::string introduction() {
  std::string text =
      "Like for like is the `simplified` matrix: that is what the original codes use, factored once a step. A step is "
      "one time step with all its Newton iterations. Newton matrices:\n";
  for (const auto& policy : jacobians()) text += fmt::format("\n- `{}`: {}", policy.name, policy.about);
  return text;
}

// The cells without figures; what a linear solver refuses is no failure, and the table of linear solvers tells it.
int report_failures(std::span<const Cell> cells, std::string& text) {
  int failures = 0;
  for (const Cell& cell : cells) {
    if (cell.failure.empty() || cell.refused) continue;
    const std::string sentence =
        fmt::format("no figure for {}, {}, {}, {}, {}: {}", cell.name, analysis_name(cell.settings.analysis),
                    cell.settings.formulation, cell.settings.jacobian, cell.settings.linear_solver, cell.failure);
    print_error(sentence);
    text += fmt::format("\n\n{}", sentence);
    ++failures;
  }
  return failures;
}

int tables(const Options& options) {
  Settings checked;
  set_setting(*find_setting("linear_solver"), options.linear_solver, checked);
  require_positive("--repetitions", options.repetitions);
  const fs::path models = models_directory(options.models);
  std::vector<Scene> scenes;
  for (const Mechanism& mechanism : kMechanisms)
    scenes.push_back(read_scene(models / fmt::format("{}.json", mechanism.file)));
  Report report{"The paper's tables, regenerated", introduction(), {constraint_counts(scenes)}, {}};
  make_folder(options.out);

  const int core = pin_to_one_core();
  report.foot = foot(options, core);
  const std::vector<std::string> chosen{options.linear_solver};
  std::vector<std::string> solvers;
  for (const LinearSolverEntry& entry : linear_solvers()) solvers.emplace_back(entry.name);

  std::vector<Cell> all;
  ProgressLine progress("runs", !options.quiet);
  for (const Analysis analysis : {Analysis::kinematics, Analysis::dynamics}) {
    std::vector<Cell> cells = make_cells(scenes, analysis, options, chosen);
    measure(cells, options.runs(), progress.callback());
    for (const auto make : {speed_up_table, iterations_table, phases_table, advantage_table, against_original_table})
      report.tables.push_back(make(cells, analysis));
    all.insert(all.end(), cells.begin(), cells.end());
  }
  std::vector<Cell> cells = make_cells(scenes, Analysis::dynamics, options, solvers);
  measure(cells, options.runs(), progress.callback());
  progress.clear();
  report.tables.push_back(linear_solvers_table(cells));
  all.insert(all.end(), cells.begin(), cells.end());

  const int failures = report_failures(all, report.text);
  const std::vector<fs::path> written = write_report(report, options.out, "tables");
  OutputFile raw(fs::path(options.out) / "raw.csv");
  raw.write(csv(raw_table(all), report.foot));
  raw.commit();
  if (!options.quiet) fmt::print("{} and {} CSV files beside it\n", written.front().string(), written.size());
  return failures == 0 ? kDone : kNumericsFailed;
}

}  // namespace

void add_tables(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("tables", "measure and write the paper's tables, ours beside the paper's figures");
  const auto options = std::make_shared<Options>();
  add_out_folder(*command, options->out, "the Markdown page and the CSV files");
  add_models(*command, options->models);
  command
      ->add_option(
          "--linear-solver", options->linear_solver,
          fmt::format("of the paper's tables (default {}); one more table compares all", options->linear_solver))
      ->type_name("NAME");
  add_repetitions(*command, options->repetitions, "each cell");
  command->add_flag("--quick", options->quick,
                    "a tenth of the simulated time and at most 5 repetitions: to see that it works");
  add_quiet(*command, options->quiet);
  command->callback([options, &status] { status = tables(*options); });
}

}  // namespace poinsot::app
