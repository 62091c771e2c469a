#include "integrators/stepping/law_switches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kSideLooks[] = {0.25, 0.5, 0.75, 1};  // of a step
constexpr double kKnown = 3e-3;                        // of a step, how well it tells when
constexpr double kNearKink = 1e-4, kNearJump = 1e-5;   // of a step: accelerations change by as much and no more
constexpr double kOfTolerance = 0.1;
constexpr double kOfBend = 1.0 / 30;  // of |F'(s+) − F'(s−)|: what F differs by from a smooth function
constexpr double kSoonAgain = 1e-8;   // of the run
constexpr int kMostSoon = 20;         // on end
constexpr double kMoment = 1e-14, kOffJump = 1e-13;  // of the run

double side_of(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

}  // namespace

LawSwitches::LawSwitches(const LawSteps& steps, double end, double rtol, double atol)
    : steps_(steps), end_(end), rtol_(rtol), atol_(atol) {
  const Bounds unknown = Bounds::unknown();
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Expression* F = steps.law(n).of.F;
    const int switches = F ? F->switch_count() : 0;
    Law law{n, {}};
    for (int k = 0; k < switches; ++k)
      if (F->switch_range(k, {{}, unknown, unknown}).is_unknown())
        law.switches.push_back({k, F->switch_jumps(k), F->switch_range(k, {{}, unknown, {}}).is_unknown()});
    if (steps.law(n).of.spring >= 0) law.switches.push_back({kNoLength, true, true});
    if (law.switches.empty()) continue;
    values_.resize(std::max(values_.size(), index(switches)));
    laws_.push_back(std::move(law));
  }
}

void LawSwitches::begin() {
  const double from = steps_.from();
  const bool led = beyond_ == from;
  Switch* const crossed = led ? approached_.of : nullptr;
  const double other_side = crossed ? -crossed->side : 0;
  beyond_ = kNever;
  approached_ = {};
  long_ = 0;
  for (Law& law : laws_) {
    const LawPath path = steps_.ahead(law.law, from + end_);
    for (Switch& of : law.switches) {
      of.side = side_of(value(law.law, of, path, 0));
      if (of.side == 0 && of.jumps && !led && begins_on(of, path)) beyond_ = from + kOffJump * end_;
    }
  }
  if (!crossed) return;
  crossed->side = other_side;  // whatever rounding makes of it
  note_crossing(*crossed, from);
}

void LawSwitches::note_crossing(Switch& of, double t) const {
  of.soon = t - of.last < kSoonAgain * end_ ? of.soon + 1 : 0;
  of.last = t;
}

double LawSwitches::reach(double to) {
  const double from = steps_.from(), h = to - from;
  const bool looked = to == steps_.to();
  Crossing first;
  for (Law& law : laws_) look(law, looked ? steps_.path(law.law) : steps_.ahead(law.law, to), h, first);
  if (!first.of) return to;
  approached_ = first;
  const double left = first.s * h;
  expected_ = from + left;
  within_ = kKnown * h;
  const double rounding = resolution();
  if (left > 2 * std::max(within_, rounding)) return from + left - within_;
  const double known = length(h);  // as its beginning tells, which is nearer
  if (beyond_ < to) return from;
  if (beyond_ == kNever && h > 4 * rounding) return from + std::min(known, 0.9 * h);
  beyond_ = kNever;  // it ends so near that it may go over it
  return to;
}

void LawSwitches::accept() {
  const double to = steps_.to(), h = to - steps_.from();
  for (Law& law : laws_) {
    for (Switch& of : law.switches) {
      if (of.next * of.side < 0) note_crossing(of, to);
      of.side = of.next;
    }
  }
  long_ = approached_.of ? std::max(long_, h) : h;
  if (approached_.of && to > expected_ + within_) approached_ = {};
}

double LawSwitches::length(double h) {
  if (!approached_.of) return h;
  const double from = steps_.from(), left = this->left();
  if (left == kNever) return std::min(h, span());
  const double rounding = resolution();
  const double within = long_ > 0 ? std::min(left * left / long_, 0.5 * left) : 0.5 * left;
  const double near = std::max({(approached_.of->jumps ? kNearJump : kNearKink) * long_, kMoment * end_, rounding});
  if (left > near) return std::min(h, left - within);
  beyond_ = from + left + within + kMoment * end_ + rounding;
  return h;
}

double LawSwitches::crossed_within(double time) {
  const double left = approached_.of ? this->left() : kNever;
  return left <= time ? steps_.from() + left : kNever;
}

// s, until the switch is crossed that is approached, as the motion goes on at its beginning.
double LawSwitches::left() {
  const Switch& of = *approached_.of;
  const LawPath path = steps_.ahead(approached_.law, steps_.from() + span());
  double before = 0;
  for (const double s : kSideLooks) {
    if (of.side * value(approached_.law, of, path, s) < 0) return span() * root(approached_.law, of, path, before, s);
    before = s;
  }
  return kNever;
}

