#include "integrators/stepping/consistent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "integrators/stepping/position_rows.h"
#include "integrators/stepping/switch_times.h"
#include "integrators/stepping/vectors.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

constexpr int kFarCorrections = 30;
constexpr double kFarNegligible = 1e-14;  // relative to the largest coordinate: rounding
constexpr double kMostCurved = 1e9;       // 1 over what is left of a row that counts as independent (kDependent)

constexpr int kCorrections = 6;
constexpr double kRounding = 1e-15;  // product of two corrections that leaves nothing to correct
constexpr double kJump = 1e-9;       // relative to the largest coordinate: more than rounding of a time leads to
// A correction of this size is the rounding of the coordinates; relative to the largest one, where that is large.
constexpr double kNegligible = 1e-14, kRoundingOfLargest = 8 * std::numeric_limits<double>::epsilon();
// Relative to velocities. Where the gradient of a row vanishes its position is known to √ε only, and G v = ν to so
// much: a correction of a hundredth for what is off by less is made of rounding.
constexpr double kUnseen = 1e-7, kOther = 0.01;

}  // namespace

Consistent::Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock)
    : Consistent(problem, linear, statistics, clock, nullptr) {}

Consistent::Consistent(Problem& problem, const LinearChoice& choice)
    : Consistent(problem, std::make_unique<Aside>(Aside{LinearSystem(choice), {}, {}})) {}

Consistent::Consistent(Problem& problem, std::unique_ptr<Aside>&& aside)
    : Consistent(problem, aside->linear, aside->statistics, aside->clock, std::move(aside)) {}

Consistent::Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock,
                       std::unique_ptr<Aside>&& aside)
    : problem_(problem),
      aside_(std::move(aside)),
      system_(problem, linear, MatrixKind::consistent, statistics, clock),
      has_velocity_rows_(!velocity_rows(problem).empty()),
      parts_(problem),
      branches_(parts_.count()),
      nv_(static_cast<std::size_t>(problem.nv())),
      nc_(static_cast<std::size_t>(problem.nc())),
      rhs_(problem.nv() + problem.nc()),
      zeros_(Eigen::VectorXd::Zero(problem.nv() + problem.nc())),
      rows_(problem.nc()),
      q_moved_(problem.nq()),
      moved_by_(Eigen::VectorXd::Zero(2 * problem.nv())) {
  for (Eigen::VectorXd* x : {&calm_v_, &approach_a_, &last_a_}) x->setZero(problem.nv());
  off_by_one_.setZero(problem.nv() + problem.nc());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.5, 1);
  for (Eigen::Index k = problem.nv(); k < off_by_one_.size(); ++k) off_by_one_[k] = uniform(random);
}

Consistent::~Consistent() = default;

Status Consistent::prepare() {
  Status status = system_.prepare();
  prepared_ = status.ok();
  return status;
}

Status Consistent::factor(double t, Ahead ahead) {
  if (!prepared_) {
    if (Status status = prepare(); !status.ok()) return status;
  }
  const std::span<const double> zeros = span(zeros_);
  return system_.refresh(t, {}, {}, zeros.first(nv_), zeros.subspan(nv_), ahead);
}

Status Consistent::accelerations(double t, std::span<double> z) {
  const std::span<const double> zeros = span(zeros_);
  problem_.equations_of_motion(zeros.first(nv_), {}, z.first(nv_));
  for (double& x : z.first(nv_)) x = -x;
  problem_.gamma(z.subspan(nv_));
  if (Status status = factor(t, {z}); !status.ok()) return status;
  return system_.solve(t, z);
}

Status Consistent::position_correction(double t) {
  std::ranges::fill(moves(), 0.0);
  problem_.position_residual(rows());
  off_ = largest(rows());
  for (double& x : rows()) x = -x;
  return system_.solve(t, span(rhs_));
}

Status Consistent::velocity_correction(double t) {
  std::ranges::fill(moves(), 0.0);
  problem_.velocity_residual(rows());
  off_ = largest(rows());
  for (double& x : rows()) x = -x;
  return system_.solve(t, span(rhs_));
}

Status Consistent::project_position(double t, std::span<double> q, std::span<double> moved) {
  if (!has_velocity_rows_) return onto_positions(t, q, moved, HUGE_VAL);
  if (Status status = onto_position_rows(t, q, moved); !status.ok()) return status;
  problem_.set_velocity(std::span<const double>(span(zeros_)).first(nv_));
  return factor(t);
}

