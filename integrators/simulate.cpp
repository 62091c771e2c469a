#include "integrators/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/check.h"
#include "core/flush_subnormals.h"
#include "core/index.h"
#include "core/input_error.h"
#include "core/places.h"
#include "core/scene_doubts.h"
#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "integrators/settings_reader.h"
#include "integrators/settings_table.h"
#include "integrators/signals.h"
#include "integrators/start/first_state.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/over_constrained.h"
#include "integrators/start/small_mechanisms.h"
#include "integrators/stepping/energy_balance.h"
#include "integrators/stepping/pulses.h"
#include "integrators/stepping/switch_times.h"
#include "integrators/stepping/vectors.h"
#include "integrators/stop_causes.h"
#include "integrators/stopping_test.h"
#include "integrators/tilted_axes.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

const IntegratorEntry& integrator_of(const Settings& settings) {
  if (settings.analysis == Analysis::kinematics) {
    const auto of_kinematics = std::ranges::find(integrators(), Analysis::kinematics, &IntegratorEntry::analysis);
    check(of_kinematics != integrators().end(), "there is an integrator of kinematics");
    return *of_kinematics;
  }
  const IntegratorEntry& entry = integrators().require(settings.integrator);
  if (entry.analysis != Analysis::dynamics) {
    throw InputError(fmt::format("integrator '{}' is not one of dynamics", entry.name));
  }
  check_formulation(settings);
  return entry;
}

Steps steps_of(const Settings& settings) {
  if (settings.analysis == Analysis::kinematics) return Steps::of_kinematics;
  return chooses_steps(settings) ? Steps::error_controlled : Steps::fixed;
}

void refuse_free_motion(const Problem& problem) {
  for (const Row& row : problem.model().rows)
    if (row.type == RowType::pfaffian)
      throw InputError(fmt::format("{} is a velocity constraint, which leaves positions free; use analysis dynamics",
                                   describe_group(problem.model(), row.group)));
  const int free = problem.nv() - problem.nc();
  if (free > 0) {
    throw InputError(
        fmt::format("kinematics needs a mechanism without degrees of freedom, this one has {}; add drivers, "
                    "or use analysis dynamics",
                    free));
  }
}

// Steps of fixed length go over switches and pulses of the data; error control does not.
void tell_of_switches(const Model& model, const IntegratorEntry& integrator, const Settings& settings,
                      const Tell& notice) {
  if (integrator.controls_error || integrator.analysis == Analysis::kinematics) return;
  constexpr double kStart = 1e-9;
  const double end = settings.end;
  SwitchTimes times(model, end, notice);
  SwitchTimes::Switch first = times.first(0, end);
  if (first.before <= kStart * settings.step) first = times.first(first.after, end);  // no step goes over the start
  if (first.before < end)
    notice(fmt::format(
        "a driver or a force has a kink or a jump at t = {:.6g} s: steps of fixed length go over it, which costs {} "
        "its order there and misses what is shorter than a step; an integrator with error control steps onto it",
        first.before, integrator.name));
  if (const auto pulse = pulse_within(model, settings.step, end))
    notice(
        fmt::format("'{}' varies within less than a step at t = {:.6g} s: steps of fixed length go over that, "
                    "whatever it does to the motion; take a shorter step, or an integrator with error control",
                    pulse->function, pulse->t));
}

// Kinematics finds every position by itself, whatever lies between them; but where rows follow from others it says so
// of the times that it looks at.
void tell_of_redundant_pulses(const Model& model, const RankAnalysis& rank, const Settings& settings,
                              const Tell& notice) {
  if (settings.analysis != Analysis::kinematics || rank.aside.empty()) return;
  Model loops;
  for (const int row : rank.loops) loops.rows.push_back(model.rows[index(row)]);
  if (const auto pulse = pulse_within(loops, settings.step, settings.end))
    notice(
        fmt::format("'{}' varies within less than a step at t = {:.6g} s, in a loop with redundant rows: whether they "
                    "hold is seen at the steps alone, not between them; take a shorter step",
                    pulse->function, pulse->t));
}

void take_undetermined(Outcome& outcome, const Model& model, const std::vector<Undetermined>& reactions) {
  outcome.undetermined_reactions.clear();
  outcome.undetermined_components.clear();
  for (const Undetermined& reaction : reactions) {
    outcome.undetermined_reactions.push_back(model.groups[index(reaction.group)].name);
    outcome.undetermined_components.push_back(reaction.components(model));
  }
}

std::vector<BodyState> bodies_at(Problem& problem, const State& state) {
  std::vector<BodyState> bodies(index(problem.bodies()));
  problem.set_position(state.t, span(state.q));
  problem.set_velocity(span(state.v));
  problem.to_bodies(state.a(), bodies);
  return bodies;
}

