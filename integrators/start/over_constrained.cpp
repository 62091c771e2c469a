#include "integrators/start/over_constrained.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "integrators/start/violation.h"

namespace poinsot {
namespace {

constexpr double kLookedAgain = 1;      // rad, at the latest
constexpr double kShrunk = 0.05;        // of the longest step since the last look: steps may creep up to worn rows
constexpr double kLost = 1e-5;          // of a body's size: far above what steps leave, far below what opens to the eye
constexpr double kWorthTelling = 0.01;  // of that: what is said twice differs by more than its rounding
// Of what kept rows are off, which a tolerance leaves off: rows that follow from them add them up.
constexpr double kAsKept = 100;

Eigen::Map<const Eigen::ArrayXd> as_array(std::span<const double> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

}  // namespace

OverConstrained::OverConstrained(std::unique_ptr<Problem> kept, const std::shared_ptr<const Model>& model,
                                 const RankAnalysis& rank, std::span<const BodyState> states, Steps steps)
    : choice_(std::make_shared<Choice>(Choice{RowChoice(model, rank.loops, rank.aside, steps),
                                              0,
                                              {states.begin(), states.end()},
                                              {.part = kWorthTelling}})),
      kept_(std::move(kept)),
      to_tolerance_(steps == Steps::of_kinematics),
      now_(states.begin(), states.end()) {
  choice_->rows.look(0, states);
  // Where very many rows are redundant the analysis of rank leaves the others independent, but not as much as can be.
  // In a singular position it does so beside it, and here they are not.
  if (!rank.singular_position() && choice_->rows.worn() && choice_->rows.renew(0, states, HUGE_VAL, 0))
    kept_ = kept_->clone_without(choice_->rows.aside());
  bodies_ = kept_->bodies();
  nq_ = kept_->nq(), nv_ = kept_->nv(), nc_ = kept_->nc();
  no_accelerations_.resize(index(nv_));
  watch();
}

OverConstrained::OverConstrained(const OverConstrained& other)
    : Problem(other),
      choice_(other.choice_),
      kept_revision_(other.kept_revision_),
      kept_(other.kept_->clone()),
      to_tolerance_(other.to_tolerance_),
      t_(other.t_),
      accepted_at_(other.accepted_at_),
      way_(other.way_),
      ahead_(other.ahead_),
      now_(other.now_),
      no_accelerations_(other.no_accelerations_) {
  watch();
}

std::unique_ptr<Problem> OverConstrained::clone() const {
  return std::unique_ptr<Problem>(new OverConstrained(*this));
}

std::vector<Undetermined> OverConstrained::undetermined(double t, std::span<const BodyState> states) const {
  RowChoice& rows = choice_->rows;
  const std::vector<SparseEntries> null_vectors = rows.null_vectors(t, states);
  return undetermined_by(null_vectors, false, model(), rows.space(), states);
}

void OverConstrained::keep() {
  kept_ = kept_->clone_without(choice_->rows.aside());
  kept_revision_ = choice_->revision;
  watch();
}

void OverConstrained::watch() {
  const std::vector<int> rows = not_said_twice(model(), choice_->rows.aside(), model_rows());
  aside_.reset();
  if (!rows.empty()) aside_.emplace(model(), rows);
  most_aside_ = -1;
  by_allowed_.clear();
  for (const int row : rows) by_allowed_.push_back(1 / (kLost * choice_->rows.size_of(row)));
  const auto shows_in_rates = [](const Row& row) { return row.type == RowType::pfaffian || !row.f.is_constant(); };
  rates_aside_ = !rows.empty() && std::ranges::any_of(model().rows, shows_in_rates);
  kept_rates_.resize(rates_aside_ ? index(kept_->nc()) : 0);
}

void OverConstrained::set_position(double t, std::span<const double> q) {
  if (kept_revision_ != choice_->revision) keep();
  kept_->set_position(t, q);
  t_ = t;
  most_aside_ = -1;
}

Problem::LeftOut OverConstrained::left_out() const {
  const auto largest = [](std::span<const double> residual) {
    double most = 0;
    for (const double off : residual) most = std::max(most, std::abs(off));
    return most;
  };
  if (!aside_) return {};
  if (most_aside_ < 0) most_aside_ = largest(aside_->position_residual(t_, *kept_));
  kept_->to_bodies(no_accelerations_, now_);
  return {most_aside_, largest(aside_->velocity_residual(now_))};
}

bool OverConstrained::hold(double t) {
  const auto off = as_array(aside_->position_residual(t, *kept_)).abs();
  most_aside_ = off.maxCoeff();
  Eigen::Index worst = 0;
  const double part = (off * as_array(by_allowed_)).maxCoeff(&worst);
  Apart& apart = choice_->apart;
  if (part > apart.part && part <= 1 && off[worst] > kAsKept * kept_off())
    apart = {part, aside_->rows()[index(worst)], off[worst], t};
  return part <= 1;
}

std::string OverConstrained::apart() const {
  const Apart& at = choice_->apart;
  if (at.row < 0) return {};
  return fmt::format(
      "{} was set aside, as it follows from other constraints, and is off those by up to {} (at t = {:.4g} s): the "
      "motion is that of the rows that are kept",
      describe_row(model(), at.row), describe_residual(model(), at.row, at.off, 0), at.t);
}

Status OverConstrained::measure(double t, std::span<const double> a) {
  if (!aside_) return {};
  const auto go_on = [&] { return rates_aside_ ? measure_rates(t, a) : Status{}; };
  if (hold(t)) return go_on();
  Eigen::Index worst = 0;
  const auto residual = as_array(aside_->position_residual(t, *kept_)).abs();
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
                        fmt::format("at t = {:.9g} s {} is violated by {}: {}", t, describe_row(model(), row),
                                    describe_residual(model(), row, off, 0), why)},
                       "try smaller steps or a smaller tolerance");
}

