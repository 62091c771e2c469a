#include "bench/study/chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/study/cache.h"
#include "bench/study/report.h"
#include "bench/study/scene_check.h"
#include "core/printable.h"

namespace poinsot::study {
namespace {

// What a run takes, in steps, roughly: for the progress only.
double weight(const Case& one, const SweepPlan& plan) {
  constexpr double of_error_control = 3000, per_step = 1e-5;  // s
  if (one.parameter() != "step") return of_error_control;
  const double steps = one.settings.end / one.settings.step;
  return steps * per_step < plan.longest ? steps : 0;
}

// A sentence where the case would take too long, by the run of its method before it.
std::string too_long(const Case& one, const std::vector<std::vector<Case>>& levels, const ChartFile& file,
                     double longest) {
  if (one.level == 0) return {};
  for (const Case& before : levels[static_cast<std::size_t>(one.level) - 1]) {
    if (before.method() != one.method()) continue;
    const ChartRow* row = file.find(before);
    if (!row || row->measured.left_out()) return "left out, as the one before";
    const double expected =
        one.parameter() == "step" ? row->measured.seconds * before.value() / one.value() : row->measured.seconds * 2;
    const double patience = one.parameter() == "step" ? 1 : kPatience;
    if (row->measured.ok() && expected > patience * longest)
      return fmt::format("left out, some {:.2g} s are expected", expected);
  }
  return {};
}

}  // namespace

std::vector<std::string> chart_notes(const Scene& scene, double end, const Reference& r, const SweepPlan& plan,
                                     int core) {
  std::vector<std::string> lines{
      fmt::format("scene: {}, content {:016x}", printable(scene.name), content_hash(scene.source)),
      fmt::format("motion: {}", without_freedom(scene) ? kPrescribed : kFree)};
  for (const std::string& line : origin_lines(core)) lines.push_back(line);
  lines.push_back(fmt::format("settings: to t = {:g} s; {}; {}; linear solver {}; steps {}; rtol {}, atol rtol/100{}",
                              end, fmt::join(plan.formulations, " "), fmt::join(plan.integrators, " "),
                              fmt::join(plan.linear_solvers, " "), fmt::join(plan.steps, " "),
                              fmt::join(plan.tolerances, " "), plan.reduced ? "; --quick, the reduced set" : ""));
  lines.push_back(fmt::format(
      "errors: largest over {} output times and all bodies or constraints, relative to the largest value of the motion "
      "(rotations: rad)",
      kOutputs));
  lines.push_back(
      fmt::format("reference: {} in {}, rtol {:g}, {}; it resolves {:.1g} in positions, {:.1g} in "
                  "velocities, {:.1g} in accelerations, {:.1g} in multipliers",
                  r.of().integrator, r.of().formulation, r.of().tight,
                  r.nearest < 0 ? "not confirmed by another method" : "confirmed by another method", r.agreement[0],
                  r.agreement[1], r.agreement[2], r.agreement[3]));
  lines.push_back(fmt::format(
      "time: of the time-stepping loop, median of {} interleaved repetitions after a first run; runs expected to take "
      "over {:g} s (error control: {:g} s) are left out",
      plan.repetitions, plan.longest, kPatience * plan.longest));
  lines.push_back(fmt::format(
      "front: the curve through a method's cases is below all others by more than the noise of the times; errors below "
      "{:g} times what the reference resolves count as equal, errors over {:g} not at all",
      kResolved, kUseless));
  return lines;
}

void measure_chart(const Scene& scene, double end, const Reference& reference, const SweepPlan& plan, ChartFile& file,
                   const ProgressCallback& progress) {
  const Sweep sweep(scene, end, reference);
  const std::vector<std::vector<Case>> levels = sweep.cases(plan);
  Progress told{0, 0};
  for (const auto& level : levels)
    for (const Case& one : level) told.all += weight(one, plan) * (1 + plan.repetitions);
  for (const std::vector<Case>& level : levels) {
    std::vector<Case> batch;
    for (const Case& one : level) {
      const bool measured = file.find(one);
      const std::string why = measured ? "" : too_long(one, levels, file, plan.longest);
      if (!measured && why.empty()) {
        batch.push_back(one);
        continue;
      }
      if (!measured) file.add(one, {why});
      const double skipped = weight(one, plan) * (1 + plan.repetitions);
      told.done += skipped;
      told.skipped += skipped;
    }
    const std::vector<Measured> measured = sweep.measure(batch, plan.repetitions, [&](const Case& one) {
      told.done += weight(one, plan);
      if (progress) progress(told);
    });
    for (std::size_t k = 0; k < batch.size(); ++k) file.add(batch[k], measured[k]);
  }
  file.finish(reference);
}

}  // namespace poinsot::study
