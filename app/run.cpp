#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/run_files.h"
#include "app/run_record.h"
#include "app/settings_options.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "app/verification_text.h"
#include "bench/study/startable_scene.h"
#include "bench/study/verification.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/printable.h"
#include "core/scene_reader.h"
#include "integrators/settings_reader.h"
#include "integrators/simulate.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

struct Options {
  std::string scene, out, reactions, signals, save_state;
  std::vector<std::string> set;
  std::string columns, bodies;  // of the trajectory
  SettingsOptions settings;
  bool verify = false, quiet = false;
};

// The motion at the last output time, for the summary: of the first bodies.
constexpr std::size_t kShown = 20;
struct LastState {
  double t = 0;
  std::vector<BodyState> bodies;
};

// "klu on G: 3 factorizations with fresh pivots, 998 with kept ones, condition 17"
std::string description(const LinearWork& w) {
  std::string text = fmt::format("{} on {}", w.solver, w.system == "whole" ? "the whole matrix" : w.system);
  if (!w.handed_over_by.empty()) text += fmt::format(", handed over by {}", w.handed_over_by);
  text += fmt::format(": {} factorizations with fresh pivots, {} with kept ones", w.factorizations, w.refactorizations);
  if (w.refinements > 0) text += fmt::format(", {} refinements", w.refinements);
  if (w.reciprocal_condition > 0) text += fmt::format(", condition {:.2g}", 1 / w.reciprocal_condition);
  return text;
}

void print_summary(const Scene& scene, const Settings& settings, const Outcome& outcome, const LastState& last) {
  const Statistics& s = outcome.statistics;
  const bool kinematics = settings.analysis == Analysis::kinematics;
  fmt::print(
      "{}: {}, {}{}, {}, {}\n", printable(scene.name), kinematics ? "kinematics" : "dynamics", settings.formulation,
      kinematics ? "" : ", " + settings.integrator, settings.linear_solver,
      chooses_steps(settings) ? fmt::format("rtol = {:g}", settings.rtol) : fmt::format("h = {:g} s", settings.step));
  fmt::print("t = {:g} s\n", last.t);
  std::size_t width = 4;
  for (const Body& body : scene.bodies) width = std::max(width, printable(body.name).size());
  const auto row = [](const Vector3& x) { return fmt::format("{:12.6g} {:12.6g} {:12.6g}", x.x(), x.y(), x.z()); };
  fmt::print("  {:<{}}  {:>38}  {:>38}  {:>38}\n", "body", width, "position, m", "velocity, m/s",
             "angular velocity (body), rad/s");
  for (std::size_t b = 0; b < last.bodies.size(); ++b)
    fmt::print("  {:<{}}  {}  {}  {}\n", printable(scene.bodies[b].name), width, row(last.bodies[b].r),
               row(last.bodies[b].rd), row(last.bodies[b].w));
  if (const std::size_t more = scene.bodies.size() - last.bodies.size(); more > 0 && !last.bodies.empty())
    fmt::print("  ... and {} more; --out FILE.csv writes all\n", more);
  const double steps = static_cast<double>(std::max<std::int64_t>(s.steps, 1));
  fmt::print("{} steps, {:.2f} Newton iterations, {:.2f} factorizations and {:.2f} solves a step\n", s.steps,
             static_cast<double>(s.newton_iterations) / steps, static_cast<double>(s.factorizations) / steps,
             static_cast<double>(s.solves) / steps);
  const auto share = [&](double seconds) { return s.seconds.total > 0 ? 100 * seconds / s.seconds.total : 0.0; };
  fmt::print(
      "{:.3g} s, {:.3g} us a step: assembly {:.0f} %, factorization {:.0f} %, solve {:.0f} %, the rest {:.0f} %\n",
      s.seconds.total, 1e6 * s.seconds.total / steps, share(s.seconds.assembly), share(s.seconds.factor),
      share(s.seconds.solve), share(s.seconds.other));
  for (const MethodWork& w : s.methods)
    fmt::print("{}: t = {:.6g} to {:.6g} s in {} steps\n", w.integrator, w.from, w.to, w.steps);
  for (const LinearWork& w : s.linear) fmt::print("{}\n", description(w));
  fmt::print("largest violation of the constraints: position {:.2g}, velocity {:.2g}\n", s.violation.position,
             s.violation.velocity);
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

int run(const Options& options) {
  std::vector<std::string> notices;
  Settings settings = options.settings.resolve(notices);
  settings.reactions = !options.reactions.empty();
  settings.signals = !options.signals.empty();
  check_numbers(settings);
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

  Outcome outcome;
  std::optional<Verification> verification;
  const std::string how_accurate = accuracy(settings);
  ColumnsByOption columns;
  const auto record = [&](bool running) {
    return to_json(RunRecord{options.scene, scene, to_json(settings), outcome, how_accurate,
                             verification ? &*verification : nullptr, running, columns});
  };
  RunFiles files({options.out, options.reactions, options.signals, options.save_state, record_file}, scene, content,
                 [&] { return record(true); });
  columns = files.unnamed_columns();
  const bool summary = !files.any() && !options.quiet;
  if (record_file.empty()) std::string().swap(scene.source);  // memory of large scenes
  LastState last;
  std::optional<Deferred> deferred;  // from the first sample on there is something to keep
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
      if (summary) {
        last.t = sample.t;
        last.bodies.resize(std::min(kShown, scene.bodies.size()));
        sample.problem.to_bodies(sample.a, last.bodies);
      }
      progress.at({sample.t, settings.end});
    };
    outcome = naming(options.scene, [&] { return simulate(scene, settings, observe, tell); });
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
  files.commit(record_file.empty() ? "" : record(false));

  if (summary) {
    print_summary(scene, settings, outcome, last);
    fmt::print("accuracy: {}{}\n", how_accurate, options.verify ? "" : "; --verify");
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
  CLI::App* command = app.add_subcommand("run", "compute the motion of a scene");
  const auto options = std::make_shared<Options>();
  add_scene(*command, options->scene);
  add_set(*command, options->set);
  options->settings.add_to(*command);
  command
      ->add_option(
          "--out", options->out,
          "trajectory, CSV (NumPy's array where it ends in .npy); the run record is written beside it as .run.json")
      ->type_name("FILE.csv");
  command
      ->add_option("--columns", options->columns,
                   "what the trajectory holds of a body, with commas between: " + TrajectoryContent::column_names() +
                       " (default all)")
      ->type_name("NAMES");
  command->add_option("--bodies", options->bodies, "whom the trajectory holds, with commas between (default all)")
      ->type_name("NAMES");
  command->add_option("--reactions", options->reactions, "multipliers and reaction forces, CSV")->type_name("FILE.csv");
  command
      ->add_option("--signals", options->signals,
                   "energies, momenta, joint coordinates, drivers' efforts, forces of springs, CSV or .npy")
      ->type_name("FILE.csv");
  command->add_option("--save-state", options->save_state, "the scene as it stands at the end, to run on from")
      ->type_name("FILE.json");
  command->add_flag(
      "--verify", options->verify,
      "compute it again with half the step, or a tenth of the tolerances, and tell how far apart they are");
  add_quiet(*command, options->quiet);
  command->footer(
      "Without --out, --reactions and --signals a short summary is printed. Numbers may be constant expressions, as\n"
      "in scenes: --step 1/1000 --end 2*pi. - is the standard input as SCENE and the standard output as FILE.csv.\n"
      "`tail -f FILE.csv` follows a run. Ctrl-C ends it and keeps what was computed.");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace poinsot::app