// By how much the rows that are kept are off at most, where they stand.
double OverConstrained::kept_off() {
  kept_positions_.resize(index(kept_->nc()));
  kept_->position_residual(kept_positions_);
  double most = 0;
  for (const double off : kept_positions_) most = std::max(most, std::abs(off));
  return most;
}

// m/s, by which the bodies of a row move against one another at the most.
double OverConstrained::speed_at(const Row& row) const {
  const auto move = [&](int body, const Vector3& s) -> std::pair<Vector3, double> {
    if (body == kGround) return {Vector3::Zero(), 0.0};
    const BodyState& of = now_[index(body)];
    return {of.rd, of.w.norm() * std::max(s.norm(), choice_->rows.size_of_body(body))};
  };
  const auto [at_i, turn_i] = move(row.i, row.s_i);
  const auto [at_j, turn_j] = move(row.j, row.s_j);
  return (at_j - at_i).norm() + turn_i + turn_j;
}

// What drivers and velocity rows ask for, beside what the others are off as the method leaves them. A kink that one
// function has and another has not quite is no contradiction: it is past at the next step.
Status OverConstrained::measure_rates(double t, std::span<const double> a) {
  constexpr double kLostRate = 1e-3;  // of the bodies' speed
  constexpr double kStill = 1e-9;     // of a body's size in a second
  constexpr int kSteps = 3;           // one after the other
  kept_->to_bodies(a, now_);
  kept_->velocity_residual(kept_rates_);
  double others = 0;
  for (const double off : kept_rates_) others = std::max(others, std::abs(off));
  const std::span<const double> residual = aside_->velocity_residual(now_);
  int worst = -1;
  double most = 1;  // times what is allowed
  for (std::size_t k = 0; k < residual.size(); ++k) {
    const int of = aside_->rows()[k];
    const Row& row = model().rows[index(of)];
    const double size = choice_->rows.own_size_of(of), norm = choice_->rows.size_of(of) / size;
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
                  t, describe_row(model(), of), describe_residual(model(), of, std::abs(residual[index(worst)]), 1)),
      "one of them has to go");
}

// Since the choice was looked at, rad: by the body that has turned most.
double OverConstrained::turned() const {
  double most = 0;
  for (std::size_t b = 0; b < now_.size(); ++b) most = std::max(most, (now_[b].A - choice_->at[b].A).squaredNorm());
  return 2 * std::asin(std::min(std::sqrt(most / 8), 1.0));  // |A − B|² = 8 sin²(angle/2)
}