Status Consistent::onto_position_rows(double t, std::span<double> q, std::span<double> moved) {
  if (!position_rows_ || !position_rows_->are_those_of(problem_))
    position_rows_ = std::make_unique<PositionRows>(problem_);
  const Status status = position_rows_->project_position(t, q, moved);
  problem_.set_position(t, q);
  return status;
}

Status Consistent::onto_positions(double t, std::span<double> q, std::span<double> moved, double before) {
  for (int k = 0; k < kFarCorrections; ++k) {
    problem_.set_position(t, q);
    problem_.set_velocity(std::span<const double>(span(zeros_)).first(nv_));
    if (Status status = factor(t); !status.ok()) return status;
    if (Status status = position_correction(t); !status.ok()) return status;
    const double correction = largest(moves());
    if (!std::isfinite(correction)) break;
    problem_.retract(q, moves(), span(q_moved_));
    std::ranges::copy(q_moved_, q.begin());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += moves()[i];
    problem_.set_position(t, q);
    // Quadratic convergence: done where the correction is rounding, or has stopped to shrink at a small size, or the
    // next one would be rounding: as many times the square of this one as this one is of the one before, of the first
    // as many as rows can make of it that are hardly independent.
    const double scale = std::max(1.0, largest(q));
    const double times = std::isinf(before) ? kMostCurved : correction / (before * before);
    if (correction <= kFarNegligible * scale || (k > 0 && correction < 1e-9 * scale && correction >= 0.5 * before))
      return {};
    if (correction < 1e-9 * scale && times * correction * correction <= kFarNegligible * scale) return {};
    before = correction;
  }
  return {Failure::inconsistent_state, t, {}};  // who asks knows what for
}

double Consistent::draw_near(double t, std::span<double> q) {
  if (!system_.ready()) return HUGE_VAL;
  constexpr int kMost = 8;
  constexpr double kShrinks = 0.1;
  const std::vector<double> from(q.begin(), q.end());
  double first = 0, before = HUGE_VAL;
  for (int k = 0; k < kMost; ++k) {
    problem_.set_position(t, q);
    const bool solved = position_correction(t).ok();
    const double correction = solved ? largest(moves()) : HUGE_VAL;
    if (!(correction < kShrinks * before)) {
      if (before < kShrinks * first) break;  // as near as rounding lets it
      std::ranges::copy(from, q.begin());
      return HUGE_VAL;
    }
    problem_.retract(q, moves(), span(q_moved_));
    std::ranges::copy(q_moved_, q.begin());
    // One correction from there leaves nothing (project_position).
    const double enough = std::sqrt(kFarNegligible * std::max(1.0, largest(q)) / kMostCurved);
    const bool near = correction * (k == 0 ? 1 : correction / before) <= enough;
    if (k == 0) first = correction;
    before = correction;
    if (near) break;
  }
  return before;
}

Status Consistent::project_velocity(double t, std::span<double> v) {
  if (Status status = factor(t); !status.ok()) return status;
  return correct_velocity(t, v);
}

Status Consistent::correct_velocity(double t, std::span<double> v) {
  for (int k = 0; k < 2; ++k) {  // the second pass takes out the rounding of large corrections
    if (Status status = velocity_correction(t); !status.ok()) return status;
    for (std::size_t i = 0; i < nv_; ++i) v[i] += moves()[i];
    problem_.set_velocity(v);
  }
  return {};
}

void Consistent::stand(const State& at) {
  problem_.set_position(at.t, span(at.q));
  problem_.set_velocity(span(at.v));
}

Status Consistent::accelerations(State& at) {
  stand(at);
  return accelerations(at.t, span(at.z));
}

