#include "integrators/stepping/switch_times.h"

#include <algorithm>
#include <cmath>

namespace poinsot {
namespace {

constexpr int kBudget = 4000;  // stretches looked at in one search: functions that rounding makes noise are left then

int side(double x) {
  return (x > 0) - (x < 0);
}

bool on_a_switch(std::span<const double> x) {
  return std::ranges::find(x, 0.0) != x.end();
}

bool same_sides(std::span<const double> x, std::span<const double> y) {
  return std::ranges::equal(x, y, [](double a, double b) { return side(a) == side(b); });
}

}  // namespace

SwitchTimes::SwitchTimes(const Model& model, double end) : resolution_(kResolved * end), instant_(kInstant * end) {
  const auto add = [&](const Expression& f) {
    const auto count = static_cast<std::size_t>(f.switch_count());
    if (count > 0) switching_.push_back({&f, std::vector<double>(count), std::vector<double>(count)});
  };
  for (const Row& row : model.rows) {
    add(row.f);
    if (row.alternate) add(row.alternate->f);
  }
  for (const PointForce& force : model.point_forces)
    for (const Expression& f : force.force) add(f);
  for (const Torque& torque : model.torques)
    for (const Expression& f : torque.torque) add(f);
}

SwitchTimes::Switch SwitchTimes::first(double t, double to) {
  if (switching_.empty()) return {};
  if (found_.after <= t) {  // passed; what rounding makes of it just beyond is no other
    clear_to_ = found_.after + resolution_;
    found_ = {};
  }
  if (found_.before > to && clear_to_ < to) {
    const double from = std::max(t, clear_to_);
    int budget = kBudget;
    for (Switching& of : switching_) {
      const Switch sooner = find(of, from, std::min(to, found_.before), budget);
      if (sooner.before < found_.before) found_ = sooner;
    }
    clear_to_ = std::min(to, found_.before);
  }
  return found_.before <= to ? found_ : Switch{};
}

SwitchTimes::Switch SwitchTimes::find(Switching& of, double from, double to, int& budget) {
  if (!(from < to) || !of.f->may_switch(from, to)) return {};
  const double middle = from + (to - from) / 2;
  if (to - from <= resolution_ || --budget < 0 || !(from < middle && middle < to)) return between(of, from, to);
  const Switch sooner = find(of, from, middle, budget);
  return sooner.before <= to ? sooner : find(of, middle, to, budget);
}

// By bisection, down to neighbouring times; none where both ends are on the same sides.
SwitchTimes::Switch SwitchTimes::between(Switching& of, double from, double to) {
  of.f->switches(from, of.at_start);
  if (from > 0 && on_a_switch(of.at_start)) {
    from = std::nextafter(from, 0);
    of.f->switches(from, of.at_start);
  }
  of.f->switches(to, of.at_end);
  if (same_sides(of.at_start, of.at_end)) return {};
  for (double middle; middle = from + (to - from) / 2, from < middle && middle < to && to - from > instant_;) {
    of.f->switches(middle, of.at_end);
    (same_sides(of.at_start, of.at_end) ? from : to) = middle;
  }
  of.f->switches(to, of.at_end);
  if (on_a_switch(of.at_end)) {  // neither side: one further is beyond
    to = std::nextafter(to, HUGE_VAL);
    of.f->switches(to, of.at_end);
    if (same_sides(of.at_start, of.at_end)) return {};  // touched
  }
  return {from, to};
}

}  // namespace poinsot
