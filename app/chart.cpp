#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "app/commands.h"
#include "app/models_directory.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/study/chart_file.h"
#include "bench/study/fronts.h"
#include "bench/study/measure.h"
#include "bench/study/natural_end.h"
#include "bench/study/plot.h"
#include "bench/study/report.h"
#include "bench/study/startable_scene.h"
#include "core/input_error.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

// What a sweep goes through. Runs beyond `longest` s, as the run before lets expect them, are left out; integrators
// with error control may take kPatience times as long: what they are for is the accuracy that takes time.
struct Extent {
  std::vector<int> steps;
  std::vector<double> tolerances;
  double longest;
  int repetitions;
  int digits;  // of the reference
};
constexpr double kPatience = 5;
const Extent kFull{{100, 300, 1000, 3000, 10000, 30000, 100000, 300000, 1000000},
                   {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12},
                   1,
                   5,
                   12};
const Extent kQuick{{100, 300, 1000, 3000, 10000}, {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}, 0.02, 3, 10};

struct Options {
  std::vector<std::string> scenes;
  std::string out = "results", end, models, cache = user_cache().string();
  std::string formulations = all_names("formulation"), integrators = all_names("integrator"),
              linear_solvers = kUsualSolver;
  bool all = false, quick = false, fresh = false, quiet = false;

  const Extent& extent() const { return quick ? kQuick : kFull; }
};

std::vector<fs::path> scene_files(const Options& options) {
  std::set<fs::path> files(options.scenes.begin(), options.scenes.end());
  if (options.all) {
    for (const auto& entry : fs::directory_iterator(models_directory(options.models)))
      if (entry.path().extension() == ".json" && entry.path().stem().extension() != ".schema")
        files.insert(entry.path());
  }
  if (files.empty()) throw InputError("found no scene, expected poinsot chart SCENE, or --all");
  std::set<std::string> stems;
  if (files.size() > 1) stems = {"fronts_integrators", "fronts_methods"};  // written, too
  for (const fs::path& file : files)
    if (!stems.insert(file.stem()).second)
      throw InputError(fmt::format("{}: two tables would be written as {}.csv", file.string(), file.stem().string()));
  return {files.begin(), files.end()};
}

SweepPlan plan_of(const Options& options) {
  return {names_given("formulation", options.formulations), names_given("integrator", options.integrators),
          names_given("linear_solver", options.linear_solvers), options.extent().steps, options.extent().tolerances};
}

// Names that fit each other nowhere: there would be nothing to measure.
void require_cases(const SweepPlan& plan) {
  std::string why;
  for (const std::string& integrator : plan.integrators)
    for (const std::string& formulation : plan.formulations) {
      const Refusal* refusal = refusal_of(integrators().require(integrator), formulation);
      if (!refusal) return;
      if (why.empty())
        why = fmt::format("integrator '{}' refuses formulation '{}': {}", integrator, formulation, refusal->why);
    }
  throw InputError(fmt::format("--integrators, --formulations: {}", why));
}

std::vector<std::string> notes(const Scene& scene, double end, const Reference& r, const Options& options,
                               const SweepPlan& plan, int core) {
  std::vector<std::string> lines{fmt::format("scene: {}, content {:016x}", scene.name, content_hash(scene.source))};
  for (const std::string& line : origin_lines(core)) lines.push_back(line);
  lines.push_back(fmt::format("settings: to t = {:g} s; {}; {}; linear solver {}; steps {}; rtol {}, atol rtol/100",
                              end, fmt::join(plan.formulations, " "), fmt::join(plan.integrators, " "),
                              fmt::join(plan.linear_solvers, " "), fmt::join(plan.steps, " "),
                              fmt::join(plan.tolerances, " ")));
  lines.push_back(fmt::format(
      "errors: largest over {} output times and all bodies or constraints, relative to the largest value of the motion "
      "(rotations: rad)",
      kOutputs));
  lines.push_back(
      fmt::format("reference: {} in {}, rtol {:g}, {}; it resolves {:.1g} in positions, {:.1g} in "
                  "velocities, {:.1g} in accelerations, {:.1g} in multipliers",
                  r.of().integrator, r.of().formulation, r.of().tight,
                  r.nearest < 0 ? "not confirmed by another method" : "confirmed by another method", r.agreement[0],
                  r.agreement[1], r.agreement[2], r.agreement[3]));
  lines.push_back(fmt::format(
      "time: of the time-stepping loop, median of {} interleaved repetitions after a first run; runs expected to take "
      "over {:g} s (error control: {:g} s) are left out",
      options.extent().repetitions, options.extent().longest, kPatience * options.extent().longest));
  lines.push_back(fmt::format(
      "front: no other case is as accurate and as fast; errors below {:g} times what the reference resolves count as "
      "equal, errors over {:g} not at all",
      kResolved, kUseless));
  return lines;
}

// What a run takes, in steps, roughly: for the progress only.
double weight(const Case& one, const Extent& extent) {
  constexpr double of_error_control = 3000, per_step = 1e-5;  // s
  if (one.parameter() != "step") return of_error_control;
  const double steps = one.settings.end / one.settings.step;
  return steps * per_step < extent.longest ? steps : 0;
}

