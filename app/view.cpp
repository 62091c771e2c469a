#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/settings_options.h"
#include "app/terminal.h"
#include "bench/study/output_file.h"
#include "bench/view/page.h"
#include "bench/view/trajectory_file.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/scene_reader.h"
#include "integrators/simulate.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

struct ViewOptions {
  std::string scene, out;
  std::vector<std::string> set, trajectories;
  SettingsOptions settings;
  bool quiet = false;
};

constexpr std::size_t kMostTrajectories = 2;
constexpr std::size_t kSmooth = 300;  // frames; of fewer and larger steps the page would show what lies between wrongly

// "dynamics, rA, dop853, rtol = 1e-08"
std::string label_of(const Settings& settings) {
  if (settings.analysis == Analysis::kinematics)
    return fmt::format("kinematics, {}, h = {:g} s", settings.formulation, settings.step);
  const IntegratorEntry* method = integrators().find(settings.integrator);
  const std::string parameter = method && method->controls_error ? fmt::format("rtol = {:g}", settings.rtol)
                                                                 : fmt::format("h = {:g} s", settings.step);
  return fmt::format("{}, {}, {}", settings.formulation, settings.integrator, parameter);
}

void note_stride(std::size_t stride, bool quiet) {
  if (stride > 1 && !quiet)
    print_notice(fmt::format(
        "the page shows every {}th of the states, as many as a browser takes; --every DT chooses them", stride));
}

view::Motion computed(const ViewOptions& options, const Scene& scene, const std::shared_ptr<const Model>& model,
                      Outcome& outcome) {
  std::vector<std::string> notices;
  Settings settings = options.settings.resolve(notices);
  std::vector<BodyState> bodies(scene.bodies.size());
  const auto run = [&] {
    view::FrameRecorder recorder(model, settings.every == 0);
    ProgressLine progress("s", !options.quiet);
    const auto observe = [&](const Sample& sample) {
      sample.problem.to_bodies(sample.a, bodies);
      recorder.add(sample.t, bodies);
      progress.at({sample.t, settings.end});
    };
    try {
      outcome = simulate(scene, settings, observe);
    } catch (const InputError& refused) {
      throw InputError(fmt::format("{}: {}", shown_input(options.scene), with_lines_of(options.scene, refused.what())));
    }
    progress.clear();
    note_stride(recorder.stride(), options.quiet);
    return recorder.take();
  };
  std::vector<view::Frame> frames = run();
  if (settings.every == 0 && chooses_steps(settings) && outcome.status.ok() && frames.size() < kSmooth) {
    settings.every = settings.end / static_cast<double>(kSmooth);
    frames = run();
  }
  outcome.notices.insert(outcome.notices.begin(), notices.begin(), notices.end());
  return {label_of(settings), outcome.status.message, std::move(frames)};
}

view::Motion read(const ViewOptions& options, const std::string& file, const Scene& scene,
                  const std::shared_ptr<const Model>& model) {
  view::FrameRecorder recorder(model, true);
  view::read_trajectory(file, scene, [&](double t, std::span<const BodyState> bodies) { recorder.add(t, bodies); });
  note_stride(recorder.stride(), options.quiet);
  const view::RecordedRun run = view::recorded_run(file, scene);
  std::string label = fs::path(file).filename().string();
  if (!run.otherwise.empty()) label += ", " + run.otherwise;
  if (!options.quiet && !run.incomplete.empty()) print_notice(fmt::format("{}: incomplete: {}", file, run.incomplete));
  if (!options.quiet && !run.otherwise.empty())
    print_notice(
        fmt::format("{}: {}: it is drawn with the dimensions of {}", file, run.otherwise, shown_input(options.scene)));
  return {label, run.incomplete, recorder.take()};
}

int write_view(const ViewOptions& options) {
  if (!view::missing_page().empty()) throw InputError(std::string(view::missing_page()));
  if (options.trajectories.size() > kMostTrajectories)
    throw InputError(
        fmt::format("--trajectory: found {}, expected at most {}", options.trajectories.size(), kMostTrajectories));
  if (const std::string given = options.settings.first_given(); !options.trajectories.empty() && !given.empty())
    throw InputError(fmt::format("{}: expected nothing, a trajectory that is given is not computed", given));
  const Scene scene = read_scene(options.scene, values_set(options.set));
  const auto model = std::make_shared<const Model>(compile(scene));
  const NamedFile page{"--out", options.out};
  refuse_overwriting({{"the scene", options.scene}, {"the configuration", options.settings.config_file()}}, {page});
  for (const std::string& file : options.trajectories) refuse_overwriting({{"--trajectory", file}}, {page});
  OutputFile out(options.out);

  std::vector<view::Motion> motions;
  Outcome outcome;
  for (const std::string& file : options.trajectories) motions.push_back(read(options, file, scene, model));
  if (motions.empty()) motions.push_back(computed(options, scene, model, outcome));
  const auto placed = [&](std::string_view sentence) { return with_lines_of(options.scene, sentence); };
  if (motions.front().frames.empty()) {  // it failed before the first state
    print_error(placed(outcome.status.message));
    return kNumericsFailed;
  }
  out.write(view::page(*model, scene.about, motions));
  out.commit();

  if (!options.quiet)
    for (const std::string& notice : outcome.notices) print_notice(placed(notice));
  if (outcome.status.ok()) return kDone;
  print_error(placed(outcome.status.message));
  return kNumericsFailed;
}

}  // namespace

void add_view(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "view", "write a page that shows the motion in a browser", write_view);
  add_scene(command, options.scene, options.set);
  command
      .add_option("--trajectory", options.trajectories,
                  "show this motion, as `poinsot run --out` wrote it, instead of computing one; given twice, both are "
                  "shown, and where they part")
      ->type_name("FILE.csv")
      ->expected(1)
      ->take_all();
  command.add_option("--out", options.out, "the page")->required()->type_name("FILE.html");
  options.settings.add_to(command);
  add_quiet(command, options.quiet);
  command.footer(
      "The page needs nothing beside it and no network; `?` in it lists its keys. A run that fails is shown as far as\n"
      "it came.");
}

}  // namespace poinsot::app
