#include "integrators/stepping/newton_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/counted.h"
#include "formulations/gradient.h"

namespace poinsot {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double rounding_of(const Problem& problem, const Eigen::VectorXd& q) {
  return 16 * kEpsilon * std::sqrt(problem.bodies()) * std::max(1.0, q.cwiseAbs().maxCoeff());
}

// NaN where one of them is, which passes no comparison with a bound.
double max_norm(const auto& x) {
  double most = 0;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double size = std::abs(x[k]);
    if (size <= most) continue;
    if (std::isnan(size)) return size;
    most = size;
  }
  return most;
}

// |r|² + arm² |x|² of one body.
double squared_size(const double* body, Eigen::Index turns, double arm_squared) {
  double of_x = 0;
  for (Eigen::Index k = 3; k < 3 + turns; ++k) of_x += body[k] * body[k];
  return body[0] * body[0] + body[1] * body[1] + body[2] * body[2] + arm_squared * of_x;
}

}  // namespace

NewtonLoop::NewtonLoop(Problem& problem, StepSystem& system, const Settings& settings, Refresh refresh,
                       Statistics& statistics, bool divides)
    : problem_(problem),
      system_(system),
      settings_(settings),
      refresh_(refresh),
      stopping_(stopping_tests().require(settings.stopping).test),
      statistics_(statistics),
      divided_(divides && settings.retry),
      arm_(longest_arm(problem.model())),
      delta_(problem.nv() + problem.nc()),
      momentum_(problem.nv()),
      rows_(problem.nv() + problem.nc()) {}

double NewtonLoop::relative(const Vector& z, bool of_this_step) {
  const Eigen::Index nv = problem_.nv(), per_body = nv / problem_.bodies(), turns = per_body - 3;
  const double turn = arm_ * arm_;
  double most = 0, all = 0, sum = 0;
  for (Eigen::Index b = 0; b < nv; b += per_body) {
    const double of = squared_size(delta_.data() + b, turns, turn);
    most = std::max(most, of);
    all += of;
    sum += squared_size(z.data() + b, turns, turn);
  }
  if (!std::isfinite(all)) return all;
  constexpr double kLeast = 1e-150;  // where nothing is accelerated there is no size; and no quotient overflows
  const double size = std::max({std::sqrt(sum / problem_.bodies()), problem_.model().gravity.norm(), kLeast});
  moved_ = std::sqrt(most);
  const double accelerations = moved_ / size;
  if (of_this_step) return accelerations;
  const double multipliers = max_norm(delta_.tail(problem_.nc()));
  return multipliers == 0 ? accelerations
                          : std::max(accelerations, multipliers / std::max(max_norm(z.tail(problem_.nc())), kLeast));
}

bool NewtonLoop::is_rounding(double t, double position, const Vector& q) {
  const double moved = position * max_norm(delta_.head(problem_.nv()));
  if (moved <= rounding_of(problem_, q)) return true;
  if (!(moved <= kFar * std::min(1.0, arm_))) return false;  // however steep: there may be no solution at all
  return moved <= 64 * kEpsilon * std::max(1.0, max_norm(q)) * steepness(t, position);
}

// How far rows that are off by one move positions, by the matrix at hand; 0 where that is not known.
double NewtonLoop::steepness(double t, double position) {
  rows_.setZero();
  for (Eigen::Index k = problem_.nv(); k < rows_.size(); ++k) rows_[k] = 1 / position;
  return system_.solve(t, span(rows_)).ok() ? position * max_norm(rows_.head(problem_.nv())) : 0;
}

void NewtonLoop::measure_gradient() {
  Vector sums = Vector::Zero(problem_.nv());
  for_each_entry_of_gradient(problem_, [&](int, int col, double value) { sums[col] += std::abs(value); });
  gradient_ = max_norm(sums);
}

// The residual is in delta_.
bool NewtonLoop::balanced(double position, const Vector& z, const Vector& q) {
  if (!(position * max_norm(delta_.tail(problem_.nc())) <= rounding_of(problem_, q))) return false;
  problem_.momentum(span(z).first(index(problem_.nv())), span(momentum_));
  return max_norm(delta_.head(problem_.nv())) <=
         256 * kEpsilon * (max_norm(momentum_) + gradient_ * max_norm(z.tail(problem_.nc())));
}

// `off`: of Φ in the units of the step, before the last correction.
Status NewtonLoop::not_converged(double t, double correction, double position, double off) const {
  const std::string try_first = divided_ ? "try an integrator with error control" : "try a smaller step";
  const auto by_size = [](double x) { return std::isfinite(x) ? std::abs(x) : HUGE_VAL; };
  const auto largest = std::ranges::max_element(delta_, {}, by_size) - delta_.begin();
  if (!std::isfinite(correction)) {
    return with_settings({Failure::not_finite, t,
                          fmt::format("at t = {:.9g} s Newton's correction of {} is not finite", t,
                                      problem_.describe_unknown(static_cast<int>(largest)))},
                         try_first);
  }
  if (correction <= settings_.tolerance) {  // beside accelerations that have grown
    const bool moves = moved_ * position > kFar * arm_;
    return with_settings(
        {Failure::not_converged, t,
         fmt::format(
             "at t = {:.9g} s Newton's method did not converge: after {} it still {} {:.3g}{}, small as that is "
             "beside the accelerations it has come to; the largest correction is that of {}",
             t, counted(settings_.max_iterations, "iteration"),
             moves ? "moves a body by" : "leaves constraints off by up to", (moves ? moved_ : off) * position,
             moves ? " m" : "", problem_.describe_unknown(static_cast<int>(largest)))},
        try_first);
  }
  // Corrections that do not come near ask for another step or matrix, whatever they are compared with.
  constexpr int kFew = 10;
  constexpr double kNear = 1e4, kClose = 0.01;
  std::string others;
  if (settings_.jacobian != "exact") others += ", the exact jacobian";
  const bool near = correction < kNear * settings_.tolerance &&
                    (stopping_ == Stopping::correction || correction < std::max(kClose, settings_.tolerance));
  if (settings_.max_iterations < kFew || near) others += ", more iterations or a larger tolerance";
  return with_settings(
      {Failure::not_converged, t,
       fmt::format("at t = {:.9g} s Newton's method did not converge: after {} the correction is {:.3g}, "
                   "the tolerance {:.3g}; the largest correction is that of {}",
                   t, counted(settings_.max_iterations, "iteration"), correction, settings_.tolerance,
                   problem_.describe_unknown(static_cast<int>(largest)))},
      try_first + others);
}

}  // namespace poinsot
