#include "integrators/stepping/passed_in_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "integrators/stepping/law_looks.h"

namespace poinsot {
namespace {

double span_at(const SpringLaw& of, const LawPlace& at) {
  return of.torsion >= 0 ? at.d.x() : at.d.norm();
}

double extent_of(const SpringLaw& of, const LawPlace& at) {
  return of.torsion >= 0 ? 1 : at.d.norm() + std::abs(of.zero);
}

// A switch that time and rate alone decide is not passed over by the way. One that x decides among others may be.
bool jumps_with_x(const Expression& F, Bounds x) {
  const Bounds unknown = Bounds::unknown();
  for (int k = 0; k < F.switch_count(); ++k) {
    if (!F.switch_jumps(k)) continue;
    const Bounds by_x = F.switch_range(k, {unknown, x, unknown});
    if (by_x.is_unknown() ? F.switch_range(k, {{}, unknown, {}}).is_unknown() : by_x.straddles_zero()) return true;
  }
  return false;
}

bool keeps_its_sign(Bounds slope) {
  constexpr double kRoundingOfForces = 1e-9;
  return std::isfinite(slope.least) && std::isfinite(slope.most) &&
         (slope.least >= -kRoundingOfForces * slope.most || slope.most <= -kRoundingOfForces * slope.least);
}

// Of the part of a step that begins at s and in which F differs from that at its ends by half as much as at s, or more.
double length_of_part(const LawPath& path, double s) {
  constexpr double kGrowth = 1.5, kFirst = 1e-5, kAsMuch = 0.5;
  const double before = path.force(0), after = path.force(1);
  const auto off = [&](double at) { return path.force(at) - before - at * (after - before); };
  const double here = off(s);
  double length = kFirst;
  while (s + length < 1 && off(s + length) * here > kAsMuch * here * here) length *= kGrowth;
  return std::min(length, 1 - s);
}

}  // namespace

PassedInSteps::PassedInSteps(const Model& model, double end, Tell tell)
    : model_(model), end_(end), tell_(std::move(tell)) {
  for (const SpringLaw& of : spring_laws(model)) laws_.push_back({of, LawTerms(of), {}, false, {}});
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
}

void PassedInSteps::look(const Problem& problem, const State& at, double h) {
  problem.to_bodies(at.a(), bodies_);
  const bool goes_on = look_.goes_on(at.t, h);
  double quiet = kMostSteps;
  std::erase_if(laws_, [&](Law& law) {
    const LawPlace to = law.of.place(model_, problem, bodies_);
    if (goes_on && law.watched && !stays(law, to, at.t, h)) return true;
    law.from = to;
    const double steps = quiet_for(law, at.t, h);
    law.watched = steps < 1;
    quiet = std::min(quiet, steps);
    return false;
  });
  look_.after(at.t, h, quiet);
}

double PassedInSteps::nothing(const Law& law, double speed, double h) const {
  return kCounts * std::max(law.largest, law.of.inertia * speed / h);
}

// Steps from where the law is; below 1 where the next one is to be looked at.
double PassedInSteps::quiet_for(Law& law, double t, double h) const {
  const double speed = law.from.rate.norm(), bend = law.from.second.norm();
  const double x = span_at(law.of, law.from) - law.of.zero, way = h * (speed + 0.5 * h * bend);
  const Box& box = law.box;
  const auto steps = [&] {
    if (!(box.least <= x && x <= box.most && speed <= box.speed && way <= box.way)) return 0.0;
    const double margin = std::min(x - box.least, box.most - x);
    return std::min({kMostSteps, margin / (kFaster * h * speed), std::sqrt(margin / bend) / h});
  };
  double quiet = steps();
  if (quiet < 1 && --law.no_box_for < 0) {
    quiet = find_box(law, t, way, h) ? steps() : 0;
    if (quiet < 1) law.no_box_for = kNoBoxFor;
  }
  return quiet;
}

bool PassedInSteps::find_box(Law& law, double t, double way, double h) const {
  constexpr double kReach[] = {1e6, 64, 16};  // steps to either side
  const SpringLaw& of = law.of;
  const double speed = law.from.rate.norm(), size = extent_of(of, law.from);
  const double x = span_at(of, law.from) - of.zero;
  const double most_speed = kFaster * speed + size / end_;
  law.largest = std::max(law.largest, std::abs(of.F->law(Arguments<double>{t, x, speed}).F));
  for (const double reach : kReach) {
    const double to_side = std::min(reach * way, 4 * size);
    // Where the span is 0, x may turn round within a step.
    const Bounds around{of.torsion >= 0 ? x - to_side : std::max(-of.zero, x - to_side), x + to_side};
    if (jumps_with_x(*of.F, around)) continue;
    const Bounds slope = of.F->law_range({{0, end_}, around, {-most_speed, most_speed}}).fd;
    const double straight = keeps_its_sign(slope) ? std::numeric_limits<double>::infinity()
                                                  : 4 * nothing(law, speed, h) / (slope.most - slope.least);
    if (!(straight > way)) continue;
    law.box = {around.least, around.most, most_speed, straight};
    return true;
  }
  return false;
}

// The step of h to t passes over nothing that counts, or not for certain.
bool PassedInSteps::stays(Law& law, const LawPlace& to, double t, double h) const {
  const double speed = std::max(law.from.rate.norm(), to.rate.norm());
  bool known = true;
  for (const LawTerms::Part& part : law.terms.parts()) {
    const LawPath path(part.law, law.from, to, t - h, t);
    const LawEnds ends = path.ends();
    law.largest = std::max({law.largest, std::abs(ends.from.f), std::abs(ends.to.f)});
    const UnseenForce first = (part.whole ? first_unseen : first_known)(path, ends, nothing(law, speed, h));
    if (first.s < 1 && first.known) {
      tell_passed(law, path, first.s, t, h);
      return false;
    }
    known = known && !(first.s < 1);
  }
  law.unknown = known ? 0 : law.unknown + 1;
  if (law.unknown < kMostUnknown) return true;
  tell_(
      fmt::format("from t = {:.6g} s on '{}' is not watched for what it does within less than a step, since it has no "
                  "close bounds there",
                  t, law.of.F->text()));
  return false;
}

// The step to offer sees it in several places, and the motion that it leads to.
void PassedInSteps::tell_passed(const Law& law, const LawPath& path, double s, double t, double h) const {
  constexpr double kPart = 0.1, kOfMotion = 0.1;
  constexpr int kSamples = 16;
  const double length = length_of_part(path, s);
  double slope = 0, largest = 0;
  for (int k = 0; k <= kSamples; ++k) {
    const double at = s + length * k / kSamples, force = path.force(at);
    slope = std::max(slope, std::abs(path.slope(at)));
    if (std::abs(force) > std::abs(largest)) largest = force;
  }
  const double offered = std::min(kPart * length * h, kOfMotion * std::sqrt(law.of.inertia / slope));
  tell_(fmt::format(
      "at t = {:.6g} s {} comes to {:.3g} {} within less than a step of {:g} s, which goes over that, "
      "whatever it does to the motion; take a step of at most {:.1g} s, or an integrator with error control",
      t - h + s * h, law.of.called(model_), largest, law.of.unit(), h, 0.9 * offered));
}

}  // namespace poinsot
