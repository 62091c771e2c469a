#include "integrators/stepping/index1_output.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kOfNoAccount = 1e-7;
constexpr double kExplained = 100;  // so many times its estimate rounding may be: the steps add it up
constexpr double kOfSteps = 4;      // and that of positions, which constraints hold

double apart(std::span<const double> x, std::span<const double> y) {
  double m = 0;
  for (std::size_t k = 0; k < x.size(); ++k) m = std::max(m, std::abs(x[k] - y[k]));
  return m;
}

}  // namespace

const State& Index1Output::choose(Problem& problem, const State& at, double scale, bool last,
                                  const Eigen::VectorXd* began, Statistics& statistics) {
  const double rounding = std::numeric_limits<double>::epsilon() * largest(span(at.q)) / scale;
  const double size = std::max(largest(at.a()), problem.model().gravity.norm());
  const bool rounded = size > 0 && rounding > kOfNoAccount * size;
  if ((!rounded && !last && !began) || !solve(problem, at)) return at;
  const bool other = began && is_of_another_kind(problem, at, *began);
  AccelerationError& error = statistics.acceleration_error.emplace();
  error.acceleration = apart(at.a(), found_->a());
  error.multiplier = apart(at.lambda(), found_->lambda());
  if (other) error.index = 1;
  if (!rounded || error.acceleration > kExplained * rounding) return other ? *found_ : at;
  // One step of refinement moves them by about their rounding.
  const Eigen::VectorXd before = found_->z;
  if (!consistent_->refine(*found_).ok()) return at;
  error.index = 1;
  error.acceleration = apart({before.data(), at.a().size()}, found_->a());
  error.multiplier = apart({before.data() + at.a().size(), at.lambda().size()}, found_->lambda());
  add_rounding_of_state(problem, kOfSteps * std::numeric_limits<double>::epsilon() * largest(span(at.q)), error);
  return *found_;
}

void Index1Output::add_rounding_of_state(Problem& problem, double rounding, AccelerationError& error) {
  const Eigen::Index nv = problem.nv(), nc = problem.nc(), per_body = nv / problem.bodies();
  const double t = found_->t;
  Eigen::VectorXd move = Eigen::VectorXd::Zero(nv + nc);
  problem.velocity_residual(span(move, nv, nc));
  move = -move;
  if (!consistent_->solve(t, span(move)).ok()) return;
  State beside = *found_;
  beside.v += move.head(nv);
  std::minstd_rand random(1);
  for (Eigen::Index k = 0; k < nv; ++k) move[k] = k % per_body < 3 ? (random() % 2 == 0 ? rounding : -rounding) : 0.0;
  problem.retract(span(found_->q), span(move, 0, nv), span(beside.q));
  consistent_->stand(beside);
  if (consistent_->refine(beside).ok()) {
    error.acceleration += apart(beside.a(), found_->a());
    error.multiplier += apart(beside.lambda(), found_->lambda());
  }
  consistent_->stand(*found_);
}

// Of a₁ where found_ stands. Velocities are off the constraints by h, and the same constraint written otherwise makes
// another γ of that: taken, and left in found_, is a₁ of the nearest they allow.
bool Index1Output::is_of_another_kind(Problem& problem, const State& at, const Eigen::VectorXd& began) {
  constexpr double kFarther = 3;
  as_it_is_ = found_->z;
  const bool solved = consistent_->correct_velocity(at.t, span(found_->v)).ok() &&
                      consistent_->accelerations(at.t, span(found_->z)).ok();
  found_->v = at.v;
  consistent_->stand(at);
  one_.resize(index(problem.bodies()));
  other_.resize(one_.size());
  const auto farther = [&](std::span<const double> a) {
    problem.to_bodies(a, one_);
    problem.to_bodies(found_->a(), other_);
    double most = 0;
    for (std::size_t b = 0; b < one_.size(); ++b)
      most = std::max({most, (one_[b].rdd - other_[b].rdd).norm(), (one_[b].wd - other_[b].wd).norm()});
    return most;
  };
  if (solved && farther(at.a()) > kFarther * farther({began.data(), at.a().size()})) return true;
  found_->z = as_it_is_;
  return false;
}

// Where the matrix is singular there is nothing to compare with.
bool Index1Output::solve(Problem& problem, const State& at) {
  if (of_ != &problem) {
    of_ = &problem;
    consistent_.emplace(problem, choice_);
  }
  if (!found_) found_.emplace(problem);
  *found_ = at;
  return consistent_->accelerations(at.t, span(found_->z)).ok();
}

}  // namespace poinsot
