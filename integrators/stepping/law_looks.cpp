#include "integrators/stepping/law_looks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/bounds.h"
#include "integrators/stepping/table_knots.h"

namespace poinsot {
namespace {

constexpr int kLawPartings = 12;                                                  // of a step
constexpr int kLawPieces = 300, kFewPieces = 30;                                  // of one look
constexpr int kTowardsEntry = 8;                                                  // towards where F comes to more
constexpr double kBeyondSeen = 2;                                                 // of the range that is seen
constexpr int kShownPlaces = 4;                                                   // that stages do not miss
constexpr double kLookedAt[] = {0, 0.11, 0.23, 0.36, 0.49, 0.63, 0.77, 0.89, 1};  // no period goes with them

// What F comes to at the ends of a step and at several places of it, widened to either side.
class SeenForce {
 public:
  SeenForce(Bounds values, double nothing) : values_(values), nothing_(nothing) {}
  void add(double F) { values_ = hull(values_, {F, F}); }
  bool holds(Bounds F) const {
    const double beyond = kBeyondSeen * (values_.most - values_.least) + nothing_;
    return !(F.least < values_.least - beyond) && !(F.most > values_.most + beyond);
  }

 private:
  Bounds values_;
  double nothing_;
};

// Where F comes to what is not seen, about: shortly after `from`, where it is, or before `to`, where it is not. In the
// middle of it a force may have no direction.
template <class Force, class Seen>
double entry_into(const Force& force, Seen&& seen, double from, double to) {
  for (int k = 0; k < kTowardsEntry; ++k) {
    const double middle = from + 0.5 * (to - from);
    (seen(middle, force(middle)) ? from : to) = middle;
  }
  return to;
}

// Where F at `middle` is not seen.
UnseenForce unseen_at(const LawPath& path, const SeenForce& seen, double from, double middle) {
  const auto holds = [&](double, double F) { return seen.holds({F, F}); };
  const auto force = [&](double s) { return path.force(s); };
  if (holds(middle, force(middle))) return {};
  return {entry_into(force, holds, from, middle), true};
}

// The step is halved where bounds are not close, what comes first before what comes later.
UnseenForce first_in_part(const LawPath& path, const SeenForce& seen, double from, double to, int partings,
                          int& pieces) {
  if (seen.holds(path.close_force(from, to))) return {};
  const double middle = from + 0.5 * (to - from);
  if (const UnseenForce here = unseen_at(path, seen, from, middle); here.known) return here;
  if (partings == 0 || --pieces < 0) return {from, false};
  const UnseenForce sooner = first_in_part(path, seen, from, middle, partings - 1, pieces);
  return sooner.s < 1 ? sooner : first_in_part(path, seen, middle, to, partings - 1, pieces);
}

// What is long before what is short: bounds that are close nowhere do not keep the rest from being looked at.
UnseenForce known_in_parts(const LawPath& path, const SeenForce& seen) {
  struct Part {
    double from, to;
  };
  std::array<Part, kFewPieces + 1> parts;
  std::size_t end = 0;
  parts[end++] = {0, 1};
  for (std::size_t k = 0; k < end; ++k) {
    const auto [from, to] = parts[k];
    if (seen.holds(path.close_force(from, to))) continue;
    const double middle = from + 0.5 * (to - from);
    if (const UnseenForce here = unseen_at(path, seen, from, middle); here.known) return here;
    if (end + 2 > parts.size()) continue;
    parts[end++] = {from, middle};
    parts[end++] = {middle, to};
  }
  return {};
}

}  // namespace

namespace {

// Hermite's cubic, what the ends and the slopes there lead to.
double led_to(const LawEnds& ends, double s) {
  const double r = 1 - s;
  return r * r * ((1 + 2 * s) * ends.from.f + s * ends.from.fd) + s * s * ((1 + 2 * r) * ends.to.f - r * ends.to.fd);
}

// Where F is off that by more than `much`; at the places it is as given.
template <class Force>
UnseenForce first_off(const Force& force, const LawEnds& ends, std::span<const double> places,
                      std::span<const double> there, double much) {
  const auto led = [&](double s, double F) { return !(std::abs(F - led_to(ends, s)) > much); };
  for (std::size_t k = 0; k < places.size(); ++k)
    if (!led(places[k], there[k])) return {entry_into(force, led, k == 0 ? 0 : places[k - 1], places[k]), true};
  return {};
}

// F at places of the step, and the range with its ends.
template <std::size_t n, class Force>
double look_at(const Force& force, const LawEnds& ends, const double (&places)[n], std::array<double, n>& there) {
  std::ranges::transform(places, there.begin(), force);
  const auto [least, most] = std::ranges::minmax(there);
  const Bounds range = ends.range();
  return std::max(most, range.most) - std::min(least, range.least);
}

}  // namespace

namespace {

// By look(seen), where F as a whole may come to more.
template <class Look>
UnseenForce look_for_unseen(const LawPath& path, const LawEnds& ends, double nothing, Look&& look) {
  SeenForce seen(ends.range(), nothing);
  if (seen.holds(path.force(0, 1))) return {};
  std::array<double, std::size(kLookedAt)> there;
  std::ranges::transform(kLookedAt, there.begin(), [&](double s) { return path.force(s); });
  std::ranges::sort(there);
  seen.add(there[kShownPlaces - 1]), seen.add(there[there.size() - kShownPlaces]);
  return look(seen);
}

}  // namespace

UnseenForce first_unseen(const LawPath& path, const LawEnds& ends, double nothing) {
  return look_for_unseen(path, ends, nothing, [&](const SeenForce& seen) {
    int pieces = kLawPieces;
    return first_in_part(path, seen, 0, 1, kLawPartings, pieces);
  });
}

UnseenForce first_known(const LawPath& path, const LawEnds& ends, double nothing) {
  return look_for_unseen(path, ends, nothing, [&](const SeenForce& seen) { return known_in_parts(path, seen); });
}

UnseenForce first_between(const LawPath& path, const LawEnds& ends, double nothing) {
  constexpr double kOff = 0.35;  // of the range, more than a kink is
  const auto force = [&](double s) { return path.force(s); };
  std::array<double, std::size(kLookedAt)> there;
  const double range = look_at(force, ends, kLookedAt, there);
  return first_off(force, ends, kLookedAt, there, std::max(kOff * range, nothing));
}

UnseenForce first_steep(const LawPath& path, const LawEnds& still, double nothing) {
  constexpr double kPlaces[] = {0.3, 0.5, 0.7}, kBetween[] = {0.12, 0.88};
  constexpr double kOff = 1e-3, kFar = 0.2;  // of the range
  const LawEnds ends = path.moves() ? LawEnds{path.moving_along(0), path.moving_along(1)} : still;
  const auto force = [&](double s) { return path.moving_along(s).f; };
  std::array<double, std::size(kPlaces)> there, off;
  const double range = look_at(force, ends, kPlaces, there), much = std::max(kOff * range, nothing);
  for (std::size_t k = 0; k < off.size(); ++k) off[k] = there[k] - led_to(ends, kPlaces[k]);
  if (std::ranges::none_of(off, [&](double x) { return std::abs(x) > much; })) return {};
  // The polynomial is the cubic + s² (1 − s)² q(s).
  const auto weight = [](double s) { return s * s * (1 - s) * (1 - s); };
  for (std::size_t k = 0; k < off.size(); ++k) off[k] /= weight(kPlaces[k]);
  const auto by_polynomial = [&](double s) {
    const double x = (s - kPlaces[1]) / (kPlaces[2] - kPlaces[1]);
    const double q = off[1] + 0.5 * x * (off[2] - off[0] + x * (off[0] - 2 * off[1] + off[2]));
    return led_to(ends, s) + weight(s) * q;
  };
  const auto is_off = [&](double s) { return std::abs(force(s) - by_polynomial(s)) > much; };
  if (std::ranges::none_of(kBetween, is_off)) return {};
  const UnseenForce far = first_off(force, ends, kPlaces, there, std::max(kFar * range, nothing));
  return {std::min(far.s, 0.5), true};
}

double first_table_knot(const LawPath& path, double nothing) {
  return first_knot([&](double at, std::span<int> out) { path.cubics(at, out); },
                    [&](double at) { return path.along(at).fd; }, nothing);
}

}  // namespace poinsot
