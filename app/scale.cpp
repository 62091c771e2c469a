#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/isolated_run.h"
#include "app/measure.h"
#include "app/name_list.h"
#include "app/output_file.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/terminal.h"
#include "core/input_error.h"
#include "formulations/registry.h"
#include "linsolve/registry.h"

namespace poinsot::app {
namespace {

struct Options {
  std::string out = "results", linear_solvers = "block", formulations = "rA,rp,reps";
  int most = 100000, repetitions = 3;
  bool quiet = false;
};

struct Series {  // one structure, formulation and linear solver over growing sizes
  const SceneGenerator* structure;
  Settings settings;
  std::vector<std::vector<IsolatedRun>> runs;  // by size, by repetition
};

double median(const std::vector<IsolatedRun>& runs, double IsolatedRun::*figure) {
  std::vector<double> values;
  for (const IsolatedRun& run : runs) values.push_back(run.*figure);
  return timing(values).median;
}

bool good(const std::vector<IsolatedRun>& runs) {
  return !runs.empty() && runs.front().failure.empty();
}

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

// Few steps where a step is long: about as much work for every size, 5 to 200 steps.
double end_of(int bodies, double step) {
  return step * std::clamp(20000 / bodies, 5, 200);
}

// Exponent of the time of a step over the number of bodies, by least squares in logarithms, from 100 bodies on.
std::string exponent(const Series& series) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& runs : series.runs) {
    if (!good(runs) || runs.front().bodies < 100) continue;
    const double lx = std::log(runs.front().bodies);
    const double ly = lx + std::log(median(runs, &IsolatedRun::us_per_body));
    n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
  }
  return n < 2 ? "" : fmt::format("{:.3f}", (n * xy - x * y) / (n * xx - x * x));
}

Table cost_table(const std::vector<Series>& all) {
  Table table{"scaling",
              "Cost per body and Newton iteration",
              "Implicit Euler, exact Newton matrix; microseconds per body and iteration, the whole step and by phase; "
              "kilobytes resident per body; seconds from the scene to the first step.",
              {"structure", "formulation", "linear solver", "bodies", "us/body", "assembly", "factor", "solve", "rest",
               "kB/body", "start s"},
              {}};
  for (const Series& series : all) {
    for (const auto& runs : series.runs) {
      if (!good(runs)) continue;
      std::vector<std::string> row{std::string(series.structure->name), series.settings.formulation,
                                   series.settings.linear_solver, std::to_string(runs.front().bodies)};
      for (const auto figure :
           {&IsolatedRun::us_per_body, &IsolatedRun::assembly, &IsolatedRun::factor, &IsolatedRun::solve,
            &IsolatedRun::rest, &IsolatedRun::kilobytes_per_body, &IsolatedRun::start}) {
        row.push_back(fmt::format("{:.3f}", median(runs, figure)));
      }
      table.rows.push_back(row);
    }
  }
  return table;
}

Table growth_table(const std::vector<Series>& all) {
  Table table{"growth",
              "Growth",
              "Time of a step over the number of bodies N is a power of N: the fitted exponent from 100 bodies on, and "
              "the cost per body of the largest scene relative to that of 100 bodies.",
              {"structure", "formulation", "linear solver", "exponent", "largest / 100 bodies"},
              {}};
  for (const Series& series : all) {
    const std::string fitted = exponent(series);
    if (fitted.empty()) continue;
    const auto& at_100 = series.runs[2];
    const auto& largest = series.runs.back();
    const std::string ratio = good(at_100) && good(largest)
                                  ? fmt::format("{:.2f}", median(largest, &IsolatedRun::us_per_body) /
                                                              median(at_100, &IsolatedRun::us_per_body))
                                  : "";
    table.rows.push_back({std::string(series.structure->name), series.settings.formulation,
                          series.settings.linear_solver, fitted, ratio});
  }
  return table;
}

int scale(const Options& options) {
  const auto solvers = names_in("--linear-solvers", options.linear_solvers,
                                [](std::string_view name) { return find_linear_solver(name) != nullptr; });
  const auto of = names_in("--formulations", options.formulations,
                           [](std::string_view name) { return find_formulation(name) != nullptr; });
  if (options.most < 1) throw InputError(fmt::format("--bodies: found {}, expected at least 1", options.most));
  if (options.repetitions < 1) {
    throw InputError(fmt::format("--repetitions: found {}, expected at least 1", options.repetitions));
  }
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
  Progress progress(static_cast<double>(all.size() * all_sizes.size()) * options.repetitions, "runs", !options.quiet);
  double done = 0;
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    for (std::size_t n = 0; n < all_sizes.size(); ++n) {
      for (Series& series : all) {
        progress.at(done++);
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
  command->add_option("--out", options->out, "folder for the Markdown page and the CSV files (default results)")
      ->type_name("DIR");
  command->add_option("--bodies", options->most, fmt::format("largest scene (default {})", options->most))
      ->type_name("N");
  command
      ->add_option("--linear-solvers", options->linear_solvers,
                   fmt::format("with commas between (default {})", options->linear_solvers))
      ->type_name("NAMES");
  command
      ->add_option("--formulations", options->formulations,
                   fmt::format("with commas between (default {})", options->formulations))
      ->type_name("NAMES");
  command
      ->add_option("--repetitions", options->repetitions,
                   fmt::format("timed runs of each scene (default {})", options->repetitions))
      ->type_name("N");
  command->add_flag("--quiet", options->quiet, "nothing but errors");
  command->callback([options, &status] { status = scale(*options); });
}

}  // namespace poinsot::app
