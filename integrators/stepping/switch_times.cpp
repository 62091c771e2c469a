#include "integrators/stepping/switch_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/functions_of_time.h"

namespace poinsot {
namespace {

constexpr int kBudget = 4000;  // stretches looked at in one search of one switch

Arguments<Bounds> over(double from, double to) {
  return {{from, to}, Bounds::unknown(), Bounds::unknown()};
}

}  // namespace

SwitchTimes::SwitchTimes(const Model& model, double end, Tell tell)
    : resolution_(kResolved * end), instant_(kInstant * end), tell_(std::move(tell)) {
  for (const Expression* f : functions_of_time(model)) {
    const int count = f->switch_count();
    for (int k = 0; k < count; ++k) switching_.push_back({f, k, kBudget, false});
    values_.resize(std::max(values_.size(), static_cast<std::size_t>(count)));
  }
}

SwitchTimes::Switch SwitchTimes::first(double t, double to) {
  if (switching_.empty()) return {};
  if (found_.after <= t) {  // passed; what rounding makes of it just beyond is no other
    clear_to_ = found_.after + resolution_;
    found_ = {};
  }
  if (found_.before > to && clear_to_ < to) {
    const double from = std::max(t, clear_to_);
    const Switching* first = nullptr;
    for (Switching& of : switching_) {
      of.budget = kBudget;
      const Switch sooner = find(of, from, std::min(to, found_.before));
      if (sooner.before < found_.before && sooner.before <= to) found_ = sooner, first = &of;
    }
    // Others so near that no step leads from one to the next are crossed with it.
    if (first)
      for (Switching& of : switching_)
        if (&of != first)
          found_.after = std::max(found_.after, last_after(of, found_.after, found_.after + resolution_));
    clear_to_ = std::min(to, found_.before);
  }
  return found_.before <= to ? found_ : Switch{};
}

// `from`, or beyond a switch up to `to`.
double SwitchTimes::last_after(Switching& of, double from, double to) {
  of.budget = kBudget;
  const Switch next = find(of, from, to);
  return next.before <= to ? next.after : from;
}

SwitchTimes::Switch SwitchTimes::find(Switching& of, double from, double to) {
  if (!(from < to) || !of.f->switch_range(of.k, over(from, to)).straddles_zero()) return {};
  const double middle = from + (to - from) / 2;
  if (to - from <= resolution_ || !(from < middle && middle < to)) return between(of, from, to);
  if (rests(of, from, to)) {
    if (of.f->switch_jumps(of.k))
      say(of, "has a sign or a step of what is zero up to rounding, which decides its value; move it off zero", from);
    return {};
  }
  if (--of.budget < 0) {
    say(of, "is searched for kinks and jumps at some times only, since its bounds are too wide to tell more", from);
    return between(of, from, to);
  }
  const Switch sooner = find(of, from, middle);
  return sooner.before <= to ? sooner : find(of, middle, to);
}

// By bisection, down to neighbouring times; none where it is on the same side a little before and a little beyond.
SwitchTimes::Switch SwitchTimes::between(const Switching& of, double from, double to) {
  const auto on_a_side = [](Side x) { return x == Side::below || x == Side::above; };
  const double begin = from;
  if (from > 0 && !on_a_side(side(of, from))) from = std::max(from - resolution_, 0.0);
  if (!on_a_side(side(of, to))) to += resolution_;
  const Side one = side(of, from), other = side(of, to);
  if (one == other || other == Side::undecided) return {};
  const auto beyond = [&](double t) {  // of what rests, where rounding does not reach any more
    return one == Side::undecided ? side(of, t) == other : computed_side(of, t) != one;
  };
  for (double middle; middle = from + (to - from) / 2, from < middle && middle < to && to - from > instant_;)
    (beyond(middle) ? to : from) = middle;
  // At zero it is on neither side; rounding may make it zero at several times in a row.
  for (double next = std::nextafter(to, HUGE_VAL) - to; computed_side(of, to) == Side::on && next < resolution_;
       next *= 2)
    to += next;
  if (to <= begin) return {};                                 // behind
  if (from - begin < kLeastStep * resolution_) from = begin;  // no step leads there
  return {from, to};
}

SwitchTimes::Side SwitchTimes::side(const Switching& of, double t) const {
  const Bounds x = of.f->switch_range(of.k, over(t, t));
  if (x.straddles_zero()) return Side::undecided;
  return x.least > 0 ? Side::above : x.most < 0 ? Side::below : Side::on;
}

SwitchTimes::Side SwitchTimes::computed_side(const Switching& of, double t) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  of.f->switches({t, unknown, unknown}, values_);
  const double x = values_[static_cast<std::size_t>(of.k)];
  return x > 0 ? Side::above : x < 0 ? Side::below : Side::on;
}

bool SwitchTimes::rests(const Switching& of, double from, double to) const {
  return std::ranges::all_of(std::initializer_list<double>{0.07, 0.31, 0.53, 0.79, 0.94},
                             [&](double share) { return side(of, from + share * (to - from)) == Side::undecided; });
}

void SwitchTimes::say(Switching& of, const char* what, double t) const {
  if (tell_ && !std::exchange(of.told, true)) tell_(fmt::format("about t = {:.6g} s '{}' {}", t, of.f->text(), what));
}

bool may_jump(const Expression& f) {
  for (int k = 0; k < f.switch_count(); ++k)
    if (f.switch_jumps(k)) return true;
  return false;
}

PositionJump first_jump(const Model& model, double end) {
  constexpr double kJump = 1e-9;  // relative, or of 1: more than rounding of a time leads to
  struct Prescribed {
    const Expression* f;
    int row;
  };
  std::vector<Prescribed> prescribed;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (row.type == RowType::pfaffian) continue;
    if (may_jump(row.f)) prescribed.push_back({&row.f, static_cast<int>(k)});
    if (row.alternate && may_jump(row.alternate->f)) prescribed.push_back({&row.alternate->f, static_cast<int>(k)});
  }
  if (prescribed.empty()) return {};
  SwitchTimes times(model, end);
  for (SwitchTimes::Switch at = times.first(0, end); at.before < end; at = times.first(at.after, end)) {
    for (const auto& [f, row] : prescribed) {
      const double before = f->at(at.before).f, after = f->at(at.after).f;
      if (at.before > 0 && std::abs(after - before) > kJump * std::max(1.0, std::abs(before))) return {at.before, row};
    }
  }
  return {};
}

Status jump_of_positions(double t, std::string_view what) {
  return with_remedy(Failure::inconsistent_state, t,
                     fmt::format("at t = {:.9g} s {} prescribes a jump of positions, which no motion follows", t, what),
                     "let it pass through the values between");
}

Status singular_switch(double t) {
  return {Failure::singular_position, t,
          fmt::format("at t = {:.9g} s a force or a driver has a kink or a jump where the mechanism is in a singular "
                      "position, or all but: what it does on the other side is left to rounding",
                      t)};
}

}  // namespace poinsot
