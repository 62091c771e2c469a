#include "bench/study/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/input_error.h"
#include "integrators/simulate.h"
#include "integrators/start/reactions.h"

namespace poinsot::study {
namespace {

constexpr std::int64_t kTimes = 1000;     // at most so many are compared,
constexpr std::int64_t kStates = 500000;  // and so many states of bodies kept of a run
constexpr double kRounding = 1e-13;       // relative: distances below show no order
constexpr double kLeastOrder = 0.5;       // below, no error follows from it

bool controls_error(const Settings& settings) {
  const IntegratorEntry* entry = integrators().find(settings.integrator);
  return settings.analysis == Analysis::dynamics && entry && entry->controls_error;
}

// What a run gives out at one time.
struct Given {
  std::vector<BodyState> bodies;
  std::vector<Vector3> forces, moments;  // of joints and drivers
  std::vector<double> multipliers;       // of constraints
};
struct Recorded {
  std::string failure;
  std::vector<double> t;
  std::vector<Given> given;
};

Recorded record(const Scene& scene, const Settings& settings) {
  Recorded run;
  std::optional<Reactions> reactions;
  const auto keep = [&](const Sample& sample) {
    run.t.push_back(sample.t);
    Given& now = run.given.emplace_back();
    now.bodies.resize(scene.bodies.size());
    sample.problem.to_bodies(sample.a, now.bodies);
    if (!settings.reactions) return;
    if (!reactions) reactions.emplace(sample.problem);
    reactions->update(sample);
    const std::vector<Group>& groups = sample.problem.model().groups;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (groups[g].kind == GroupKind::constraint)
        now.multipliers.push_back(reactions->lambda(groups[g].first_row));
      else
        reactions->of_group(static_cast<int>(g), now.forces.emplace_back(), now.moments.emplace_back());
    }
  };
  try {
    run.failure = simulate(scene, settings, keep).status.message;
  } catch (const InputError& refused) {
    run.failure = refused.what();
  }
  return run;
}

double distance(double x, double y) {
  return std::abs(x - y);
}
double distance(const Vector3& x, const Vector3& y) {
  return (x - y).norm();
}
double distance(const Matrix3& x, const Matrix3& y) {  // the angle between the two
  return 2 * std::asin(std::min(1.0, (x - y).norm() / (2 * std::numbers::sqrt2)));
}
double size(double x) {
  return std::abs(x);
}
double size(const Vector3& x) {
  return x.norm();
}
double size(const Matrix3&) {
  return 1;
}

struct Farthest {
  double apart = 0, size = 0, t = 0;
  std::size_t item = 0;
};

// `item` k of what `items` gives of a time: a body's position, a joint's force.
template <class Items, class Part>
Farthest farthest(const Recorded& run, const Recorded& finer, Items Given::*items, const Part& part) {
  Farthest found;
  for (std::size_t n = 0; n < run.t.size(); ++n) {
    const Items &x = run.given[n].*items, &y = finer.given[n].*items;
    for (std::size_t k = 0; k < x.size(); ++k) {
      found.size = std::max(found.size, size(part(y[k])));
      const double apart = distance(part(x[k]), part(y[k]));
      if (apart <= found.apart) continue;
      found.apart = apart;
      found.t = run.t[n];
      found.item = k;
    }
  }
  return found;
}

struct Named {
  std::string_view name, unit;
  Farthest farthest;
  std::vector<std::string> items;
};

std::vector<Named> compare(const Scene& scene, const Recorded& run, const Recorded& finer) {
  std::vector<std::string> bodies, jointed, constraints;
  for (const Body& body : scene.bodies) bodies.push_back(body.name);
  for (const Group& group : compile(scene).groups)
    (group.kind == GroupKind::constraint ? constraints : jointed).push_back(group.name);
  const auto of_bodies = [&](std::string_view name, std::string_view unit, auto part) {
    return Named{name, unit,
                 farthest(
                     run, finer, &Given::bodies, [&](const BodyState& b) -> const auto& { return b.*part; }),
                 bodies};
  };
  const auto itself = [](const auto& x) -> const auto& {
    return x;
  };
  std::vector<Named> all{of_bodies("position", "m", &BodyState::r),
                         of_bodies("orientation", "rad", &BodyState::A),
                         of_bodies("velocity", "m/s", &BodyState::rd),
                         of_bodies("angular velocity", "rad/s", &BodyState::w),
                         of_bodies("acceleration", "m/s^2", &BodyState::rdd),
                         of_bodies("angular acceleration", "rad/s^2", &BodyState::wd)};
  if (run.given.empty()) return all;
  if (!run.given.front().forces.empty()) {
    all.push_back({"reaction force", "N", farthest(run, finer, &Given::forces, itself), jointed});
    all.push_back({"reaction moment", "N m", farthest(run, finer, &Given::moments, itself), jointed});
  }
  if (!run.given.front().multipliers.empty())
    all.push_back({"multiplier", "", farthest(run, finer, &Given::multipliers, itself), constraints});
  return all;
}

// The times that are compared: those of the run, thinned; where its steps are its own affair, as many as are kept.
double common_interval(const Scene& scene, const Settings& settings) {
  const std::int64_t times =
      std::clamp<std::int64_t>(kStates / std::max<std::int64_t>(1, std::ssize(scene.bodies)), 1, kTimes);
  double interval = settings.every > 0 ? settings.every : settings.step;
  if (settings.every == 0 && controls_error(settings)) interval = settings.end / static_cast<double>(times);
  return interval * std::max(1.0, std::ceil(settings.end / interval / static_cast<double>(times) - kRounding));
}

}  // namespace

