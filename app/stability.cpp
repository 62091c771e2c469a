#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/stability/amplification.h"
#include "bench/stability/maps.h"
#include "bench/study/report.h"
#include "core/input_error.h"
#include "core/interruption.h"

namespace poinsot::app {
using namespace study;
using namespace stability;
namespace {
namespace fs = std::filesystem;

struct StabilityOptions {
  std::string out = "results", formulations = all_names("formulation"), integrators = all_names("integrator");
  std::vector<std::string> families;
  std::optional<int> threads;
  bool quick = false, full = false, fresh = false, quiet = false;
};

int map(const StabilityOptions& options) {
  if (options.threads) require_positive("--threads", *options.threads);
  if (options.quick && options.full) throw InputError("--quick, --full: expected one of the two");
  const std::vector<const Family*> all = require_families(options.families);
  const Extent extent{options.quick, names_given("formulation", options.formulations),
                      names_given("integrator", options.integrators)};
  make_folder(options.out);
  std::vector<std::string> notices;
  const std::vector<Mapped> before = maps_before(options.out, all, notices);
  if (!options.quiet) std::ranges::for_each(notices, print_notice);
  std::vector<Mapped> maps;
  {
    const Deferred deferred;
    ProgressLine progress("cells", !options.quiet);
    maps = map_families(all, extent, {options.out, options.fresh, options.threads.value_or(0)},
                        [&](double there, double cells, const Family& family) {
                          progress.at({there, cells, 0}, fmt::format(", {}", family.name));
                        });
    if (interruption_requested) {
      progress.clear();
      print_error(fmt::format("{}; the same command goes on with what is there", signal_text()));
      return signal_status();
    }
  }
  std::vector<std::string> foot = origin_lines(-1);
  foot.push_back(options.quick ? "settings: --quick, fewer places along each axis" : "settings: full");
  std::string why = write_maps(maps, options.out, foot);
  if (options.families.empty())
    if (const std::string none = write_plots({amplification_plot(options.quick)}, options.out, foot); why.empty())
      why = none;
  if (!why.empty()) print_error(why);
  const bool amplification =
      options.families.empty() ? why.empty() : fs::exists(fs::path(options.out) / "amplification.svg");
  std::vector<Mapped> listed = before;
  listed.insert(listed.end(), maps.begin(), maps.end());
  std::ranges::sort(listed, {}, &Mapped::family);  // as in the list of families
  for (const Mapped& one : before)
    foot.push_back(fmt::format("{0}: computed before, as {0}.csv says", one.family->name));
  const std::vector<fs::path> written =
      write_report(stability_report(listed, amplification, foot), options.out, "stability");
  const int status = why.empty() ? kDone : kNumericsFailed;
  if (options.quiet) return status;
  for (const Mapped& one : maps)
    fmt::print("{:<24} {:>5} cells: {} accurate, {} coarse, {} told, {} stopped, {} wrong\n", one.family->name,
               one.cells.size(), count(one.cells, Verdict::accurate), count(one.cells, Verdict::coarse),
               count(one.cells, Verdict::told), count(one.cells, Verdict::stop), count(one.cells, Verdict::wrong));
  fmt::print("{}\n", written.front().string());
  return status;
}

std::string families_text() {
  std::string text = "Families:\n";
  for (const Family& family : families()) text += fmt::format("  {:<24} {}\n", family.name, family.title);
  return text + "A suite that was interrupted goes on where it stopped.";
}

}  // namespace

void add_stability(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "stability", "map where each method fails: verdicts over families of scenes", map);
  command.add_option("--family", options.families, "one of those below; may come several times (default: all)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_flag("--quick", options.quick, "fewer places along each axis");
  command.add_flag("--full", options.full, "all places (default)");
  add_names(command, "formulation", options.formulations);
  add_names(command, "integrator", options.integrators);
  command.add_option("--threads", options.threads, "that compute (default: one for each processor)")->type_name("N");
  add_out_folder(command, options.out, "cells, maps and stability.md");
  command.add_flag("--fresh", options.fresh, "compute everything, also what the folder holds already");
  add_quiet(command, options.quiet);
  command.footer(families_text());
}

}  // namespace poinsot::app
