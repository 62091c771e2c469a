#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/terminal.h"
#include "bench/paper/figure.h"
#include "bench/study/output_file.h"
#include "core/input_error.h"
#include "core/projected.h"

namespace poinsot::app {
using namespace study;
using namespace paper;
namespace {
namespace fs = std::filesystem;

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

// Of what lies in the folder: of this run and of those before.
fs::path write_index(const fs::path& folder) {
  std::string text =
      "# Figures\n\nEach with a page of its own: its pictures, its numbers and where they come from.\n\n";
  for (const FigureEntry& entry : paper::figures())
    if (fs::exists(folder / fmt::format("{}.md", entry.name)))
      text += fmt::format("- [{0}]({0}.md): {1}\n", entry.name, entry.about);
  OutputFile file(folder / "figures.md");
  file.write(text);
  file.commit();
  return file.target();
}

int compute_figures(const FiguresOptions& options) {
  const std::vector<const FigureEntry*> entries = chosen(options.names);
  ProgressLine progress("runs", !options.quiet);
  const FigureRequest request{models_directory(options.models), options.quick, progress.callback()};
  make_folder(options.out);

  std::vector<std::string> foot = origin_lines(-1);
  if (options.quick) foot.push_back("settings: --quick, fewer and longer steps and shorter motions");
  bool failed = false;
  fs::path index;
  for (const FigureEntry* entry : entries) {
    FigureResult result = entry->compute(request);
    progress.clear();
    Report page{fmt::format("{}: {}", entry->name, entry->about), kText, {}, foot};
    failed = !add_figure(*entry, std::move(result), options, page) || failed;
    write_report(page, options.out, entry->name);
    index = write_index(options.out);  // after each, so that those of a run that is interrupted stand there
  }
  if (!options.quiet) fmt::print("{}\n", index.string());
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
  add_out_folder(command, options.out, "Markdown pages, CSV files and pictures");
  add_models(command, options.models);
  command.add_flag("--quick", options.quick, "fewer and longer steps, shorter motions: to see that it works");
  add_quiet(command, options.quiet);
  command.footer(footer());
}

}  // namespace poinsot::app
