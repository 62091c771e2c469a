#include "bench/study/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/study/measure.h"
#include "core/conserved_energy.h"
#include "core/input_error.h"
#include "formulations/registry.h"

namespace poinsot::study {

std::string Case::parameter() const {
  return integrators().require(settings.integrator).controls_error ? "rtol" : "step";
}

double Case::value() const {
  return integrators().require(settings.integrator).controls_error ? settings.rtol : settings.step;
}

std::string Case::method() const {
  const std::string name = fmt::format("{} in {}", settings.integrator, settings.formulation);
  return settings.linear_solver == kUsualSolver ? name : fmt::format("{} with {}", name, settings.linear_solver);
}

SweepPlan SweepPlan::full() {
  SweepPlan plan;
  plan.formulations = poinsot::formulations().names();
  for (const IntegratorEntry& integrator : poinsot::integrators())
    if (!integrator.picks) plan.integrators.emplace_back(integrator.name);
  plan.steps = {100, 300, 1000, 3000, 10000, 30000, 100000, 300000, 1000000};
  plan.tolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  plan.longest = 1;
  plan.repetitions = 5;
  plan.digits = 12;
  return plan;
}

SweepPlan SweepPlan::quick() {
  SweepPlan plan = full();
  plan.steps = {100, 300, 1000, 3000, 10000};
  plan.tolerances = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  plan.longest = 0.02;
  plan.repetitions = 3;
  plan.digits = 10;
  plan.reduced = true;
  return plan;
}

void require_cases(const SweepPlan& plan) {
  std::string why;
  for (const std::string& integrator : plan.integrators)
    for (const std::string& formulation : plan.formulations) {
      const auto refusal = refusal_of(integrators().require(integrator), formulation);
      if (!refusal) return;
      if (why.empty())
        why = fmt::format("integrator '{}' refuses formulation '{}': {}", integrator, formulation, refusal->why);
    }
  throw InputError(why);
}

Sweep::Sweep(const Scene& scene, double end, const Reference& reference)
    : scene_(scene),
      reference_(reference),
      model_(compile(scene)),
      end_(end),
      sizes_(sizes(reference.motion, model_)),
      kinetic_energy_(kinetic_energy(reference.motion, model_)),
      conservative_(conserves_energy(model_) && kinetic_energy_ > 0) {}

Case Sweep::make_case(const std::string& formulation, const IntegratorEntry& integrator, int steps, double rtol) const {
  Settings settings;
  settings.analysis = integrator.analysis;
  settings.reactions = true;
  settings.formulation = formulation;
  settings.integrator = integrator.name;
  settings.end = end_;
  settings.every = end_ / kOutputs;
  if (integrator.controls_error) {
    settings.rtol = rtol;
  } else {
    settings.step = end_ / steps;
    // Newton stops where a correction is small beside the accelerations of the motion, by four digits or five: more
    // does not change the errors of any method. In kinematics it is the error.
    const double small = integrator.analysis == Analysis::kinematics ? 1e-6 * sizes_.length : 1e-4;
    settings.tolerance = std::stod(fmt::format("1e{}", std::floor(std::log10(small))));
  }
  return {settings, 0};
}

std::vector<std::vector<Case>> Sweep::cases(const SweepPlan& plan) const {
  std::vector<std::vector<Case>> levels(std::max(plan.steps.size(), plan.tolerances.size()));
  for (std::size_t level = 0; level < levels.size(); ++level) {
    for (const std::string& name : plan.integrators) {
      const IntegratorEntry& integrator = integrators().require(name);
      if (level >= (integrator.controls_error ? plan.tolerances.size() : plan.steps.size())) continue;
      for (const std::string& formulation : plan.formulations) {
        if (refusal_of(integrator, formulation)) continue;
        for (const std::string& linear_solver : plan.linear_solvers) {
          Case one = make_case(formulation, integrator, integrator.controls_error ? 1 : plan.steps[level],
                               integrator.controls_error ? plan.tolerances[level] : 0);
          one.settings.linear_solver = linear_solver;
          one.level = static_cast<int>(level);
          levels[level].push_back(one);
        }
      }
    }
  }
  return levels;
}

Measured Sweep::compare(const Case& one) const {
  const MotionRun run = run_motion(scene_, one.settings);
  const Statistics& s = run.outcome.statistics;
  Measured measured;
  measured.steps = s.steps;
  measured.newton_iterations = s.newton_iterations;
  measured.factorizations = s.factorizations;
  measured.seconds = s.seconds.total;
  if (!run.outcome.status.ok()) {
    measured.status = run.outcome.status.message;
    return measured;
  }
  measured.error = difference(run.motion, reference_.motion, sizes_, model_);
  if (model_.rows.empty()) measured.error.back() = std::numeric_limits<double>::quiet_NaN();
  measured.violation_position = s.violation.position;
  measured.violation_velocity = s.violation.velocity;
  measured.energy_drift =
      conservative_ && s.energy_change ? run.energy_drift / kinetic_energy_ : std::numeric_limits<double>::quiet_NaN();
  return measured;
}

std::vector<Measured> Sweep::measure(const std::vector<Case>& batch, int repetitions,
                                     const std::function<void(const Case&)>& after) const {
  std::vector<Measured> all;
  std::vector<Cell> cells;
  for (const Case& one : batch) {
    all.push_back(compare(one));
    if (after) after(one);
    cells.push_back({{}, &scene_, one.settings, {}, all.back().ok() ? "" : all.back().status});
  }
  Rounds rounds{repetitions, false};  // the comparison was the warm-up
  if (after) rounds.after = [&](std::size_t k) { after(batch[k]); };
  study::measure(cells, rounds);
  for (std::size_t k = 0; k < batch.size(); ++k) {
    if (cells[k].runs.empty()) continue;
    std::vector<double> seconds;
    for (const Statistics& run : cells[k].runs) seconds.push_back(total(run));
    const Timing timed = timing(seconds);
    all[k].seconds = timed.median;
    all[k].spread = timed.spread;
  }
  return all;
}

std::vector<bool> front(const std::vector<double>& errors, const std::vector<double>& seconds, double agreement) {
  const double floor = kResolved * agreement;
  std::vector<bool> on(errors.size());
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (!(errors[k] <= kUseless)) continue;
    const double error = std::max(errors[k], floor);
    on[k] = true;
    for (std::size_t other = 0; other < errors.size() && on[k]; ++other) {
      const double of_other = std::max(errors[other], floor);
      const bool as_good = of_other <= error && seconds[other] <= seconds[k];
      on[k] = !(as_good && (of_other < error || seconds[other] < seconds[k]));
    }
  }
  return on;
}

std::vector<bool> front(const std::vector<Measured>& measured, std::size_t quantity, const Reference& reference) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> errors, seconds;
  for (const Measured& m : measured) {
    errors.push_back(m.ok() ? m.error[quantity] : none);
    seconds.push_back(m.ok() ? m.seconds : none);
  }
  return front(errors, seconds, reference.agreement[quantity]);
}

}  // namespace poinsot::study