Status Consistent::project(State& at, bool& moved) {
  moved = false;
  moved_by_.setZero();
  double first = 0, before = HUGE_VAL;
  const double rounding = std::max(kNegligible, kRoundingOfLargest * largest(span(at.q)));
  for (int k = 0;; ++k) {
    if (Status status = position_correction(at.t); !status.ok()) return status;
    const double correction = largest(moves());
    if (k == 0 && correction <= rounding) break;
    if (k == 0 && usual_steepness_ > 0 && correction > kSteep * usual_steepness_ * off_) {
      look(steepness(at.t));
      if (has_velocity_rows_) {
        if (Status status = onto_position_rows(at.t, span(at.q), span(moved_by_, 0, problem_.nv())); !status.ok())
          return status;
        stand(at);
        moved = true;
        first = largest(span(moved_by_));
        break;
      }
      if (Status status = position_correction(at.t); !status.ok()) return status;
    }
    if (k == kCorrections || !(correction < before)) {
      return {Failure::inconsistent_state, at.t, {}};
    }
    problem_.retract(span(at.q), moves(), span(q_moved_));
    at.q.swap(q_moved_);
    moved_by_.head(problem_.nv()) += rhs_.head(problem_.nv());
    stand(at);
    moved = true;
    first = std::max(first, correction);
    if (first * correction * amplification_ <= kRounding || correction <= rounding) break;
    before = correction;
  }
  for (int k = 0; k < kCorrections; ++k) {
    if (Status status = velocity_correction(at.t); !status.ok()) return status;
    const double correction = largest(moves()), speed = std::max(1.0, largest(span(at.v)));
    if (correction <= kNegligible * speed) break;
    if (off_ <= kUnseen * speed && correction > kOther * speed) return {Failure::singular_position, at.t, {}};
    at.v += rhs_.head(problem_.nv());
    moved_by_.tail(problem_.nv()) += rhs_.head(problem_.nv());
    problem_.set_velocity(span(at.v));
    moved = true;
    if (first * correction * amplification_ <= kRounding) break;
  }
  return {};
}

Status Consistent::along_constraints(const State& at, std::span<double> x) {
  problem_.set_velocity(x);
  problem_.velocity_residual(rows());
  problem_.set_velocity(span(at.v));
  problem_.nu(span(rows_));
  for (std::size_t k = 0; k < nc_; ++k) rows()[k] = -rows()[k] - span(rows_)[k];
  std::ranges::fill(moves(), 0.0);
  if (Status status = system_.solve(at.t, span(rhs_)); !status.ok()) return status;
  for (std::size_t k = 0; k < nv_; ++k) x[k] += moves()[k];
  return {};
}

void Consistent::residual(const State& at, std::span<double> out) {
  problem_.equations_of_motion(at.a(), at.lambda(), out.first(nv_));
  const std::span<double> rows = out.subspan(nv_);
  problem_.set_velocity(at.a());
  problem_.velocity_residual(rows);  // G a − ν
  problem_.set_velocity(span(at.v));
  problem_.nu(span(rows_));
  for (std::size_t k = 0; k < nc_; ++k) rows[k] += span(rows_)[k];
  problem_.gamma(span(rows_));
  for (std::size_t k = 0; k < nc_; ++k) rows[k] -= span(rows_)[k];
}

Status Consistent::refine(State& at) {
  residual(at, span(rhs_));
  if (Status status = system_.solve(at.t, span(rhs_)); !status.ok()) return status;
  at.z -= rhs_;
  return {};
}

Status Consistent::complete(State& at) {
  if (Status status = accelerations(at); !status.ok()) return status;
  bool moved = false;
  if (Status status = project(at, moved); !status.ok()) return status;
  return moved ? refine(at) : Status{};
}

void Consistent::lead(State& at, double t) {
  const double h = t - at.t;
  const auto a = at.z.head(problem_.nv());
  rhs_.head(problem_.nv()) = h * (at.v + 0.5 * h * a);
  problem_.retract(span(at.q), moves(), span(q_moved_));
  at.q = q_moved_;
  at.v += h * a;
  at.t = t;
}

Status Consistent::cross(State& at, double t) {
  forget_approach();
  lead(at, t);
  if (Status status = accelerations(at); !status.ok()) return status;
  problem_.position_residual(rows());
  const auto jumping = std::ranges::max_element(rows(), {}, [](double x) { return std::abs(x); }) - rows().begin();
  bool moved = false;
  const Status status = project(at, moved);
  if (!status.ok() || largest(span(moved_by_, 0, problem_.nv())) > kJump * std::max(1.0, largest(span(at.q)))) {
    const int row = problem_.model_rows()[static_cast<std::size_t>(jumping)];
    if (problem_.model().rows[static_cast<std::size_t>(row)].f.is_constant()) return singular_switch(at.t);
    return jump_of_positions(at.t, problem_.describe_unknown(problem_.nv() + static_cast<int>(jumping)));
  }
  return moved ? accelerations(at) : Status{};  // velocities may have jumped: no refinement of those before
}

}  // namespace poinsot