Outcome run(const Scene& scene, const Settings& settings, const Observer& observe, const Tell& tell) {
  check_numbers(settings);
  const FormulationEntry& formulation = formulations().require(settings.formulation);
  LinearSystems systems(settings.linear());
  (void)jacobians().require(settings.jacobian);
  (void)stopping_tests().require(settings.stopping);
  const IntegratorEntry& integrator = integrator_of(settings);

  Model compiled = compile(scene);
  if (settings.signals) compiled.followed = joint_angles(compiled);
  const auto model = std::make_shared<const Model>(std::move(compiled));
  Outcome outcome;
  const Tell notice = [&](const std::string& sentence) {
    outcome.notices.push_back(with_key_paths(sentence, scene));
    if (tell) tell(outcome.notices.back());
  };
  InitialState start = find_initial_state(model, settings);
  outcome.status = start.status;
  for (const std::string& sentence : scene.notices) notice(sentence);
  for (const std::string& sentence : scene_doubts(*model)) notice(sentence);
  for (const std::string& sentence : start.notices) notice(sentence);
  take_undetermined(outcome, *model, start.rank.undetermined);
  if (!outcome.status.ok()) return outcome;

  std::unique_ptr<Problem> problem = formulation.make(model, start.rank.aside);
  const OverConstrained* redundant = nullptr;
  if (!start.rank.aside.empty()) {
    auto kept =
        std::make_unique<OverConstrained>(std::move(problem), model, start.rank, start.bodies, steps_of(settings));
    if ((settings.reactions || settings.signals) && !kept->has_least_reactions())
      notice(
          fmt::format("too many redundant rows hang together, more than {} or in very long loops, to find the least of "
                      "the reactions that they leave open: given there are those of the rows that are kept, in balance "
                      "but not the least ones",
                      BlockChoice::kMostNull));
    redundant = kept.get();
    problem = std::move(kept);
  }
  if (settings.analysis == Analysis::kinematics) refuse_free_motion(*problem);
  State state(*problem);
  outcome.status = find_first_state(start, settings, *problem, state, notice);
  std::vector<BodyState>().swap(start.bodies);  // memory of large scenes
  (void)explain_by_functions(outcome.status, *problem, settings);
  if (!outcome.status.ok()) return outcome;
  if (settings.analysis == Analysis::dynamics) {  // kinematics finds its pose itself
    problem->set_position(0, span(state.q));
    problem->set_velocity(span(state.v));
  }
  tell_of_switches(*model, integrator, settings, notice);
  tell_of_redundant_pulses(*model, start.rank, settings, notice);
  if (chooses_steps(settings)) tell_small_mechanisms(*model, settings.rtol, settings.absolute_tolerance(), notice);
  const Eigen::VectorXd q_start = state.q;
  const Rotations::Limit& rotation = integrator.rotations.in(formulation.space);
  EnergyBalance energy(*problem);
  const Observer at_ends = [&](const Sample& sample) {
    if (sample.t == 0) energy.begin(sample, integrator.order);
    if (sample.t >= settings.end) energy.end(sample);
    if (observe) observe(sample);
  };
  const bool keeps_energy = settings.analysis == Analysis::dynamics && !energy.none();
  const Run run{*problem,
                systems,
                settings,
                state,
                keeps_energy ? at_ends : observe,
                outcome.statistics,
                notice,
                rotation.senseless,
                start.rank.singular_position() ? start.rank.time_beside : 0,
                keeps_energy ? &energy : nullptr};
  {
    const FlushSubnormals flush;
    outcome.status = integrator.make()->run(run);
  }
  check(!outcome.status.ok() || state.t >= (1 - 1e-12) * settings.end, "a run that is done has come to its end");
  const bool explained = explain_by_functions(outcome.status, *problem, settings);
  if (keeps_energy && !outcome.status.ok() && state.t > 0 && model->torsions.empty()) {  // their turns are the method's
    problem->set_position(state.t, span(state.q));
    problem->set_velocity(span(state.v));
    energy.end({state.t, state.t, *problem, span(state.q), span(state.v), state.a(), state.lambda()});
  }
  if (keeps_energy) energy.conclude(run, integrator);
  if (redundant && state.t > 0) {
    const std::vector<BodyState> bodies = bodies_at(*problem, state);
    take_undetermined(outcome, *model, together(start.rank.undetermined, redundant->undetermined(state.t, bodies)));
  }
  if (const std::string apart = redundant ? redundant->apart() : ""; !apart.empty()) notice(apart);
  const double largest = outcome.statistics.largest_rotation;
  if (outcome.status.ok() && largest > rotation.wrong) {
    notice(fmt::format(
        "a body turns by up to {:.2g} rad in a step: from {:.2g} rad on {} in formulation {} loses or "
        "invents more than 3 % of a free body's rotation in a turn, in space at least; a step below {:.2g} "
        "s, or error control, does not",
        largest, rotation.wrong, integrator.name, formulation.name, 0.9 * settings.step * rotation.wrong / largest));
  }
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  if (outcome.status.ok() && chooses_steps(settings) && kEpsilon * largest > settings.rtol)
    notice(
        fmt::format("a body turns by up to {:.2g} rad in a step: rounding alone leaves its orientation open by "
                    "{:.1g} rad there, more than rtol",
                    largest, kEpsilon * largest));
  if (outcome.status.ok() && !model->open_angles.empty()) {
    tell_tilted_axes(*model, bodies_at(*problem, state), notice);
  }
  if (settings.analysis == Analysis::dynamics && !explained) {
    const int rows = static_cast<int>(model->rows.size() - start.rank.aside.size());
    explain_by_position(outcome.status, *problem, settings, rows, start.rank.doubt, q_start, state);
  }
  outcome.statistics.linear = systems.work();
  return outcome;
}

// Key paths beside the names in its message; what to try begins so much later.
void name_places(Status& status, const Scene& scene) {
  for (std::size_t* const begins : {&status.remedy, &status.settings})
    *begins = with_key_paths(std::string_view(status.message).substr(0, *begins), scene).size();
  status.message = with_key_paths(status.message, scene);
}

}  // namespace

Outcome simulate(const Scene& scene, const Settings& settings, const Observer& observe, const Tell& tell) {
  try {
    Outcome outcome = run(scene, settings, observe, tell);
    name_places(outcome.status, scene);
    return outcome;
  } catch (const InputError& refused) {
    throw InputError(with_key_paths(refused.what(), scene));
  }
}

}  // namespace poinsot
