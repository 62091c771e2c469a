#include "bench/study/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/study/fronts.h"
#include "bench/study/measure.h"
#include "bench/study/plot.h"
#include "bench/study/scene_check.h"
#include "bench/study/startable_scene.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "integrators/integrator.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

std::vector<std::string> integrators_of(Analysis analysis) {
  std::vector<std::string> names;
  for (const IntegratorEntry& entry : integrators())
    if (entry.analysis == analysis && !entry.picks) names.emplace_back(entry.name);
  return names;
}

// By default: all of dynamics, each by its own name; kinematics takes part where it computes the motion, too.
std::string compared_integrators() {
  return fmt::format("{}", fmt::join(integrators_of(Analysis::dynamics), ","));
}

struct ChartOptions {
  std::vector<std::string> scenes, set;
  std::string out = "results", end, models, cache = user_cache().string();
  std::string formulations = all_names("formulation"), integrators = compared_integrators(),
              linear_solvers = kUsualSolver;
  bool all = false, quick = false, fresh = false, quiet = false;
};

// What its chart is called.
std::string stem_of(const fs::path& scene) {
  return scene == "-" ? "standard_input" : scene.stem().string();
}

std::vector<fs::path> scene_files(const ChartOptions& options) {
  std::set<fs::path> files(options.scenes.begin(), options.scenes.end());
  if (options.all) {
    for (const auto& entry : fs::directory_iterator(models_directory(options.models)))
      if (entry.path().extension() == ".json" && entry.path().stem().extension() != ".schema")
        files.insert(entry.path());
  }
  if (files.empty()) throw InputError("found no scene, expected poinsot chart SCENE, or --all");
  std::set<std::string> stems{"fronts_integrators", "fronts_methods", "fronts_choice", "fronts_plot"};  // written, too
  for (const fs::path& file : files)
    if (!stems.insert(stem_of(file)).second)
      throw InputError(fmt::format("{}: two tables would be written as {}.csv", shown_input(file), stem_of(file)));
  return {files.begin(), files.end()};
}

SweepPlan plan_of(const ChartOptions& options) {
  SweepPlan plan = options.quick ? SweepPlan::quick() : SweepPlan::full();
  plan.formulations = names_given("formulation", options.formulations);
  plan.integrators = names_given("integrator", options.integrators);
  plan.linear_solvers = names_given("linear_solver", options.linear_solvers);
  try {
    require_cases(plan);
  } catch (const InputError& refused) {
    throw InputError(fmt::format("--integrators, --formulations: {}", refused.what()));
  }
  return plan;
}

SweepPlan plan_for(const Scene& scene, const SweepPlan& asked, const ChartOptions& options) {
  SweepPlan plan = asked;
  if (options.integrators == compared_integrators() && without_freedom(scene))
    std::ranges::copy(integrators_of(Analysis::kinematics), std::back_inserter(plan.integrators));
  return plan;
}

// The order of the tables: what was asked for comes first.
std::vector<std::string> all_integrators(const std::vector<std::string>& asked) {
  std::vector<std::string> names = asked;
  for (const IntegratorEntry& entry : integrators())
    if (std::ranges::find(names, entry.name) == names.end()) names.emplace_back(entry.name);
  return names;
}

// Of all charts that lie in the folder, of this sweep and of those before: the page, and why it lacks its picture.
std::string write_fronts(const ChartOptions& options, const std::vector<std::string>& asked,
                         std::vector<SceneChart> charts, int core, std::vector<fs::path>& written) {
  std::vector<std::string> foot = origin_lines(core), notices;
  foot.push_back(options.quick ? "settings: the reduced set, --quick" : "settings: the full set");
  const std::vector<SceneChart> before = charts_before(options.out, charts, notices);
  if (!options.quiet) std::ranges::for_each(notices, print_notice);
  for (const SceneChart& one : before) foot.push_back(fmt::format("{0}: measured before, as {0}.csv says", one.scene));
  std::ranges::copy(before, std::back_inserter(charts));
  if (charts.size() < 2 && !fs::exists(fs::path(options.out) / "fronts.md")) return "";
  std::ranges::sort(charts, {}, &SceneChart::scene);
  Report report = fronts_report(all_integrators(asked), charts, foot);
  const std::string why = write_plots({fronts_plot(charts)}, options.out, foot);
  if (why.empty())
    report.text +=
        "\n\n![Time against the error in positions, of the cheapest method of each integrator](fronts_plot.svg)";
  std::ranges::copy(write_report(report, options.out, "fronts"), std::back_inserter(written));
  return why;
}

