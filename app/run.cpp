#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/settings_options.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/records/run_files.h"
#include "bench/records/run_record.h"
#include "bench/records/run_summary.h"
#include "bench/study/tried_settings.h"
#include "bench/study/verification.h"
#include "bench/study/verification_text.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/scene_reader.h"
#include "integrators/settings_reader.h"
#include "integrators/simulate.h"

namespace poinsot::app {
using namespace study;
using namespace records;
namespace {
namespace fs = std::filesystem;

struct RunOptions {
  std::string scene, out, reactions, signals, save_state;
  std::vector<std::string> set;
  std::string columns, bodies;  // of the trajectory
  SettingsOptions settings;
  bool verify = false, quiet = false;
};

// What nobody may have meant to write; empty where it is little, or where the integrator chooses how many rows there
// are.
std::string much_to_write(RunFiles& files, const Settings& settings) {
  constexpr double kMuch = 1e9;  // bytes
  const double between = settings.every > 0 ? settings.every : chooses_steps(settings) ? settings.end : settings.step;
  const double rows = settings.end / between, row = files.longest_row();
  if (!(rows * row > kMuch)) return "";
  return fmt::format(
      "{:.3g} rows are to be written, of up to {:g} bytes each: {:.3g} GB; a larger --every writes fewer", rows, row,
      1e-9 * rows * row);
}

// What the status says where the run was interrupted, or a file did not take everything.
void tell_interruption(const RunFiles& files, double end, Status& status) {
  if (status.failure == Failure::interrupted)
    status.message = fmt::format("{} at t = {:.9g} s{}", files.lost().empty() ? signal_text() : "stopped", status.time,
                                 files.any() && files.lost().empty() ? "; what was computed up to there is kept" : "");
  if (files.lost().empty()) return;
  if (status.ok()) status = {Failure::interrupted, end, ""};
  status.message += (status.message.empty() ? "" : ": ") + files.lost();
}

// Messages of what comes after reading name the scene and its lines, too.
Outcome simulate_file(const RunOptions& options, const Scene& scene, const Settings& settings, const Observer& observe,
                      const Tell& tell) {
  const auto placed = [&](std::string_view sentence) { return with_lines_of(options.scene, sentence); };
  std::vector<std::string> notices;
  try {
    Outcome outcome = simulate(scene, settings, observe, [&](const std::string& notice) {
      notices.push_back(placed(notice));
      tell(notices.back());
    });
    outcome.notices = std::move(notices);
    try_settings(scene, settings, outcome);
    outcome.status.message = placed(outcome.status.message);
    return outcome;
  } catch (const InputError& refused) {
    throw InputError(fmt::format("{}: {}", shown_input(options.scene), placed(refused.what())));
  }
}

int run(const RunOptions& options) {
  std::vector<std::string> notices;
  Settings settings = options.settings.resolve(notices);
  settings.reactions = !options.reactions.empty();
  settings.signals = !options.signals.empty();
  Scene scene = read_scene(options.scene, values_set(options.set));
  // Beside the trajectory, or beside the first of the others that is asked for.
  fs::path named = options.out;
  for (const std::string& other : {options.reactions, options.signals})
    if (named.empty()) named = other;
  const fs::path record_file = record_beside(named);
  refuse_overwriting({{"the scene", options.scene}, {"the configuration", options.settings.config_file()}},
                     {{"--out", options.out},
                      {"--reactions", options.reactions},
                      {"--signals", options.signals},
                      {"--save-state", options.save_state},
                      {"the run record", record_file}});
  const TrajectoryContent content(scene, options.columns, options.bodies);
  for (const auto& [option, given] : {std::pair{"--columns", &options.columns}, {"--bodies", &options.bodies}})
    if (!given->empty() && options.out.empty())
      notices.push_back(fmt::format("{} means nothing without --out", option));

  Outcome outcome;
  std::optional<Verification> verification;
  const std::string how_accurate = accuracy(settings);
  const auto record = [&](const ColumnsByOption& columns, bool running) {
    return to_json(RunRecord{options.scene, scene, to_json(settings), outcome, how_accurate,
                             verification ? &*verification : nullptr, running, columns});
  };
  RunFiles files({options.out, options.reactions, options.signals, options.save_state, record_file}, scene, content,
                 [&](const ColumnsByOption& columns) { return record(columns, true); });
  const bool summary = !files.any() && !options.quiet;
  if (record_file.empty()) std::string().swap(scene.source);  // memory of large scenes
  LastState last;
  std::optional<Deferred> deferred;  // from the first sample on there is something to keep
  if (const std::string much = much_to_write(files, settings); !much.empty()) notices.push_back(much);
  if (!options.quiet) std::ranges::for_each(notices, print_notice);
  {
    ProgressLine progress("s", !options.quiet);
    const auto tell = [&](const std::string& notice) {
      if (options.quiet) return;
      progress.clear();
      print_notice(notice);
    };
    const auto observe = [&](const Sample& sample) {
      if (!deferred) deferred.emplace();
      files.write(sample);
      if (summary) last.keep(sample);
      progress.at({sample.t, settings.end});
    };
    outcome = simulate_file(options, scene, settings, observe, tell);
  }
  outcome.notices.insert(outcome.notices.begin(), notices.begin(), notices.end());
  if (!options.save_state.empty() && !outcome.status.ok()) {
    outcome.notices.push_back(options.save_state + " is not written: the run did not come to its end");
    if (!options.quiet) print_notice(outcome.notices.back());
  }
  files.complete(outcome.status.ok());
  tell_interruption(files, settings.end, outcome.status);
  if (options.verify && outcome.status.ok())
    verification = verify(scene, settings);
  else if (options.verify)
    verification.emplace().failure = "the run did not come to its end";
  files.commit(record_file.empty() ? "" : record(files.unnamed_columns(), false));

  if (summary) {
    fmt::print("{}", run_summary(scene, settings, outcome, last));
    if (last.t) fmt::print("accuracy: {}{}\n", how_accurate, options.verify ? "" : "; --verify");
  }
  if (verification && !options.quiet)
    print(text_stream({options.out, options.reactions, options.signals, options.save_state}), *verification);
  if (!outcome.status.ok()) print_error(outcome.status.message);
  if (caught_signal() != 0 && (!outcome.status.ok() || verification)) return signal_status();
  if (outcome.status.ok() && !files.lost().empty()) print_error(files.lost());  // the record
  return outcome.status.ok() && files.lost().empty() ? kDone : kNumericsFailed;
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  const auto [command, options] = add_command(app, status, "run", "compute the motion of a scene", run);
  add_scene(command, options.scene, options.set);
  options.settings.add_to(command);
  command
      .add_option(
          "--out", options.out,
          "trajectory, CSV (NumPy's array where it ends in .npy); the run record is written beside it as .run.json")
      ->type_name("FILE.csv");
  command
      .add_option("--columns", options.columns,
                  "what the trajectory holds of a body, with commas between: " + TrajectoryContent::column_names() +
                      " (default all)")
      ->type_name("NAMES");
  command.add_option("--bodies", options.bodies, "whom the trajectory holds, with commas between (default all)")
      ->type_name("NAMES");
  command.add_option("--reactions", options.reactions, "multipliers and reaction forces, CSV or .npy")
      ->type_name("FILE.csv");
  command
      .add_option("--signals", options.signals,
                  "energies, momenta, joint coordinates, drivers' efforts, forces of springs, CSV or .npy")
      ->type_name("FILE.csv");
  command.add_option("--save-state", options.save_state, "the scene as it stands at the end, to run on from")
      ->type_name("FILE.json");
  command.add_flag(
      "--verify", options.verify,
      "compute it again with half the step, or a tenth of the tolerances, and tell how far apart they are");
  add_quiet(command, options.quiet);
  command.footer(
      "Without --out, --reactions and --signals a short summary is printed. Numbers may be constant expressions, as\n"
      "in scenes: --step 1/1000 --end 2*pi. - is the standard input as SCENE and the standard output as FILE.csv.\n"
      "`tail -f FILE.csv` follows a run. Ctrl-C ends it and keeps what was computed.");
}

}  // namespace poinsot::app