// A sentence where the case would take too long, by the run of its method before it.
std::string too_long(const Case& one, const std::vector<std::vector<Case>>& levels, const ChartFile& file,
                     double longest) {
  if (one.level == 0) return {};
  for (const Case& before : levels[static_cast<std::size_t>(one.level) - 1]) {
    if (before.method() != one.method()) continue;
    const ChartRow* row = file.find(before);
    if (!row || row->measured.status.starts_with("left out")) return "left out, as the one before";
    const double expected =
        one.parameter() == "step" ? row->measured.seconds * before.value() / one.value() : row->measured.seconds * 2;
    const double patience = one.parameter() == "step" ? 1 : kPatience;
    if (row->measured.ok() && expected > patience * longest)
      return fmt::format("left out, some {:.2g} s are expected", expected);
  }
  return {};
}

// The progress counts scenes; this one is the `number`th, from 0.
void measure_scene(const Sweep& sweep, const std::vector<std::vector<Case>>& levels, ChartFile& file,
                   const Extent& extent, std::size_t number, std::size_t scenes, ProgressLine& progress) {
  double all = 0, done = 0, skipped_here = 0;
  for (const auto& level : levels)
    for (const Case& one : level) all += weight(one, extent) * (1 + extent.repetitions);
  for (const std::vector<Case>& level : levels) {
    std::vector<Case> batch;
    for (const Case& one : level) {
      const bool measured = file.find(one);
      const std::string why = measured ? "" : too_long(one, levels, file, extent.longest);
      if (!measured && why.empty()) {
        batch.push_back(one);
        continue;
      }
      if (!measured) file.add(one, {why});
      const double skipped = weight(one, extent) * (1 + extent.repetitions);
      done += skipped;
      skipped_here += skipped / all;
    }
    const std::vector<Measured> measured = sweep.measure(batch, extent.repetitions, [&](const Case& one) {
      done += weight(one, extent);
      progress.at({static_cast<double>(number) + done / all, static_cast<double>(scenes), skipped_here});
    });
    for (std::size_t k = 0; k < batch.size(); ++k) file.add(batch[k], measured[k]);
  }
}

int chart(const Options& options) {
  const std::vector<fs::path> files = scene_files(options);
  const SweepPlan plan = plan_of(options);
  require_cases(plan);
  std::vector<Scene> scenes;
  for (const fs::path& file : files) scenes.push_back(read_startable_scene(file));
  if (!options.end.empty()) (void)end_time(options.end, scenes.front());  // a wrong one, before anything is written
  make_folder(options.out);
  const int core = pin_to_one_core();

  int status = kDone;
  std::vector<Chart> charts;
  std::vector<Plot> plots;
  ProgressLine progress("scenes", !options.quiet);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const double end = end_time(options.end, scenes[k]);
    std::vector<std::string> said;
    const Reference r =
        reference(scenes[k], {end, end / kOutputs, options.extent().digits}, Cache(options.cache), said);
    for (const std::string& notice : said) {
      progress.clear();
      if (!options.quiet) print_notice(notice);
    }
    if (r.given < 0) {
      progress.clear();
      print_error(fmt::format("{}: no chart: {}", files[k].string(), why_none(r)));
      status = kNumericsFailed;
      continue;
    }
    const fs::path stem = fs::path(options.out) / files[k].stem();
    ChartFile file(fs::path(stem).concat(".csv"), notes(scenes[k], end, r, options, plan, core), options.fresh);
    const Sweep sweep(scenes[k], end, r);
    measure_scene(sweep, sweep.cases(plan), file, options.extent(), k, scenes.size(), progress);
    file.finish(r);
    charts.push_back({stem.filename(), file.rows()});
    plots.push_back({file.path(), stem});
  }
  progress.clear();
  if (charts.empty()) return status;
  if (const std::string why = draw("work_precision", plots); !why.empty() && !options.quiet) print_notice(why);
  std::vector<fs::path> written;
  for (const Plot& plot : plots) written.push_back(plot.csv);
  if (charts.size() > 1) {
    std::vector<std::string> foot = origin_lines(core);
    foot.push_back(options.quick ? "settings: the reduced set, --quick" : "settings: the full set");
    std::ranges::copy(write_report(fronts_report(plan.integrators, charts, foot), options.out, "fronts"),
                      std::back_inserter(written));
  }
  if (options.quiet) return status;
  for (const fs::path& file : written) fmt::print("{}\n", file.string());
  fmt::print("{}", fronts_summary(plan.integrators, charts));
  return status;
}

}  // namespace

void add_chart(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("chart", "measure speed against accuracy of all methods, and draw it");
  const auto options = std::make_shared<Options>();
  command->add_option("scenes", options->scenes, "scene files")->type_name("SCENE");
  command->add_flag("--all", options->all, "the models that came with the program, too");
  add_models(*command, options->models);
  add_out_folder(*command, options->out, "a CSV, SVG and PNG for each scene, and of several a summary of the fronts");
  command->add_flag("--quick", options->quick, "a reduced set: fewer and shorter runs, a reference of ten digits");
  add_end(*command, options->end);
  add_names(*command, "formulation", options->formulations);
  add_names(*command, "integrator", options->integrators);
  add_names(*command, "linear_solver", options->linear_solvers);
  command->add_flag("--fresh", options->fresh, "measure everything, also what the folder holds already");
  add_cache(*command, options->cache);
  add_quiet(*command, options->quiet);
  command->footer(
      "Errors are those against a reference (`poinsot reference`). A sweep that was interrupted goes on where it\n"
      "stopped when the command is given again.");
  command->callback([options, &status] { status = chart(*options); });
}

}  // namespace poinsot::app