int chart(const ChartOptions& options) {
  const std::vector<fs::path> files = scene_files(options);
  const SweepPlan asked = plan_of(options);
  std::vector<Scene> scenes;
  for (const fs::path& file : files) scenes.push_back(read_startable_scene(file, values_set(options.set)));
  if (!options.end.empty()) (void)end_time(options.end, scenes.front());  // a wrong one, before anything is written
  make_folder(options.out);
  const int core = pin_to_one_core();

  int status = kDone;
  std::vector<SceneChart> charts;
  std::vector<Plot> plots;
  ProgressLine progress("scenes", !options.quiet);
  study::Progress told{0, static_cast<double>(scenes.size())};
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const double end = end_time(options.end, scenes[k]);
    const SweepPlan plan = plan_for(scenes[k], asked, options);
    std::vector<std::string> said = scenes[k].notices;
    const Reference r = reference(scenes[k], {end, end / kOutputs, plan.digits}, Cache(options.cache), said);
    for (const std::string& notice : said) {
      progress.clear();
      if (!options.quiet) print_notice(with_lines_of(files[k], notice));
    }
    if (r.given < 0) {
      progress.clear();
      print_error(fmt::format("{}: no chart: {}", shown_input(files[k]), with_lines_of(files[k], why_none(r))));
      status = kNumericsFailed;
      continue;
    }
    const fs::path stem = fs::path(options.out) / stem_of(files[k]);
    ChartFile file(fs::path(stem).concat(".csv"), chart_notes(scenes[k], end, r, plan, core), options.fresh);
    const double before = told.skipped;
    measure_chart(scenes[k], end, r, plan, file, [&](const study::Progress& here) {
      told.done = static_cast<double>(k) + here.done / here.all;
      told.skipped = before + here.skipped / here.all;
      progress.at(told);
    });
    charts.push_back({stem.filename(), file.rows(), r.agreement, without_freedom(scenes[k])});
    plots.push_back({file.path(), stem});
  }
  progress.clear();
  if (charts.empty()) return status;
  if (const std::string why = draw("work_precision", plots); !why.empty()) {
    print_error(why);
    status = kNumericsFailed;
  }
  std::vector<fs::path> written;
  for (const Plot& plot : plots) written.push_back(plot.csv);
  if (const std::string why = write_fronts(options, asked.integrators, charts, core, written); !why.empty()) {
    print_error(why);
    status = kNumericsFailed;
  }
  if (options.quiet) return status;
  for (const fs::path& file : written) fmt::print("{}\n", file.string());
  fmt::print("{}", fronts_summary(all_integrators(asked.integrators), charts));
  return status;
}

}  // namespace

void add_chart(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "chart", "measure speed against accuracy of all methods, and draw it", chart);
  command.add_option("scenes", options.scenes, "scene files")->type_name("SCENE");
  add_set(command, options.set);
  command.add_flag("--all", options.all, "the models that came with the program, too");
  add_models(command, options.models);
  add_out_folder(command, options.out,
                 "a CSV, SVG and PNG for each scene, and a summary of the fronts of all charts in it");
  command.add_flag("--quick", options.quick, "a reduced set: fewer and shorter runs, a reference of ten digits");
  add_end(command, options.end);
  add_names(command, "formulation", options.formulations);
  add_names(command, "integrator", options.integrators);
  add_names(command, "linear_solver", options.linear_solvers);
  command.add_flag("--fresh", options.fresh, "measure everything, also what the folder holds already");
  add_cache(command, options.cache);
  add_quiet(command, options.quiet);
  command.footer(
      "Errors are those against a reference (`poinsot reference`). A sweep that was interrupted goes on where it\n"
      "stopped when the command is given again.");
}

}  // namespace poinsot::app
