#include "core/model_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace poinsot {
namespace {

std::string of_row(const Row& row, double t) {
  const int derivatives = row.type == RowType::pfaffian ? 1 : 2;
  if (std::string what = row.f.fault(t, derivatives); !what.empty()) return what;
  if (const double length = row.f.at(t).f; row.squared && !(length > 0))
    return fmt::format("the length '{}' is {:.9g} m, expected a positive one", row.f.text(), length);
  return row.alternate ? row.alternate->f.fault(t, derivatives) : "";
}

template <class Load>
std::string of_loads(const std::vector<Load>& loads, Expression (Load::*components)[3], double t) {
  for (const Load& load : loads)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::string what = (load.*components)[k].fault(t, 0); !what.empty())
        return fault_sentence(t, fmt::format("force '{}', component {}", load.name, "xyz"[k]), what);
  return {};
}

// By how much f(t) lies beyond what any position has; up to 0 within.
double beyond(const Row& row, double t) {
  const double rounding = row.f.is_constant() ? 1e-9 : 1e-12;  // of directions' lengths and of a number as written
  const double f = row.f.at(t).f;
  if (row.type == RowType::D && !row.squared) return -f;
  if (row.type != RowType::DP1) return 0;
  const double most = row.a_i.norm() * row.a_j.norm();
  return std::abs(f) - (1 + rounding) * most;
}

// Where in [from, to] |g| is largest, as far as numbers tell; the last time with a value, where some have none.
template <class Function>
double place_of_largest(const Function& g, double from, double to) {
  constexpr int kParts = 32, kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const double part = (to - from) / kParts;
    double most = -1, at = from;
    for (int k = 0; k <= kParts; ++k) {
      const double t = from + k * part, size = std::abs(g(t));
      if (!std::isfinite(size)) {
        at = t;
        break;
      }
      if (size > most) most = size, at = t;
    }
    const double lower = std::max(from, at - part);
    to = std::min(to, at + part), from = lower;
  }
  return from + (to - from) / 2;
}

// Whether |g| grows towards c by a factor in each of many halvings of the time that is left.
template <class Function>
bool grows_towards(const Function& g, double c) {
  constexpr double kFactor = 1.3;  // a root's rate has 1.41
  constexpr int kFirst = 6, kLast = 26;
  for (int k = kFirst; k < kLast; ++k) {
    const double before = std::abs(g(c - std::ldexp(c, -k))), next = std::abs(g(c - std::ldexp(c, -k - 1)));
    if (!(before > 0 && next > kFactor * before)) return false;
  }
  return true;
}

// Of f and its rates up to a derivative, what grows without bound.
std::string unbounded(const Expression& f, int derivatives, double from, double to) {
  if (f.is_constant()) return {};
  constexpr const char* kWhich[] = {"", "the first derivative of ", "the second derivative of "};
  for (int k = 0; k <= derivatives; ++k) {
    const auto g = [&](double t) {
      const Jet2<double> at = f.at(t);
      return k == 0 ? at.f : k == 1 ? at.fd : at.fdd;
    };
    const double c = place_of_largest(g, from, to);
    if (c > 0 && grows_towards(g, c))
      return fmt::format("{}'{}' grows without bound towards t = {:.9g} s", kWhich[k], f.text(), c);
  }
  return {};
}

}  // namespace

std::string growing_without_bound(const Model& model, double from, double to) {
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (const std::string what = unbounded(row.f, row.type == RowType::pfaffian ? 1 : 2, from, to); !what.empty())
      return fmt::format("{}: {}", describe_row(model, static_cast<int>(k)), what);
  }
  const auto of = [&](const auto& loads, auto components) -> std::string {
    for (const auto& load : loads)
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::string what = unbounded((load.*components)[k], 0, from, to); !what.empty())
          return fmt::format("force '{}', component {}: {}", load.name, "xyz"[k], what);
    return {};
  };
  const std::string of_forces = of(model.point_forces, &PointForce::force);
  return of_forces.empty() ? of(model.torques, &Torque::torque) : of_forces;
}

std::string beyond_any_position(const Model& model, double from, double to) {
  constexpr int kTimes = 32;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    double within = from, later = from;
    for (int of = kTimes; of >= 0 && !(beyond(row, later) > 0); --of)
      within = later, later = from + std::ldexp(to - from, -of);
    if (!(beyond(row, later) > 0)) continue;
    for (double middle; middle = within + (later - within) / 2, within < middle && middle < later;)
      (beyond(row, middle) > 0 ? later : within) = middle;
    const bool cosine = row.type == RowType::DP1;
    return fmt::format("{} asks for a {} {}{}", describe_row(model, static_cast<int>(k)),
                       cosine ? "cosine beyond" : "squared distance below",
                       cosine ? (row.f.at(later).f > 0 ? "1" : "-1") : "0",
                       row.f.is_constant() ? "" : fmt::format(" from t = {:.9g} s on", within));
  }
  return {};
}

std::string faster_than_times(const Model& model, double from, double to, double end) {
  constexpr double kTold = 0.1;  // rad
  const double between = std::nextafter(end, HUGE_VAL) - end;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (row.type != RowType::angle) continue;
    const double rate = std::max(std::abs(row.f.at(from).fd), std::abs(row.f.at(to).fd));
    if (rate * between > kTold)
      return fmt::format("{} turns at {:.3g} rad/s, by {:.2g} rad from one time to the next that numbers tell apart",
                         describe_row(model, static_cast<int>(k)), rate, rate * between);
  }
  return {};
}

std::string fault_of_functions(const Model& model, double t) {
  for (std::size_t row = 0; row < model.rows.size(); ++row)
    if (const std::string what = of_row(model.rows[row], t); !what.empty())
      return fault_sentence(t, describe_row(model, static_cast<int>(row)), what);
  const std::string of_forces = of_loads(model.point_forces, &PointForce::force, t);
  return of_forces.empty() ? of_loads(model.torques, &Torque::torque, t) : of_forces;
}

std::string fault_sentence(double t, const std::string& whose, const std::string& what) {
  return fmt::format("at t = {:.9g} s {}: {}", t, whose, what);
}

Status no_value(double t, const std::string& fault) {
  return with_remedy(Failure::not_finite, t, fault,
                     t > 0 ? "end the run before, or change the function"
                           : "the run begins there: change the function, or write (t + T) for t to begin at T");
}

}  // namespace poinsot
