#include "bench/study/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bench/study/motion.h"
#include "core/input_error.h"
#include "core/so3.h"
#include "integrators/simulate.h"
#include "integrators/start/reactions.h"

namespace poinsot::study {
namespace {

constexpr std::int64_t kTimes = 1000;     // at most so many are compared,
constexpr std::int64_t kStates = 500000;  // and so many states of bodies kept of a run
constexpr double kRounding = 1e-13;       // relative: distances below show no order
constexpr double kLeastOrder = 0.5;       // below, no error follows from it
constexpr double kBeyondOrder = 1.25;     // so far above the method's own, it is none of its errors that shrinks

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
double distance(const Matrix3& x, const Matrix3& y) {
  return angle_between(x, y);
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

struct Compared {
  Verification::Quantity quantity;
  double size = 0;
};

// Where two runs are farthest apart in a `part` of what `items` gives of a time, an item for each name.
template <class Items, class Part>
Compared farthest(const Verification::Quantity& quantity, const Recorded& run, const Recorded& finer,
                  Items Given::*items, Part part, const std::vector<std::string>& names) {
  Compared found{quantity};
  if (!names.empty()) found.quantity.where = names.front();
  for (std::size_t n = 0; n < run.t.size(); ++n) {
    const Items &x = run.given[n].*items, &y = finer.given[n].*items;
    for (std::size_t k = 0; k < x.size(); ++k) {
      found.size = std::max(found.size, size(std::invoke(part, y[k])));
      const double apart = distance(std::invoke(part, x[k]), std::invoke(part, y[k]));
      if (apart <= found.quantity.apart) continue;
      found.quantity.apart = apart;
      found.quantity.t = run.t[n];
      found.quantity.where = names[k];
    }
  }
  return found;
}

std::vector<Compared> compare(const Scene& scene, const Recorded& run, const Recorded& finer) {
  std::vector<std::string> bodies, jointed, constraints;
  for (const Body& body : scene.bodies) bodies.push_back(body.name);
  for (const Group& group : compile(scene).groups)
    (group.kind == GroupKind::constraint ? constraints : jointed).push_back(group.name);
  std::vector<Compared> all;
  const auto add = [&](std::string_view name, std::string_view unit, auto items, const std::vector<std::string>& names,
                       auto part) {
    all.push_back(farthest({name, unit}, run, finer, items, part, names));
  };
  add("position", "m", &Given::bodies, bodies, &BodyState::r);
  add("orientation", "rad", &Given::bodies, bodies, &BodyState::A);
  add("velocity", "m/s", &Given::bodies, bodies, &BodyState::rd);
  add("angular velocity", "rad/s", &Given::bodies, bodies, &BodyState::w);
  add("acceleration", "m/s^2", &Given::bodies, bodies, &BodyState::rdd);
  add("angular acceleration", "rad/s^2", &Given::bodies, bodies, &BodyState::wd);
  if (run.given.empty()) return all;
  if (!run.given.front().forces.empty()) {
    add("reaction force", "N", &Given::forces, jointed, std::identity());
    add("reaction moment", "N m", &Given::moments, jointed, std::identity());
  }
  if (!run.given.front().multipliers.empty()) add("multiplier", "", &Given::multipliers, constraints, std::identity());
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
  for (Compared& q : compare(scene, run, second)) result.quantities.push_back(std::move(q.quantity));
  if (!steps) return result;
  run = {};
  finer.step /= 2;
  const Recorded third = record(scene, finer);
  if (failed(fmt::format("a quarter of the step, which shows the order, h = {:g} s,", finer.step), third))
    return result;
  const std::vector<Compared> beyond = compare(scene, second, third);
  const double most_order = integrators().require(settings.integrator).order + kBeyondOrder;
  for (std::size_t k = 0; k < beyond.size(); ++k) {
    Verification::Quantity& q = result.quantities[k];
    const double next = beyond[k].quantity.apart;
    if (!(next > kRounding * beyond[k].size) || !(q.apart > 0) || !std::isfinite(q.apart)) continue;
    const double order = std::log2(q.apart / next);
    q.order_unseen = order > most_order;
    if (q.order_unseen) continue;
    q.order = order;
    if (order >= kLeastOrder) q.error = q.apart / (1 - std::exp2(-order));
  }
  return result;
}

}  // namespace poinsot::study
