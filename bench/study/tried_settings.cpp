#include "bench/study/tried_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/input_error.h"
#include "integrators/settings_table.h"

namespace poinsot::study {
namespace {

constexpr double kMostWork = 3e5;   // steps of a body in one trial, a second or some
constexpr double kMostSeconds = 4;  // beside a singular position a step can take as long as hundreds
constexpr double kMostInAll = 10;   // s, after which no other trial is begun

struct Candidate {
  std::string named;  // as on the command line
  Settings settings;
};

// Without the parameters of the method before that this one does not have; their options, as "--spectral-radius".
std::vector<std::string> drop_parameters(Settings& settings) {
  std::vector<std::string> dropped;
  const auto parameters = integrators().require(settings.integrator).parameters;
  const auto has = [&](const std::string& name) {
    return std::ranges::find(parameters, name, &MethodParameter::name) != parameters.end();
  };
  for (auto it = settings.parameters.begin(); it != settings.parameters.end();) {
    if (has(it->first)) {
      ++it;
      continue;
    }
    dropped.push_back(option_name(*find_setting(it->first)));
    it = settings.parameters.erase(it);
  }
  return dropped;
}

// A step not above `most`, and not below 2/5 of it, of which output times are multiples by a round number.
double step_at_most(double most, const Settings& settings) {
  const double whole = settings.every > 0 ? settings.every : settings.end, steps = whole / most * (1 - 1e-12);
  double tens = 1;
  while (10 * tens < steps) tens *= 10;
  for (const double by : {1, 2, 4, 5, 8})
    if (by * tens >= steps) return whole / (by * tens);
  return whole / (10 * tens);
}

std::vector<Candidate> candidates(const Settings& given, const Status& status, bool driven) {
  std::vector<Candidate> all;
  const auto add = [&](std::string named, auto change) {
    Settings settings = given;
    change(settings);
    all.push_back({std::move(named), std::move(settings)});
  };
  const auto add_integrator = [&](const char* name) {
    if (given.integrator == name) return;
    Settings settings = given;
    settings.integrator = name;
    const std::vector<std::string> without = drop_parameters(settings);
    std::string named = fmt::format("--integrator {}", name);
    if (!without.empty()) named += fmt::format(" and without {}", fmt::join(without, " and "));
    all.push_back({std::move(named), std::move(settings)});
  };
  const auto add_tolerances = [&](double by) {
    const double rtol = by * given.rtol;
    if (rtol < kLeastRtol || rtol > 1e-2) return;
    const double atol = by * given.absolute_tolerance();
    add(given.atol ? fmt::format("--rtol {:g} --atol {:g}", rtol, atol) : fmt::format("--rtol {:g}", rtol),
        [&](Settings& s) {
          s.rtol = rtol;
          if (given.atol) s.atol = atol;
        });
  };
  if (status.failure == Failure::refused) {
    if (given.linear_solver != "auto") add("--linear-solver auto", [](Settings& s) { s.linear_solver = "auto"; });
    return all;
  }
  const bool dynamics = given.analysis == Analysis::dynamics, controls = chooses_steps(given);
  if (given.jacobian != "exact" && !controls) add("--jacobian exact", [](Settings& s) { s.jacobian = "exact"; });
  if (!controls) {
    const double step = status.step > 0 ? step_at_most(std::min(status.step, given.step), given) : given.step / 4;
    add(fmt::format("--step {}", step), [&](Settings& s) { s.step = step; });
  }
  if (status.failure == Failure::not_converged && !controls) {
    const int iterations = 5 * given.max_iterations;
    add(fmt::format("--max-iterations {}", iterations), [&](Settings& s) { s.max_iterations = iterations; });
  }
  if (status.failure == Failure::constraint_lost && !controls) {
    const double tolerance = 1e-3 * given.tolerance;
    add(fmt::format("--tolerance {:g}", tolerance), [&](Settings& s) { s.tolerance = tolerance; });
  }
  if (controls) {
    add_tolerances(1e-2);
    add_tolerances(1e2);
  }
  if (dynamics) {
    if (driven) add("--analysis kinematics", [](Settings& s) { s.analysis = Analysis::kinematics; });
    add_integrator("auto");
    if (controls)
      for (const char* other : {"dop853", "radau5"}) add_integrator(other);
    // Steps of fixed length go over what drivers ask for that no position has.
    if (controls && !driven) add_integrator("rattle");
    if (given.formulation != "rA") add("--formulation rA", [](Settings& s) { s.formulation = "rA"; });
  } else if (status.failure == Failure::singular_position) {
    add("--analysis dynamics --integrator dop853", [](Settings& s) {
      s.analysis = Analysis::dynamics;
      s.integrator = "dop853";
    });
  }
  return all;
}

struct TooLong {};

// Where a run that stopped has to get beyond with other settings.
double well_beyond(const Settings& settings, const Status& stopped) {
  constexpr double kBeyond = 0.1, kOfRun = 0.01, kSteps = 20;
  double beyond = std::max(kBeyond * stopped.time, kOfRun * settings.end);
  if (!chooses_steps(settings)) beyond = std::max(beyond, kSteps * settings.step);
  return std::min(settings.end, stopped.time + beyond);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Trial {
  enum class Result { leads_on, leads_on_with_doubts, stops, given_up } result;
  double until = 0;  // s, of one that leads on
  double steps = 0;
  bool stops_there = false;  // beyond where the run stopped
};

// Steps of a fixed length go over much that error control stops at, as where a force grows without bound, and so does
// an iteration without end: where they have more to tell than the run that stopped had (`told`, where it is given),
// nobody knows where they lead, and they are not what is offered.
Trial try_until(const Scene& scene, Settings settings, double end, double most_steps,
                const std::vector<std::string>* told) {
  using enum Trial::Result;
  settings.end = end;
  const bool fixed = !chooses_steps(settings);
  if (fixed) {
    const double steps = std::ceil(end / settings.step);
    if (steps > most_steps) return {given_up};
    settings.end = steps * settings.step;
  }
  settings.every = fixed ? settings.end : 0;
  double taken = 0;
  const auto start = std::chrono::steady_clock::now();
  try {
    const Outcome outcome = simulate(scene, settings, [&](const Sample&) {
      if (++taken > most_steps || seconds_since(start) > kMostSeconds) throw TooLong();
    });
    if (outcome.status.failure == Failure::interrupted) return {given_up};
    const auto was_told = [&](const std::string& notice) { return std::ranges::find(*told, notice) != told->end(); };
    if (!outcome.status.ok()) return {stops, end, taken};
    const bool doubts = fixed && told && !std::ranges::all_of(outcome.notices, was_told);
    return {doubts ? leads_on_with_doubts : leads_on, end, taken};
  } catch (const InputError&) {  // as a method refuses a formulation
    return {stops};
  } catch (const TooLong&) {
    return {given_up};
  }
}

// First until well beyond where the run stopped. Then as it was asked for: beside a singular position it matters where
// output times are, and further ones may follow.
Trial try_candidate(const Scene& scene, const Settings& settings, double beyond, double most_steps,
                    const std::vector<std::string>* told) {
  using enum Trial::Result;
  const auto start = std::chrono::steady_clock::now();
  Trial trial = try_until(scene, settings, beyond, most_steps, told);
  const double seconds = seconds_since(start);
  if (trial.result != leads_on || !chooses_steps(settings)) return trial;
  Settings asked = settings;
  const double longer = settings.end / beyond;
  if (trial.steps * longer > most_steps || seconds * longer > kMostSeconds) asked.end = beyond;
  const Outcome outcome = simulate(scene, asked, [](const Sample&) {});
  if (outcome.status.failure == Failure::interrupted) return {given_up};
  trial.stops_there = !outcome.status.ok();
  trial.until = trial.stops_there ? outcome.status.time : asked.end;
  trial.result = trial.until < beyond ? stops : leads_on;
  return trial;
}

// The first with which the run does not stop, or the one that leads farthest.
struct Trials {
  std::string best;  // empty where none leads on
  Trial of_best{};
  std::vector<std::string> stopped, doubted;
  bool all = true;
  // What came of those that are not offered, with commas between.
  std::string listed() const {
    std::string text = stopped.empty() ? "" : fmt::format("without success: {}", fmt::join(stopped, ", "));
    if (!doubted.empty())
      text += fmt::format("{}with notices of its own: {}", text.empty() ? "" : "; ", fmt::join(doubted, ", "));
    return text;
  }
};
Trials try_candidates(const Scene& scene, const Settings& settings, const Outcome& outcome) {
  using enum Trial::Result;
  const double beyond = well_beyond(settings, outcome.status);
  const double most_steps = kMostWork / static_cast<double>(std::max<std::size_t>(1, scene.bodies.size()));
  Trials trials;
  const auto start = std::chrono::steady_clock::now();
  for (Candidate& candidate : candidates(settings, outcome.status, !scene.drivers.empty())) {
    if (seconds_since(start) > kMostInAll) {
      trials.all = false;
      break;
    }
    const Settings& other = candidate.settings;
    const bool same_steps = other.step == settings.step && other.integrator == settings.integrator;
    const bool no_more = chooses_steps(settings) || same_steps;
    const Trial trial = try_candidate(scene, other, beyond, most_steps, no_more ? &outcome.notices : nullptr);
    if (trial.result == given_up) trials.all = false;
    if (trial.result == leads_on && trial.until > trials.of_best.until) {
      trials.best = candidate.named;
      trials.of_best = trial;
      if (!trial.stops_there) break;
    }
    if (trial.result == stops) trials.stopped.push_back(std::move(candidate.named));
    if (trial.result == leads_on_with_doubts) trials.doubted.push_back(std::move(candidate.named));
  }
  return trials;
}

}  // namespace

void try_settings(const Scene& scene, const Settings& settings, Outcome& outcome) {
  Status& status = outcome.status;
  if (status.ok() || status.settings == 0) return;
  const bool alone = status.settings == status.remedy;
  const auto put = [&](const std::string& text) {
    status.message.resize(std::exchange(status.settings, 0));
    if (alone) status.remedy = 0;
    if (text.empty()) return;
    if (alone) status.remedy = status.message.size();
    status.message += text;
  };
  const Trials trials = try_candidates(scene, settings, outcome);
  const std::string listed = trials.listed();
  if (!trials.best.empty()) {
    const Trial& best = trials.of_best;
    put(fmt::format("{} with {} it goes on{}up to t = {:.4g} s{}", alone ? ";" : ", or", trials.best,
                    best.stops_there ? " " : ", as was tried ", best.until,
                    best.stops_there ? ", and stops there" : ""));
    return;
  }
  if (!trials.all) {
    status.message += listed.empty() ? std::string(" (not tried)") : fmt::format(" (not all tried; {})", listed);
    return;
  }
  const std::string none = "tried " + listed;
  if (listed.empty())
    put("");
  else
    put(alone ? "; " + none : " (" + none + ")");
}

}  // namespace poinsot::study