std::string accuracy(const Settings& settings) {
  if (settings.analysis == Analysis::kinematics)
    return fmt::format("every position is found on its own, to the tolerance {:g}", settings.tolerance);
  if (!controls_error(settings)) return "not estimated";
  return fmt::format(
      "the error of a step, as estimated, is held to rtol {:g} and atol {:g}; what adds up over the run is "
      "not estimated",
      settings.rtol, settings.absolute_tolerance());
}

Verification verify(const Scene& scene, const Settings& settings) {
  Verification result;
  Settings own = settings, finer = settings;
  own.every = finer.every = common_interval(scene, settings);
  const bool steps = result.steps = settings.analysis == Analysis::dynamics && !controls_error(settings);
  if (settings.analysis == Analysis::kinematics) {
    finer.step /= 2;
    finer.tolerance /= 10;
    result.against = fmt::format("half the step and a tenth of the tolerance, {:g}", finer.tolerance);
  } else if (steps) {
    finer.step /= 2;
    result.against = fmt::format("half the step, h = {:g} s", finer.step);
  } else {
    finer.rtol = std::max(kLeastRtol, settings.rtol / 10);
    finer.atol = settings.absolute_tolerance() / 10;
    result.against = fmt::format("a tenth of the tolerances, rtol {:g} and atol {:g}", finer.rtol, *finer.atol);
  }
  const auto failed = [&](std::string_view which, const Recorded& run) {
    if (!run.failure.empty()) result.failure = fmt::format("the run with {} failed: {}", which, run.failure);
    return !run.failure.empty();
  };
  Recorded run = record(scene, own);
  if (failed("other output times", run)) return result;
  Recorded second = record(scene, finer);
  if (failed(result.against, second)) return result;
  result.times = run.t.size();
  for (const Named& q : compare(scene, run, second))
    result.quantities.push_back(
        {q.name, q.unit, q.farthest.apart, q.items.empty() ? "" : q.items[q.farthest.item], q.farthest.t, {}, {}});
  if (!steps) return result;
  run = {};
  finer.step /= 2;
  const Recorded third = record(scene, finer);
  if (failed(fmt::format("a quarter of the step, which shows the order, h = {:g} s,", finer.step), third))
    return result;
  const std::vector<Named> beyond = compare(scene, second, third);
  for (std::size_t k = 0; k < beyond.size(); ++k) {
    Verification::Quantity& q = result.quantities[k];
    const Farthest& next = beyond[k].farthest;
    if (!(next.apart > kRounding * next.size) || !(q.apart > 0) || !std::isfinite(q.apart)) continue;
    q.order = std::log2(q.apart / next.apart);
    if (*q.order >= kLeastOrder) q.error = q.apart / (1 - std::exp2(-*q.order));
  }
  return result;
}

}  // namespace poinsot::study