// s, what rounding of places leaves open of when the switch approached is crossed.
double LawSwitches::resolution() const {
  constexpr double kRoundedExtent = 4e-16, kMost = 1e-10;
  if (!approached_.of->by_x) return 0;
  const LawSteps::Law& law = steps_.law(approached_.law);
  const double v = std::abs(law.of.arguments(law.from, steps_.from()).v), open = kRoundedExtent * law.from.extent;
  return open < kMost * end_ * v ? open / v : kMost * end_;
}

void LawSwitches::look(Law& law, const LawPath& path, double h, Crossing& first) {
  for (Switch& of : law.switches) of.next = of.side;
  double before = 0;
  for (const double s : kSideLooks) {
    find_values(law.law, path, s);
    for (Switch& of : law.switches) {
      const double side = side_of(value(of, path, s));
      if (side == 0) continue;
      const bool longest = of.k == kNoLength && side < 0;
      if (side * of.next < 0 && !longest && before < first.s) {
        const double at = root(law.law, of, path, before, s);
        find_values(law.law, path, s);  // again those here
        if (at < first.s && (&of == approached_.of || counts(law.law, of, path, at, h))) first = {&of, law.law, at};
      }
      of.next = side;
    }
    before = s;
  }
}

void LawSwitches::find_values(std::size_t law, const LawPath& path, double s) {
  if (const Expression* F = steps_.law(law).of.F) F->switches(path.moving(s), values_);
}

// Those of laws have been found.
double LawSwitches::value(const Switch& of, const LawPath& path, double s) const {
  if (of.k != kNoLength) return values_[index(of.k)];
  const LawPlace place = path.place(s);
  return place.d.dot(place.rate);
}

double LawSwitches::value(std::size_t law, const Switch& of, const LawPath& path, double s) {
  if (of.k != kNoLength) find_values(law, path, s);
  return value(of, path, s);
}

// d · ḋ is zero at rest, too.
bool LawSwitches::begins_on(const Switch& of, const LawPath& path) const {
  if (of.k != kNoLength) return true;
  const LawPlace place = path.place(0);
  return place.d.isZero(0) && !place.rate.isZero(0);
}

// Where the sign becomes what it is at `to`, by bisection.
double LawSwitches::root(std::size_t law, const Switch& of, const LawPath& path, double from, double to) {
  constexpr int kBisections = 40;
  const double beyond = side_of(value(law, of, path, to));
  for (int n = 0; n < kBisections; ++n) {
    const double middle = from + 0.5 * (to - from);
    (value(law, of, path, middle) * beyond > 0 ? to : from) = middle;
  }
  return to;
}

// Whether a step over it comes out wrong by more than the tolerance, as a velocity of the lighter body.
bool LawSwitches::counts(std::size_t law, const Switch& of, const LawPath& path, double s, double h) const {
  if (of.soon > kMostSoon) return false;
  const LawSteps::Law& steps = steps_.law(law);
  const double wrong = of.k == kNoLength ? turned_round(law, path, s, h) : bent(law, of, path, s);
  return wrong > kOfTolerance * tolerance(steps) * steps.of.inertia / h;
}

// N, by how much the force of a spring changes that is shortest at s: 0 where error control is to see how it turns, in
// about the time |d|/|ḋ|, or what else it does so near.
double LawSwitches::turned_round(std::size_t law, const LawPath& path, double s, double h) const {
  const LawSteps::Law& steps = steps_.law(law);
  const LawPlace place = path.place(s);
  const double t = steps_.from(), F = steps.of.at_rest(0, t), near = kNearJump * std::max(long_, h);  // s
  const double beside = path.place(s - near / h).d.norm();
  const double impulse = kOfTolerance * tolerance(steps) * steps.of.inertia;
  const bool at_once = place.d.norm() * 2 * std::abs(F) < impulse * place.rate.norm();
  return at_once && std::abs(steps.of.at_rest(beside, t) - F) * near < impulse ? 2 * std::abs(F) : 0;
}

// N, N m: what F differs by from a smooth function.
double LawSwitches::bent(std::size_t law, const Switch& of, const LawPath& path, double s) const {
  constexpr double kBeside = 1e-5;
  const LawSteps::Law& steps = steps_.law(law);
  const auto slope = [&](double from, double to, const Arguments<double>& at) {
    const LawValue<double> F = steps.of.F->law(at);
    const Arguments<double> a = path.moving(from), b = path.moving(to);
    return (F.F_x * (b.x - a.x) + F.F_v * (b.v - a.v)) / (to - from);
  };
  const Arguments<double> before = path.moving(s - kBeside), after = path.moving(s + kBeside);
  const double slope_before = slope(s - kBeside, s, before), slope_after = slope(s, s + kBeside, after);
  double wrong = kOfBend * std::abs(slope_after - slope_before);
  if (of.jumps) {
    const double by_slope = kBeside * (slope_before + slope_after);
    wrong += std::abs(steps.of.F->law(after).F - steps.of.F->law(before).F - by_slope);
  }
  return wrong;
}

}  // namespace poinsot
