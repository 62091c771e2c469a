#include "integrators/methods/prescribed_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/counted.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// A matrix of a position before is made anew where corrections shrink by less than this.
constexpr double kSlow = 0.1;
// So far from its prediction a body may as well be turned over: a hinge holds with its axis reversed, too, and no sign
// of a determinant tells. In coordinates of orientation.
constexpr double kFarOff = 0.25;
// Corrections as small as this need not shrink any more: near a singular position, at worst, it is what rounding
// leaves.
constexpr double kRoundingAtWorst = 1e-7, kShrinksNoMore = 0.9;
constexpr double kStandsStill = 1e-10;  // by a first correction: no motion to be uncertain of
constexpr int kMostSharpenings = 3;

}  // namespace

// (auto answers this hint with klu or dense, which know determinants' signs)
PrescribedState::PrescribedState(const Run& run, PhaseClock& clock)
    : run_(run),
      problem_(run.problem),
      settings_(run.settings),
      refresh_(jacobians().require(settings_.jacobian).refresh),
      system_(problem_, run.systems.add(Workload::transposed), MatrixKind::kinematic, run.statistics, clock),
      delta_(problem_.nc()),
      q_next_(problem_.nq()),
      v_before_(problem_.nv()) {}

Status PrescribedState::find(double t, double tolerance, bool carefully, State& x, Vector& beyond) {
  if (Status status = find_position(t, tolerance, carefully, x, beyond); !status.ok()) return status;
  return find_rates(t, x);
}

bool PrescribedState::sharpen(double t, double tolerance, State& x, Vector& beyond) {
  const std::uint64_t orientation = system_.orientation();
  for (int k = 0; k < kMostSharpenings; ++k) {
    const double before = last_;
    v_before_ = x.v;
    problem_.position_residual(span(delta_));
    if (!solve(t).ok()) return false;
    correct(x, beyond);
    if (!(last_ < std::max(before, kRoundingAtWorst)) || !find_rates(t, x).ok()) return false;
    if (system_.orientation() != orientation) return false;
    // Newton's method leaves half the square of what a correction came to.
    const double change = (x.v - v_before_).norm() / x.v.norm();
    if (!(0.5 * change * change > tolerance)) return true;
  }
  return true;
}

// The correction of Φ in delta_, by the matrix that there is.
Status PrescribedState::solve(double t) {
  delta_ = -delta_;
  if (Status status = system_.solve(t, span(delta_)); !status.ok()) return status;  // (14d)
  last_ = delta_.norm();
  return {};
}

void PrescribedState::correct(State& x, Vector& beyond) {
  problem_.retract(span(x.q), span(delta_), span(q_next_));  // (14a), (12)
  beyond += delta_;
  x.q.swap(q_next_);
  ++run_.statistics.newton_iterations;
}

Status PrescribedState::find_position(double t, double tolerance, bool carefully, State& x, Vector& beyond) {
  double first = 0;
  contraction_ = 0;
  slow_ = false;
  for (int k = 0; k < settings_.max_iterations; ++k) {
    problem_.set_position(t, span(x.q));
    problem_.position_residual(span(delta_));
    // Where a matrix of a position before serves too little to be certain of a step, its parts have their own.
    const bool fresh = (carefully && slow_) || due(refresh_, k, carefully || slow_ || !system_.ready());
    if (fresh) {
      if (Status status = refresh(t); !status.ok()) return status;
    }
    const double before = last_;
    if (Status status = solve(t); !status.ok()) return status;
    correct(x, beyond);
    const double correction = last_;
    slow_ = k > 0 && !(correction < kSlow * before);
    if (k == 0) {
      // Beside a singular position corrections are as large as can be, and what they shrink by says nothing.
      first = correction;
      if (first > 1 && first > std::sqrt(problem_.bodies()) * std::max(1.0, x.q.cwiseAbs().maxCoeff()))
        contraction_ = INFINITY;
      if (first > kFarOff && largest_turn() > kFarOff) contraction_ = INFINITY;
    }
    if (k == 1 && first > kStandsStill) contraction_ = std::max(contraction_, correction / first);
    if (correction < tolerance) return {};
    if (carefully && k > 1 && correction > kShrinksNoMore * before && correction < kRoundingAtWorst) return {};
  }
  Eigen::Index largest = 0;
  delta_.cwiseAbs().maxCoeff(&largest);
  return with_settings(
      {Failure::not_converged, t,
       fmt::format(
           "at t = {:.9g} s the position did not converge: after {} the correction is {:.3g}, the tolerance "
           "{:.3g}; {} moves most; the mechanism may be locked here or the driver ask for more than it can reach",
           t, counted(settings_.max_iterations, "iteration"), last_, settings_.tolerance,
           problem_.describe_unknown(static_cast<int>(largest)))},
      "try more iterations or a larger tolerance");
}

// Of a body, by a correction.
double PrescribedState::largest_turn() const {
  const Eigen::Index bodies = problem_.bodies(), size = problem_.nv() / bodies;
  return delta_.head(problem_.nv()).reshaped(size, bodies).bottomRows(size - 3).colwise().norm().maxCoeff();
}

Status PrescribedState::find_rates(double t, State& x) {
  problem_.set_position(t, span(x.q));
  if (Status status = refresh(t); !status.ok()) return status;
  problem_.nu(span(x.v));
  if (Status status = system_.solve(t, span(x.v)); !status.ok()) return status;  // (15b)
  problem_.set_velocity(span(x.v));
  problem_.gamma(x.a());
  return system_.solve(t, x.a());  // (16)
}

}  // namespace poinsot
