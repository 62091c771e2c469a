#include "bench/study/cost_curve.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/study/measure.h"
#include "bench/study/name_list.h"
#include "bench/study/range.h"

namespace poinsot::study {
namespace {

constexpr std::size_t kNamed = 3;  // of those that are alike; more are counted

// Accuracies a conclusion speaks of: 1e-2, 1e-4, ..., within what the reference resolves.
std::vector<double> accuracies(double floor) {
  std::vector<double> all;
  for (int k = 2; k <= 14 && std::pow(10.0, -k) >= floor; k += 2) all.push_back(std::pow(10.0, -k));
  return all;
}

// "1e-4"
std::string power(double x) {
  return fmt::format("1e-{}", std::lround(-std::log10(x)));
}

std::string times(const Range& range) {
  const std::string low = fmt::format("{:.1f}", range.low), high = fmt::format("{:.1f}", range.high);
  return low == high ? low : fmt::format("{} to {}", low, high);
}

}  // namespace

std::optional<double> CostCurve::seconds_at(double error) const {
  if (knots.empty() || error < knots.back().error) return {};
  if (error >= knots.front().error) return knots.front().seconds;
  const auto finer = std::ranges::find_if(knots, [&](const Knot& k) { return k.error <= error; });
  const Knot &a = *(finer - 1), &b = *finer;
  const double x = std::log(error / a.error) / std::log(b.error / a.error);
  return a.seconds * std::pow(b.seconds / a.seconds, x);
}

double CostCurve::spread_at(double error) const {
  const auto finer = std::ranges::find_if(knots, [&](const Knot& k) { return k.error <= error; });
  if (finer == knots.end()) return 0;
  return finer == knots.begin() ? finer->spread : std::max(finer->spread, (finer - 1)->spread);
}

std::vector<CostCurve> cost_curves(const std::vector<ChartRow>& rows, std::size_t quantity, double agreement) {
  const double floor = kResolved * agreement;
  std::vector<CostCurve> curves;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Measured& m = rows[k].measured;
    if (!m.ok() || !std::isfinite(m.error[quantity]) || !(m.seconds > 0)) continue;
    auto curve = std::ranges::find(curves, rows[k].method(), &CostCurve::method);
    if (curve == curves.end()) curve = curves.insert(curve, {rows[k].method(), {}});
    const double error = std::max({m.error[quantity], floor, std::numeric_limits<double>::min()});
    curve->knots.push_back({error, m.seconds, m.spread, k});
  }
  for (CostCurve& curve : curves) {
    std::ranges::sort(curve.knots, [](const auto& a, const auto& b) {
      return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
    });
    std::vector<CostCurve::Knot> own;
    for (const CostCurve::Knot& knot : curve.knots)
      if (own.empty() || knot.error < own.back().error) own.push_back(knot);
    curve.knots = std::move(own);
  }
  return curves;
}

std::optional<double> Standing::margin() const {
  if (alike == 0 || alike >= order.size()) return {};
  return order[alike].seconds / order.front().seconds;
}

CostCurves::CostCurves(const std::vector<ChartRow>& rows, std::size_t quantity, double agreement)
    : quantity_(quantity),
      rows_(rows.size()),
      floor_(kResolved * agreement),
      spread_(chart_spreads(rows)),
      curves_(cost_curves(rows, quantity, agreement)) {}

Standing CostCurves::at(double error) const {
  Standing standing;
  for (std::size_t k = 0; k < curves_.size(); ++k)
    if (const auto seconds = curves_[k].seconds_at(error)) standing.order.push_back({k, *seconds});
  std::ranges::sort(standing.order, {}, &Standing::Place::seconds);
  const auto spread = [&](const Standing::Place& place) { return spread_.of(curves_[place.curve].spread_at(error)); };
  while (standing.alike < standing.order.size()) {
    const Standing::Place &best = standing.order.front(), &next = standing.order[standing.alike];
    if (next.seconds > best.seconds * (1 + std::hypot(spread(best), spread(next)))) break;
    ++standing.alike;
  }
  return standing;
}

std::vector<bool> CostCurves::front() const {
  std::vector<bool> on(rows_);
  for (std::size_t k = 0; k < curves_.size(); ++k)
    for (const CostCurve::Knot& knot : curves_[k].knots) {
      if (knot.error > kUseless) continue;
      const Standing standing = at(knot.error);
      on[knot.row] = standing.clear() && standing.order.front().curve == k;
    }
  return on;
}

bool CostCurves::rounding_only() const {
  const auto rounding = [&](const CostCurve& c) { return c.knots.front().error <= floor_; };
  return !curves_.empty() && std::ranges::all_of(curves_, rounding);
}

std::string CostCurves::conclusion() const {
  if (curves_.empty()) return {};
  if (rounding_only()) return "every case is as accurate as the reference can tell: what differs is rounding";
  struct Stretch {
    double from, to;
    std::string first, next;
    Range margin;
  };
  std::vector<Stretch> stretches;
  for (const double error : accuracies(floor_)) {
    const Standing standing = at(error);
    if (standing.order.empty()) break;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < standing.alike; ++k) names.push_back(curves_[standing.order[k].curve].method);
    std::sort(names.begin() + 1, names.end());
    std::string first = names.front();
    if (names.size() > 1) first = fmt::format("{}, alike within the noise", listed(names, kNamed));
    const std::string next = standing.margin() ? curves_[standing.order[standing.alike].curve].method : "";
    if (stretches.empty() || stretches.back().first != first || stretches.back().next != next)
      stretches.push_back({error, error, first, next, {}});
    stretches.back().to = error;
    if (standing.margin()) stretches.back().margin.add(*standing.margin());
  }
  std::vector<std::string> said;
  for (const Stretch& s : stretches) {
    std::string text = s.from == s.to ? power(s.from) : fmt::format("{} to {}", power(s.from), power(s.to));
    if (said.empty()) text += fmt::format(" in {}", kQuantities[quantity_]);
    text += fmt::format(": {}", s.first);
    if (curves_.size() > 1)
      text += s.next.empty() ? ", which nothing else reaches"
                             : fmt::format(", {} times as fast as the next, {}", times(s.margin), s.next);
    said.push_back(std::move(text));
  }
  return said.empty() ? "no case comes below an error of 0.01" : fmt::format("{}", fmt::join(said, "; "));
}

}  // namespace poinsot::study
