#include "integrators/stepping/index1_output.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace poinsot {
namespace {

constexpr double kOfNoAccount = 1e-7;
constexpr double kExplained = 100;  // so many times its estimate rounding may be: the steps add it up

double apart(std::span<const double> x, std::span<const double> y) {
  double m = 0;
  for (std::size_t k = 0; k < x.size(); ++k) m = std::max(m, std::abs(x[k] - y[k]));
  return m;
}

}  // namespace

const State& Index1Output::choose(Problem& problem, const State& at, double scale, bool last, Statistics& statistics) {
  const double rounding = std::numeric_limits<double>::epsilon() * largest(span(at.q)) / scale;
  const double size = std::max(largest(at.a()), problem.model().gravity.norm());
  const bool rounded = size > 0 && rounding > kOfNoAccount * size;
  if ((!rounded && !last) || !solve(problem, at)) return at;
  AccelerationError& error = statistics.acceleration_error.emplace();
  error.acceleration = apart(at.a(), found_->a());
  error.multiplier = apart(at.lambda(), found_->lambda());
  if (!rounded || error.acceleration > kExplained * rounding) return at;
  // One step of refinement moves them by about their rounding.
  const Eigen::VectorXd before = found_->z;
  if (!consistent_->refine(*found_).ok()) return at;
  error.index = 1;
  error.acceleration = apart({before.data(), at.a().size()}, found_->a());
  error.multiplier = apart({before.data() + at.a().size(), at.lambda().size()}, found_->lambda());
  return *found_;
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
