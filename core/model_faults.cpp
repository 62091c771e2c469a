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
  constexpr double kRounding = 1e-12;  // of directions' lengths
  const double f = row.f.at(t).f;
  if (row.type == RowType::D && !row.squared) return -f;
  if (row.type != RowType::DP1) return 0;
  const double most = row.a_i.norm() * row.a_j.norm();
  return std::abs(f) - (1 + kRounding) * most;
}

}  // namespace

std::string beyond_any_position(const Model& model, double from, double to) {
  constexpr int kTimes = 32;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (row.f.is_constant()) continue;
    double within = from, later = from;
    for (int of = kTimes; of >= 0 && !(beyond(row, later) > 0); --of)
      within = later, later = from + std::ldexp(to - from, -of);
    if (!(beyond(row, later) > 0)) continue;
    for (double middle; middle = within + (later - within) / 2, within < middle && middle < later;)
      (beyond(row, middle) > 0 ? later : within) = middle;
    const bool cosine = row.type == RowType::DP1;
    return fmt::format("{} asks for a {} {} from t = {:.9g} s on", describe_row(model, static_cast<int>(k)),
                       cosine ? "cosine beyond" : "squared distance below",
                       cosine ? (row.f.at(later).f > 0 ? "1" : "-1") : "0", within);
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
