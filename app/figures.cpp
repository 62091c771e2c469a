#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "app/commands.h"
#include "app/figure.h"
#include "app/models_directory.h"
#include "app/options.h"
#include "app/terminal.h"
#include "core/input_error.h"
#include "core/scene_reader.h"

namespace poinsot::app {
namespace {

constexpr FigureEntry kFigures[] = {
    {"order_paper", "the paper's order analysis: one coordinate at 3 s, implicit Euler, all formulations", order_paper},
    {"order_integrators",
     "orders of every integrator of fixed step in positions, velocities, accelerations, multipliers",
     order_integrators},
    {"order_controlled", "the same of the one-step methods with error control, driven with equal steps",
     order_controlled},
    {"solution_deltas", "the paper's double pendulum: Δz from the reference over 5 s", solution_deltas},
    {"iterations", "the paper's two figures of Newton iterations over the step size, exact and simplified", iterations},
    {"energy", "energy of the free double pendulum over 1000 s, every integrator of fixed step", energy},
};

struct Options {
  std::string out = "results", models;
  std::vector<std::string> names;
  bool quick = false, quiet = false;
};

std::vector<const FigureEntry*> chosen(const std::vector<std::string>& names) {
  std::vector<const FigureEntry*> entries;
  for (const FigureEntry& entry : kFigures)
    if (names.empty() || std::find(names.begin(), names.end(), entry.name) != names.end()) entries.push_back(&entry);
  for (const std::string& name : names) {
    if (std::any_of(std::begin(kFigures), std::end(kFigures), [&](const auto& entry) { return entry.name == name; }))
      continue;
    std::vector<std::string_view> known;
    for (const FigureEntry& entry : kFigures) known.push_back(entry.name);
    throw InputError(fmt::format("NAME: found \"{}\", expected one of {}", name, fmt::join(known, ", ")));
  }
  return entries;
}

int figures(const Options& options) {
  const std::vector<const FigureEntry*> entries = chosen(options.names);
  const FigureRequest request{models_directory(options.models), options.quick, !options.quiet};
  make_folder(options.out);

  Report report{"Figures", "What the pictures show stands as numbers in CSV files beside them.", {}, origin_lines(-1)};
  if (options.quick) report.foot.push_back("settings: --quick, fewer and longer steps and shorter motions");
  bool failed = false;
  for (const FigureEntry* entry : entries) {
    FigureResult result = entry->compute(request);
    std::string pictures;
    for (const PanelPlot& plot : result.plots) pictures += fmt::format("![{}]({}.svg)\n\n", plot.title, plot.file);
    if (const std::string why = write_plots(result.plots, options.out, report.foot); !why.empty()) {
      if (!options.quiet) print_notice(why);
      pictures = fmt::format("({})\n\n", why);
    }
    if (!result.tables.empty()) result.tables.front().text = pictures + result.tables.front().text;
    for (const std::string& failure : result.failures) {
      const std::string sentence = fmt::format("no figure for {}", failure);
      print_error(sentence);
      result.tables.front().text += "\n\n" + sentence;
      failed = true;
    }
    if (!options.quiet) fmt::print("{}\n", entry->name);
    for (const std::string& line : result.summary)
      if (!options.quiet) fmt::print("  {}\n", line);
    for (Table& table : result.tables) report.tables.push_back(std::move(table));
  }
  const auto written = write_report(report, options.out, "figures");
  if (!options.quiet) fmt::print("{}\n", written.front().string());
  return failed ? kNumericsFailed : kDone;
}

std::string footer() {
  std::string text = "Figures:\n";
  for (const FigureEntry& entry : kFigures) text += fmt::format("  {:<18} {}\n", entry.name, entry.about);
  return text;
}

}  // namespace

Scene FigureRequest::scene(std::string_view model) const {
  return read_scene(models / fmt::format("{}.json", model));
}

void add_figures(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("figures", "compute and draw the paper's figures, and more of their kind");
  const auto options = std::make_shared<Options>();
  command->add_option("NAME", options->names, "of a figure, see below (default: all)")->type_name("");
  add_out_folder(*command, options->out, "the Markdown page, CSV files and pictures");
  add_models(*command, options->models);
  command->add_flag("--quick", options->quick, "fewer and longer steps, shorter motions: to see that it works");
  add_quiet(*command, options->quiet);
  command->footer(footer());
  command->callback([options, &status] { status = figures(*options); });
}

}  // namespace poinsot::app