OverConstrained::Way OverConstrained::way_to(double t) const {
  const double h = std::max(t - accepted_at_, 0.0), ahead = h * kept_->fastest_turn();
  return {t, h, ahead, way_ + std::max(ahead, ahead_)};
}

// Whether the choice of rows is, at the end of it.
bool OverConstrained::is_looked_at(const Way& way) const {
  const bool creeps = way.h > 0 && way.h < kShrunk * longest_;
  return creeps || way.done + way.ahead >= std::min(choice_->rows.good_for(), kLookedAgain);
}

void OverConstrained::go(const Way& way) {
  accepted_at_ = way.t;
  way_ = way.done;
  ahead_ = way.ahead;
  longest_ = std::max(longest_, way.h);
}

bool OverConstrained::accepts_as_is(double t, std::span<const double> a) {
  const Way way = way_to(t);
  if (rates_aside_ || is_looked_at(way) || !kept_->accepts_as_is(t, a) || (aside_ && !hold(t))) return false;
  go(way);
  return true;
}

Status OverConstrained::accept(double t, std::span<double> q, std::span<double> v, std::span<double> a,
                               std::span<double> lambda, bool& rewritten) {
  if (Status status = kept_->accept(t, q, v, a, lambda, rewritten); !status.ok()) return status;
  if (rewritten) {
    kept_->set_position(t, q);
    kept_->set_velocity(v);
  }
  if (Status status = measure(t, a); !status.ok()) return status;
  Way way = way_to(t);
  go(way);
  if (!is_looked_at(way)) return {};
  kept_->to_bodies(a, now_);
  way_ = way.done = turned();
  if (!is_looked_at(way)) return {};
  longest_ = way.h;
  const bool others = choice_->rows.renew(t, now_, std::exchange(way_, 0.0), way.ahead);
  choice_->at = now_;
  if (!others) return {};
  rewritten = true;
  exchange(t, q, v, lambda);
  return {};
}

bool OverConstrained::choose_rows_here(double t, std::span<const double> q, std::span<const double> v,
                                       std::span<double> lambda) {
  kept_->to_bodies(no_accelerations_, now_);
  const bool others = choice_->rows.renew(t_, now_, HUGE_VAL, 0, true);
  choice_->at = now_;
  way_ = 0;
  set_position(t, q);
  set_velocity(v);
  if (others) exchange(t, q, v, lambda);
  return others;
}

// Other rows, and the multipliers that are the same forces.
void OverConstrained::exchange(double t, std::span<const double> q, std::span<const double> v,
                               std::span<double> lambda) {
  std::vector<double> forces(index(nv_)), by_row(model().rows.size(), 0.0);
  const bool wanted = !lambda.empty();  // kinematics may do without
  if (wanted) {
    kept_->constraint_forces(lambda, forces);
    const std::vector<int>& before = kept_->model_rows();
    for (std::size_t k = 0; k < before.size(); ++k) by_row[index(before[k])] = lambda[k];
  }
  ++choice_->revision;
  keep();
  kept_->set_position(t, q);
  kept_->set_velocity(v);
  if (!wanted) return;
  choice_->rows.carry_over(by_row);
  const std::vector<int>& after = kept_->model_rows();
  for (std::size_t k = 0; k < after.size(); ++k) lambda[k] = by_row[index(after[k])];
  normalize(forces, lambda);
}

// The multipliers of rp's normalization rows, one for each body: along them what the rows do is left open by the
// motions that the choice of rows is made for.
void OverConstrained::normalize(std::span<const double> forces, std::span<double> lambda) {
  const std::size_t rows = kept_->model_rows().size(), bodies = lambda.size() - rows;
  if (bodies == 0) return;
  const std::size_t per_body = forces.size() / bodies;
  std::vector<double> now(forces.size()), normal(forces.size()), ones(lambda.size(), 0.0);
  std::ranges::fill(std::span(ones).subspan(rows), 1.0);
  kept_->constraint_forces(lambda, now);
  kept_->constraint_forces(ones, normal);
  for (std::size_t b = 0; b < bodies; ++b) {
    double missing = 0, size = 0;
    for (std::size_t k = b * per_body; k < (b + 1) * per_body; ++k) {
      missing += (forces[k] - now[k]) * normal[k];
      size += normal[k] * normal[k];
    }
    lambda[rows + b] += missing / size;
  }
}

}  // namespace poinsot
