#include "integrators/start/aside_watch.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "integrators/start/violation.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr double kLost = 1e-5;  // of a body's size: far above what steps leave, far below what opens to the eye
// Of what kept rows are off, which a tolerance leaves off: rows that follow from them add them up.
constexpr double kAsKept = 100;

Eigen::Map<const Eigen::ArrayXd> as_array(std::span<const double> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

}  // namespace

std::string describe(const Apart& apart, const Model& model) {
  if (apart.row < 0) return {};
  return fmt::format(
      "{} was set aside, as it follows from other constraints, and is off those by up to {} (at t = {:.4g} s): the "
      "motion is that of the rows that are kept",
      describe_row(model, apart.row), describe_residual(model, apart.row, apart.off, 0), apart.t);
}

AsideWatch::AsideWatch(Problem& kept, const RowChoice& choice, bool to_tolerance, Apart& apart)
    : kept_(kept),
      choice_(choice),
      to_tolerance_(to_tolerance),
      apart_(apart),
      no_accelerations_(index(kept.nv())),
      now_(kept.model().bodies.size()) {
  const Model& model = kept.model();
  const std::vector<int> rows = not_said_twice(model, choice.aside(), kept.model_rows());
  if (rows.empty()) return;
  aside_.emplace(model, rows);
  for (const int row : rows) by_allowed_.push_back(1 / (kLost * choice.size_of(row)));
  const auto shows_in_rates = [](const Row& row) { return row.type == RowType::pfaffian || !row.f.is_constant(); };
  measures_rates_ = std::ranges::any_of(model.rows, shows_in_rates);
  if (measures_rates_) kept_rates_.resize(index(kept.nc()));
}

LargestResidual AsideWatch::left_out(double t) {
  if (!aside_) return {};
  if (most_ < 0) most_ = largest(aside_->position_residual(t, kept_));
  kept_.to_bodies(no_accelerations_, now_);
  return {most_, largest(aside_->velocity_residual(now_))};
}

bool AsideWatch::hold(double t) {
  if (!aside_) return true;
  const auto off = as_array(aside_->position_residual(t, kept_)).abs();
  most_ = off.maxCoeff();
  Eigen::Index worst = 0;
  const double part = (off * as_array(by_allowed_)).maxCoeff(&worst);
  if (part > apart_.part && part <= 1 && off[worst] > kAsKept * kept_off())
    apart_ = {part, aside_->rows()[index(worst)], off[worst], t};
  return part <= 1;
}

Status AsideWatch::measure(double t, std::span<const double> a) {
  if (!aside_) return {};
  const auto go_on = [&] { return measures_rates_ ? measure_rates(t, a) : Status{}; };
  if (hold(t)) return go_on();
  Eigen::Index worst = 0;
  const auto residual = as_array(aside_->position_residual(t, kept_)).abs();
  (residual * as_array(by_allowed_)).maxCoeff(&worst);
  const double off = residual[worst], kept = kept_off();
  const bool left_by_tolerance = off <= kAsKept * kept;
  if (left_by_tolerance && to_tolerance_) return go_on();
  const std::string why =
      left_by_tolerance
          ? fmt::format(
                "it follows from other constraints and was set aside, and the tolerance of Newton's method "
                "leaves those off by up to {:.2g}",
                kept)
          : std::string(
                "it followed from the other constraints where the run began and was set aside, and does not "
                "hold with them any more; the constraints contradict one another from here on, and one of "
                "them has to go, or the steps leave them");
  const int row = aside_->rows()[index(worst)];
  return with_settings({Failure::constraint_lost, t,
                        fmt::format("at t = {:.9g} s {} is violated by {}: {}", t, describe_row(kept_.model(), row),
                                    describe_residual(kept_.model(), row, off, 0), why)},
                       "try smaller steps or a smaller tolerance");
}

// By how much the rows that are kept are off at most, where they stand.
double AsideWatch::kept_off() {
  kept_positions_.resize(index(kept_.nc()));
  kept_.position_residual(kept_positions_);
  return largest(kept_positions_);
}

// m/s, by which the bodies of a row move against one another at the most.
double AsideWatch::speed_at(const Row& row) const {
  const auto move = [&](int body, const Vector3& s) -> std::pair<Vector3, double> {
    if (body == kGround) return {Vector3::Zero(), 0.0};
    const BodyState& of = now_[index(body)];
    return {of.rd, of.w.norm() * std::max(s.norm(), choice_.size_of_body(body))};
  };
  const auto [at_i, turn_i] = move(row.i, row.s_i);
  const auto [at_j, turn_j] = move(row.j, row.s_j);
  return (at_j - at_i).norm() + turn_i + turn_j;
}

// What drivers and velocity rows ask for, beside what the others are off as the method leaves them. A kink that one
// function has and another has not quite is no contradiction: it is past at the next step.
Status AsideWatch::measure_rates(double t, std::span<const double> a) {
  constexpr double kLostRate = 1e-3;  // of the bodies' speed
  constexpr double kStill = 1e-9;     // of a body's size in a second
  constexpr int kSteps = 3;           // one after the other
  kept_.to_bodies(a, now_);
  kept_.velocity_residual(kept_rates_);
  const double others = largest(kept_rates_);
  const std::span<const double> residual = aside_->velocity_residual(now_);
  int worst = -1;
  double most = 1;  // times what is allowed
  for (std::size_t k = 0; k < residual.size(); ++k) {
    const int of = aside_->rows()[k];
    const Row& row = kept_.model().rows[index(of)];
    const double size = choice_.own_size_of(of), norm = choice_.size_of(of) / size;
    const double asked = row.type == RowType::pfaffian ? row.f.at(t).f : row.f.at(t).fd;
    const double allowed =
        kLostRate * std::max(norm * speed_at(row), std::abs(asked)) + kAsKept * others + kStill * norm * size;
    if (std::abs(residual[k]) > most * allowed) worst = static_cast<int>(k), most = std::abs(residual[k]) / allowed;
  }
  lost_rates_ = worst < 0 ? 0 : lost_rates_ + 1;
  if (lost_rates_ < kSteps) return {};
  const int of = aside_->rows()[index(worst)];
  return with_remedy(
      Failure::constraint_lost, t,
      fmt::format("at t = {:.9g} s the rate of {} is off by {}: it followed from the other constraints where the run "
                  "began and was set aside, and does not hold with them any more; the constraints contradict one "
                  "another from here on",
                  t, describe_row(kept_.model(), of),
                  describe_residual(kept_.model(), of, std::abs(residual[index(worst)]), 1)),
      "one of them has to go");
}

}  // namespace poinsot
