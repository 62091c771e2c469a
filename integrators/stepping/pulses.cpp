#include "integrators/stepping/pulses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "integrators/stepping/functions_of_time.h"

namespace poinsot {
namespace {

constexpr double kAhead = 32;        // steps
constexpr double kResolved = 1e-9;   // of the run
constexpr double kUpTo = 1.0 / 8;    // of the bound
constexpr int kPlaces = 5;           // at which f̈ comes that near
constexpr double kHidden = 0.1;      // of rtol
constexpr double kUntold = 1e-6;     // of a function, in steps of fixed length
constexpr int kPartings = 6;         // of a stretch, for its bounds
constexpr int kMostUnknown = 400;    // stretches of a function
constexpr int kMostStretches = 500;  // of one function
constexpr double kNodes[] = {0, 0.11, 0.23, 0.36, 0.49, 0.63, 0.77, 0.89, 1};  // no period goes with them

Jet2<Bounds> bounds(const Expression& f, double from, double to) {
  return f.range({{from, to}, {1, 1}, {1, 1}});
}

// f̈ at the nodes of a stretch.
struct Bend {
  double largest = 0, at = 0;
  double usual = 0;  // in so many places it is as large, or larger

  Bend(const Expression& f, double from, double to) {
    std::array<double, std::size(kNodes)> sizes;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const double t = from + kNodes[k] * (to - from);
      const double bend = std::abs(value_at(f, t).fdd);
      sizes[k] = std::isnan(bend) ? 0 : bend;
      if (sizes[k] > largest) largest = sizes[k], at = t;
    }
    std::ranges::nth_element(sizes, sizes.begin() + kPlaces - 1, std::greater());
    usual = sizes[kPlaces - 1];
  }
};

// Whether |f̈| <= most throughout. Bounds are wide where terms cancel, and less so over parts of a stretch.
bool bends_less(const Expression& f, double from, double to, double most, int halvings) {
  const double bound = bounds(f, from, to).fdd.size();
  if (bound <= most) return true;
  if (halvings == 0) return false;
  const double middle = from + (to - from) / 2;
  return bends_less(f, from, middle, most, halvings - 1) && bends_less(f, middle, to, most, halvings - 1);
}

bool shows(const Expression& f, double nothing, double from, double to) {
  const double flat = 8 * nothing / ((to - from) * (to - from));
  if (bounds(f, from, to).fdd.size() <= flat) return true;
  return bends_less(f, from, to, std::max(flat, Bend(f, from, to).usual / kUpTo), kPartings);
}

// Half of what f changes by over eight steps about t.
double change_about(const Expression& f, double t, double h, double end) {
  constexpr int kSamples = 64;
  double least = value_at(f, t).f, most = least;
  for (int k = 0; k <= kSamples; ++k) {
    const double x = value_at(f, std::clamp(t + (8.0 * k / kSamples - 4) * h, 0.0, end)).f;
    least = std::min(least, x), most = std::max(most, x);
  }
  return (most - least) / 2;
}

std::optional<double> first_pulse(const Expression& f, double from, double to, double h, double end, double nothing,
                                  int& budget) {
  if (to - from <= kResolved * end || --budget < 0) return {};
  const double bound = bounds(f, from, to).fdd.size();
  if (bound * h * h <= nothing) return {};
  const Bend bend(f, from, to);
  if (bend.largest > 0) {
    const double change = change_about(f, bend.at, h, end);
    if (bend.largest * h * h > std::max(change, nothing)) return bend.at;
    if (bound * h * h <= change && bound * kUpTo <= bend.usual) return {};
  }
  const double middle = from + (to - from) / 2;
  const auto sooner = first_pulse(f, from, middle, h, end, nothing, budget);
  return sooner ? sooner : first_pulse(f, middle, to, h, end, nothing, budget);
}

}  // namespace

Pulses::Pulses(const Model& model, double end, double rtol, Tell tell) : end_(end), tell_(std::move(tell)) {
  for (const Expression* f : functions_of_time(model)) functions_.push_back({f, kHidden * rtol * size_until(*f, end)});
}

double Pulses::search(double t, double to) {
  const double least = kResolved * end_;
  double ahead = std::min(kAhead * (to - t), end_ - t);
  for (Function& of : functions_) {
    of.limits = false;
    for (; !shows(*of.f, of.nothing, t, t + ahead); ahead /= 2) {
      of.limits = true;
      if (ahead <= least) break;
    }
  }
  seen_to_ = t + ahead;
  leave_unknown(t, ahead <= least);
  return std::min(seen_to_, to);
}

// Arithmetic on intervals may not say how a function bends: where it has no bounds, or bounds far from the truth
// because terms cancel. One that holds up stretch after stretch, as short as is resolved or with nothing in them, goes
// unwatched from then on. To a pulse some thirty stretches lead, or three hundred where a method goes an eighth of
// each.
void Pulses::leave_unknown(double t, bool shortest) {
  std::erase_if(functions_, [&](Function& of) {
    if (!of.limits) return false;
    const double ahead = seen_to_ - t;
    const bool bends = Bend(*of.f, t, seen_to_).largest * ahead * ahead > 8 * of.nothing;
    of.unknown = bends && !shortest ? 0 : of.unknown + 1;
    if (of.unknown < kMostUnknown) return false;
    tell_(fmt::format(
        "from t = {:.6g} s on '{}' is not watched for pulses that are shorter than a step, nor for kinks of "
        "roots and inverse functions, since its second derivative has no close bounds there; kinks of abs, "
        "min and max are found",
        t, of.f->text()));
    return true;
  });
}

std::optional<Pulse> pulse_within(const Model& model, double h, double end) {
  std::optional<Pulse> first;
  for (const Expression* f : functions_of_time(model)) {
    int budget = kMostStretches;
    const auto t = first_pulse(*f, 0, end, h, end, kUntold * size_until(*f, end), budget);
    if (t && (!first || *t < first->t)) first = Pulse{f->text(), *t};
  }
  return first;
}

}  // namespace poinsot
