#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/reactions_writer.h"
#include "app/run_record.h"
#include "app/settings_options.h"
#include "app/terminal.h"
#include "app/trajectory_writer.h"
#include "bench/study/output_file.h"
#include "core/scene_reader.h"
#include "integrators/settings_reader.h"
#include "integrators/simulate.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

struct Options {
  std::string scene, out, reactions;
  SettingsOptions settings;
  bool quiet = false;
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
      "{}: {}, {}{}, {}, {}\n", scene.name, kinematics ? "kinematics" : "dynamics", settings.formulation,
      kinematics ? "" : ", " + settings.integrator, settings.linear_solver,
      chooses_steps(settings) ? fmt::format("rtol = {:g}", settings.rtol) : fmt::format("h = {:g} s", settings.step));
  fmt::print("t = {:g} s\n", last.t);
  std::size_t width = 4;
  for (const Body& body : scene.bodies) width = std::max(width, body.name.size());
  const auto row = [](const Vector3& x) { return fmt::format("{:12.6g} {:12.6g} {:12.6g}", x.x(), x.y(), x.z()); };
  fmt::print("  {:<{}}  {:>38}  {:>38}  {:>38}\n", "body", width, "position, m", "velocity, m/s",
             "angular velocity (body), rad/s");
  for (std::size_t b = 0; b < last.bodies.size(); ++b)
    fmt::print("  {:<{}}  {}  {}  {}\n", scene.bodies[b].name, width, row(last.bodies[b].r), row(last.bodies[b].rd),
               row(last.bodies[b].w));
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

int run(const Options& options) {
  std::vector<std::string> notices;
  Settings settings = options.settings.resolve(notices);
  settings.reactions = !options.reactions.empty();
  Scene scene = read_scene(options.scene);
  // Beside the trajectory, or beside the reactions where only they are asked for.
  const fs::path record_file = record_beside(options.out.empty() ? options.reactions : options.out);
  refuse_overwriting({{"the scene", options.scene}, {"the configuration", options.settings.config_file()}},
                     {{"--out", options.out}, {"--reactions", options.reactions}, {"the run record", record_file}});

  std::optional<TrajectoryWriter> trajectory;
  std::optional<ReactionsWriter> reactions;
  std::optional<OutputFile> record;
  if (!options.out.empty()) trajectory.emplace(options.out, scene);
  if (!options.reactions.empty()) reactions.emplace(options.reactions, compile(scene));
  if (!record_file.empty())
    record.emplace(record_file);
  else
    std::string().swap(scene.source);  // memory of large scenes

  const bool summary = !trajectory && !reactions && !options.quiet;
  LastState last;
  Outcome outcome;
  if (!options.quiet) std::ranges::for_each(notices, print_notice);
  {
    ProgressLine progress("s", !options.quiet);
    const auto tell = [&](const std::string& notice) {
      if (options.quiet) return;
      progress.clear();
      print_notice(notice);
    };
    const auto observe = [&](const Sample& sample) {
      if (trajectory) trajectory->write(sample);
      if (reactions) reactions->write(sample);
      if (summary) {
        last.t = sample.t;
        last.bodies.resize(std::min(kShown, scene.bodies.size()));
        sample.problem.to_bodies(sample.a, last.bodies);
      }
      progress.at({sample.t, settings.end});
    };
    outcome = simulate(scene, settings, observe, tell);
  }
  outcome.notices.insert(outcome.notices.begin(), notices.begin(), notices.end());

  if (record) record->write(to_json(RunRecord{options.scene, scene, to_json(settings), outcome}));
  if (trajectory) trajectory->commit();
  if (reactions) reactions->commit();
  if (record) record->commit();

  if (summary) print_summary(scene, settings, outcome, last);
  if (outcome.status.ok()) return kDone;
  print_error(outcome.status.message);
  return kNumericsFailed;
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("run", "compute the motion of a scene");
  const auto options = std::make_shared<Options>();
  add_scene(*command, options->scene);
  options->settings.add_to(*command);
  command->add_option("--out", options->out, "trajectory, CSV; the run record is written beside it as .json")
      ->type_name("FILE.csv");
  command->add_option("--reactions", options->reactions, "multipliers and reaction forces, CSV")->type_name("FILE.csv");
  add_quiet(*command, options->quiet);
  command->footer(
      "Without --out and --reactions a short summary is printed. Numbers may be constant expressions, as\n"
      "in scenes: --step 1/1000 --end 2*pi.");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace poinsot::app
