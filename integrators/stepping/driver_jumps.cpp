#include "integrators/stepping/driver_jumps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/switch_times.h"

namespace poinsot {
namespace {

constexpr double kLeastStretch = 1e-10;  // of the run, as switches are resolved (switch_times.h)
constexpr double kLeastJump = 1e-9;      // relative, or of 1
constexpr double kNoChange = 1e-6;       // in the shortest stretch: no jump

double least_jump(double f) {
  return kLeastJump * std::max(1.0, std::abs(f));
}

}  // namespace

DriverJumps::DriverJumps(const Model& model, double end)
    : model_(model), shortest_(kLeastStretch * end), lengths_(model, end) {
  const auto add = [&](const Expression& f, std::size_t row) {
    if (f.is_constant() || f.is_function()) return;
    const Jet2<Bounds> over = f.range({{0, end}, Bounds::unknown(), Bounds::unknown()});
    if (may_jump(f) || !(shortest_ * over.fd.size() <= kNoChange))
      functions_.push_back({&f, static_cast<int>(row), value(f, 0)});
  };
  for (std::size_t row = 0; row < model.rows.size(); ++row) {
    const Row& of = model.rows[row];
    if (of.type == RowType::pfaffian) continue;  // prescribes velocities, which may jump
    add(of.f, row);
    if (of.alternate) add(of.alternate->f, row);
  }
}

DriverJumps::Value DriverJumps::value(const Expression& f, double t) {
  const auto at = f.at(t);
  return {t, at.f, at.fd};
}

Status DriverJumps::look(double to) {
  if (!(to > looked_to_)) return {};
  looked_to_ = to;
  for (Function& of : functions_) {
    const Value next = value(*of.f, to);
    if (!next.is_finite()) continue;  // seen from both sides
    Value from = std::exchange(of.at, next);
    if (jumps(*of.f, from, of.at)) return jump_of_positions(from.t, describe_row(model_, of.row));
  }
  return lengths_.look(to);
}

// `from` is moved to where it does.
bool DriverJumps::jumps(const Expression& f, Value& from, Value to) const {
  constexpr double kStays = 0.8;  // a root leaves 0.71
  constexpr double kOffMiddle = 0.45;
  const auto off = [](const Value& a, const Value& b) {
    const double rate = std::abs(a.fd) < std::abs(b.fd) ? a.fd : b.fd;  // of an end that does not lie in the jump
    return std::abs(b.f - a.f - (b.t - a.t) * rate);
  };
  double before = off(from, to);
  while (before > least_jump(from.f)) {
    const double middle = from.t + (to.t - from.t) / 2;
    if (to.t - from.t <= shortest_ || !(from.t < middle && middle < to.t))
      return std::abs(to.f - from.f) > least_jump(from.f);
    Value at = value(f, middle);
    if (!at.is_finite()) at = value(f, from.t + kOffMiddle * (to.t - from.t));
    const double first = off(from, at), second = off(at, to), larger = std::max(first, second);
    if (!(larger > kStays * before)) return false;
    (second > first ? from : to) = at;
    before = larger;
  }
  return false;
}

}  // namespace poinsot
