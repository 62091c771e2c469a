#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/paper/measured_tables.h"
#include "bench/study/measure.h"
#include "bench/study/output_file.h"
#include "core/interruption.h"
#include "integrators/settings_reader.h"

namespace poinsot::app {
namespace {
namespace fs = std::filesystem;

struct TablesOptions {
  std::string out = "results", models;
  paper::TablesRequest request;
  bool quiet = false;
};

std::vector<fs::path> write_tables(const paper::MeasuredTables& measured, const fs::path& folder) {
  std::vector<fs::path> written = study::write_report(measured.report, folder, "tables");
  study::OutputFile raw(folder / "raw.csv");
  raw.write(study::csv(measured.raw, measured.report.foot));
  raw.commit();
  written.push_back(raw.target());
  return written;
}

// Of tables that were interrupted; what was written whole before stays.
int keep(paper::MeasuredTables measured, const fs::path& folder) {
  const bool any = !measured.raw.rows.empty();
  if (any) {
    study::mark_incomplete(measured.report, signal_text());
    write_tables(measured, folder);
  }
  print_error(signal_text() + (any ? study::kept_in(folder) : ""));
  return signal_status();
}

int tables(const TablesOptions& options) {
  paper::TablesRequest request = options.request;
  Settings checked;
  set_setting(*find_setting("linear_solver"), request.linear_solver, checked);
  require_positive("--repetitions", request.repetitions);
  request.models = models_directory(options.models);
  study::make_folder(options.out);

  const int core = study::pin_to_one_core();
  ProgressLine progress("runs", !options.quiet);
  std::optional<Deferred> deferred(std::in_place);
  paper::MeasuredTables measured = paper::measure_tables(request, core, progress.callback());
  progress.clear();
  if (interruption_requested) return keep(std::move(measured), study::interrupted_folder(options.out));
  deferred.reset();

  for (const std::string& failure : measured.failures) print_error(failure);
  const std::vector<fs::path> written = write_tables(measured, options.out);
  study::remove_interrupted(options.out, written);
  if (!options.quiet) fmt::print("{} and {} CSV files beside it\n", written.front().string(), written.size() - 1);
  return measured.failures.empty() ? kDone : kNumericsFailed;
}

}  // namespace

void add_tables(CLI::App& app, int& status) {
  const auto [command, options] = add_command(
      app, status, "tables", "measure and write the paper's tables, ours beside the paper's figures", tables);
  add_out_folder(command, options.out, "the Markdown page and the CSV files");
  add_models(command, options.models);
  command
      .add_option(
          "--linear-solver", options.request.linear_solver,
          fmt::format("of the paper's tables (default {}); one more table compares all", options.request.linear_solver))
      ->type_name("NAME");
  add_repetitions(command, options.request.repetitions, "each cell");
  command.add_flag("--quick", options.request.quick,
                   "a tenth of the simulated time and at most 5 repetitions: to see that it works");
  add_quiet(command, options.quiet);
}

}  // namespace poinsot::app
