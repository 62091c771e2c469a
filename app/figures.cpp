#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/paper/figure.h"
#include "core/input_error.h"
#include "core/projected.h"

namespace poinsot::app {
using namespace study;
using namespace paper;
namespace {

constexpr const char* kText = "What the pictures show stands as numbers in CSV files beside them.";

struct FiguresOptions {
  std::string out = "results", models;
  std::vector<std::string> names;
  bool quick = false, quiet = false;
};

std::vector<const FigureEntry*> chosen(const std::vector<std::string>& names) {
  const auto known = projected(paper::figures(), &FigureEntry::name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw InputError(fmt::format("NAME: found \"{}\", expected one of {}", name, fmt::join(known, ", ")));
  std::vector<const FigureEntry*> entries;
  for (const FigureEntry& entry : paper::figures())
    if (names.empty() || std::ranges::find(names, entry.name) != names.end()) entries.push_back(&entry);
  return entries;
}

// Whether all of it is there.
bool add_figure(const FigureEntry& entry, FigureResult result, const FiguresOptions& options, Report& report) {
  std::string pictures;
  for (const PanelPlot& plot : result.plots) pictures += fmt::format("![{}]({}.svg)\n\n", plot.title, plot.file);
  std::vector<std::string> failures;
  if (const std::string why = write_plots(result.plots, options.out, report.foot); !why.empty()) {
    failures.push_back(why);
    pictures = fmt::format("({})\n\n", why);
  }
  if (!result.tables.empty()) result.tables.front().text = pictures + result.tables.front().text;
  for (const std::string& failure : result.failures) {
    failures.push_back(fmt::format("no figure for {}", failure));
    result.tables.front().text += "\n\n" + failures.back();
  }
  for (const std::string& failure : failures) print_error(failure);
  if (!options.quiet) fmt::print("{}\n", entry.name);
  for (const std::string& line : result.summary)
    if (!options.quiet) fmt::print("  {}\n", line);
  for (Table& table : result.tables) report.tables.push_back(std::move(table));
  return failures.empty();
}

int compute_figures(const FiguresOptions& options) {
  const std::vector<const FigureEntry*> entries = chosen(options.names);
  ProgressLine progress("runs", !options.quiet);
  const FigureRequest request{models_directory(options.models), options.quick, progress.callback()};
  make_folder(options.out);

  Report report{"Figures", "", {}, origin_lines(-1)};
  if (options.quick) report.foot.push_back("settings: --quick, fewer and longer steps and shorter motions");
  bool failed = false;
  std::vector<std::filesystem::path> written;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    FigureResult result = entries[k]->compute(request);
    progress.clear();
    failed = !add_figure(*entries[k], std::move(result), options, report) || failed;
    // After each, so that those of a run that is interrupted stand there.
    report.text = kText;
    if (k + 1 < entries.size())
      report.text += fmt::format("\n\nIncomplete: {} of {} figures so far.", k + 1, entries.size());
    written = write_report(report, options.out, "figures");
  }
  if (!options.quiet) fmt::print("{}\n", written.front().string());
  return failed ? kNumericsFailed : kDone;
}

std::string footer() {
  std::string text = "Figures:\n";
  for (const FigureEntry& entry : paper::figures()) text += fmt::format("  {:<18} {}\n", entry.name, entry.about);
  return text;
}

}  // namespace

void add_figures(CLI::App& app, int& status) {
  const auto [command, options] = add_command(
      app, status, "figures", "compute and draw the paper's figures, and more of their kind", compute_figures);
  command.add_option("NAME", options.names, "of a figure, see below (default: all)")->type_name("");
  add_out_folder(command, options.out, "the Markdown page, CSV files and pictures");
  add_models(command, options.models);
  command.add_flag("--quick", options.quick, "fewer and longer steps, shorter motions: to see that it works");
  add_quiet(command, options.quiet);
  command.footer(footer());
}

}  // namespace poinsot::app
