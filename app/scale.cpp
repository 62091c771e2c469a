#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/study/measure.h"
#include "bench/study/scale_series.h"

namespace poinsot::app {
using namespace study;
namespace {

struct Options {
  std::string out = "results", linear_solvers = "block", formulations = all_names("formulation");
  int most = 100000, repetitions = 3;
  bool quiet = false;
};

// A series ends where ten times the bodies would take longer than this at the same cost per body.
constexpr double kLongestRun = 60;  // s

bool too_long(const std::vector<IsolatedRun>& runs) {
  return good(runs) && 10 * runs.front().seconds > kLongestRun;
}

std::vector<int> sizes(int most) {
  std::vector<int> all;
  for (int n = 1; n <= most; n *= 10) all.push_back(n);
  return all;
}

// Few steps where a step is long: about as much work for every size, 5 to 200 steps after the first.
double end_of(int bodies, double step) {
  return step * (1 + std::clamp(20000 / bodies, 5, 200));
}

int scale(const Options& options) {
  const auto solvers = names_given("linear_solver", options.linear_solvers);
  const auto of = names_given("formulation", options.formulations);
  require_positive("--bodies", options.most);
  require_positive("--repetitions", options.repetitions);
  make_folder(options.out);
  const std::vector<int> all_sizes = sizes(options.most);

  std::vector<Series> all;
  for (const SceneGenerator& structure : scene_generators()) {
    for (const std::string& formulation : of) {
      for (const std::string& solver : solvers) {
        Series series{&structure, {}, std::vector<std::vector<IsolatedRun>>(all_sizes.size())};
        series.settings.formulation = formulation;
        series.settings.linear_solver = solver;
        all.push_back(series);
      }
    }
  }
  const int core = pin_to_one_core();
  ProgressLine progress("runs", !options.quiet);
  const ProgressCallback told = progress.callback();
  RunCounter counter(all.size() * all_sizes.size() * static_cast<std::size_t>(options.repetitions), told);
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    for (std::size_t n = 0; n < all_sizes.size(); ++n) {
      for (Series& series : all) {
        counter.next();
        auto& runs = series.runs[n];
        if (repetition > 0 && !good(runs)) continue;
        if (n > 0 && too_long(series.runs[n - 1])) {
          runs.push_back({fmt::format("left out, {} bodies took {:.0f} s", series.runs[n - 1].front().bodies,
                                      series.runs[n - 1].front().seconds)});
          continue;
        }
        series.settings.end = series.settings.every = end_of(all_sizes[n], series.settings.step);
        runs.push_back(run_isolated(*series.structure, all_sizes[n], series.settings));
      }
    }
  }
  progress.clear();

  Report report{"Scaling",
                "Chains, trees, ladders of closed loops and the N-four-bar, each run in its own process.",
                {cost_table(all), growth_table(all)},
                origin_lines(core)};
  report.foot.push_back(
      fmt::format("settings: implicit_euler, h = {:g} s, tolerance {:g}, jacobian {}; {} interleaved "
                  "repetitions, median",
                  Settings{}.step, Settings{}.tolerance, Settings{}.jacobian, options.repetitions));
  if (const std::string why = write_plots({scaling_plot(all)}, options.out, report.foot); why.empty()) {
    report.text += "\n\n![Cost over the number of bodies](scaling_plot.svg)";
  } else {
    if (!options.quiet) print_notice(why);
    report.text += fmt::format("\n\n({})", why);
  }
  bool failed = false;
  for (const Series& series : all) {
    for (std::size_t n = 0; n < all_sizes.size(); ++n) {
      if (good(series.runs[n])) continue;
      failed = failed || series.runs[n].front().failure.rfind("left out,", 0) != 0;
      const std::string sentence =
          fmt::format("no figure for {} of {} bodies, {}, {}: {}", series.structure->name, all_sizes[n],
                      series.settings.formulation, series.settings.linear_solver, series.runs[n].front().failure);
      print_error(sentence);
      report.text += "\n\n" + sentence;
    }
  }
  const auto written = write_report(report, options.out, "scaling");
  if (!options.quiet) fmt::print("{}\n", written.front().string());
  return failed ? kNumericsFailed : kDone;
}

}  // namespace

void add_scale(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("scale", "measure how time and memory grow with the number of bodies");
  const auto options = std::make_shared<Options>();
  add_out_folder(*command, options->out, "the Markdown page, CSV files and plots");
  command->add_option("--bodies", options->most, fmt::format("largest scene (default {})", options->most))
      ->type_name("N");
  add_names(*command, "linear_solver", options->linear_solvers);
  add_names(*command, "formulation", options->formulations);
  add_repetitions(*command, options->repetitions, "each scene");
  add_quiet(*command, options->quiet);
  command->callback([options, &status] { status = scale(*options); });
}

}  // namespace poinsot::app
