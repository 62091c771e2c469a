#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/study/measure.h"
#include "bench/study/scale_series.h"
#include "core/interruption.h"

namespace poinsot::app {
using namespace study;
namespace {

struct ScaleOptions {
  std::string out = "results", linear_solvers = "block", formulations = all_names("formulation");
  int most = 100000, repetitions = 3;
  bool quiet = false;
};

// Of an interrupted series; what was drawn and written whole before stays.
int keep(const std::vector<Series>& all, Report report, const std::string& out) {
  const bool any = !cost_table(all).rows.empty();
  if (any) {
    mark_incomplete(report, signal_text());
    write_report(report, interrupted_folder(out), "scaling");
  }
  print_error(signal_text() + (any ? kept_in(interrupted_folder(out)) : ""));
  return signal_status();
}

int scale(const ScaleOptions& options) {
  const ScaleRequest request{names_given("formulation", options.formulations),
                             names_given("linear_solver", options.linear_solvers), options.most, options.repetitions};
  require_positive("--bodies", options.most);
  require_positive("--repetitions", options.repetitions);
  make_folder(options.out);
  const int core = pin_to_one_core();
  ProgressLine progress("runs", !options.quiet);
  std::optional<Deferred> deferred(std::in_place);
  const std::vector<Series> all = measure_scale(request, progress.callback());
  progress.clear();

  Report report = scale_report(all, options.repetitions, core);
  if (interruption_requested) return keep(all, std::move(report), options.out);
  deferred.reset();
  bool failed = false;
  if (const std::string why = write_plots({scaling_plot(all)}, options.out, report.foot); why.empty()) {
    report.text += "\n\n![Cost over the number of bodies](scaling_plot.svg)";
  } else {
    print_error(why);
    failed = true;
    report.text += fmt::format("\n\n({})", why);
  }
  for (const Missing& one : missing(all)) {
    print_error(one.why);
    report.text += "\n\n" + one.why;
    failed = failed || one.failed;
  }
  const auto written = write_report(report, options.out, "scaling");
  remove_interrupted(options.out, written);
  if (!options.quiet) fmt::print("{}\n", written.front().string());
  return failed ? kNumericsFailed : kDone;
}

}  // namespace

void add_scale(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "scale", "measure how time and memory grow with the number of bodies", scale);
  add_out_folder(command, options.out, "the Markdown page, CSV files and plots");
  command.add_option("--bodies", options.most, fmt::format("largest scene (default {})", options.most))->type_name("N");
  add_names(command, "linear_solver", options.linear_solvers);
  add_names(command, "formulation", options.formulations);
  add_repetitions(command, options.repetitions, "each scene");
  add_quiet(command, options.quiet);
}

}  // namespace poinsot::app
