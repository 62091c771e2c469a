#include "integrators/stepping/step_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/mechanisms.h"

namespace poinsot {
namespace {

constexpr double kSmallestError = 1e-4;  // below this an error says nothing about the next step
constexpr double kSmallestPredicted = 1e-2;

double length(std::span<const double> x) {
  double sum = 0;
  for (double e : x) sum += e * e;
  return std::sqrt(sum);
}

// Σ (x/s)²
double squared(std::span<const double> x, std::span<const double> scale) {
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double e = x[k] / scale[k];
    sum += e * e;
  }
  return sum;
}

// What methods say of a step that is tried again: no words, which are allocated.
std::string unsaid(Failure failure) {
  switch (failure) {
    case Failure::singular_position:
      return "velocities or accelerations jumped beside a singular position, to where rounding would lead";
    case Failure::rotation_too_large:
      return "a body turned further than can be followed";
    case Failure::inconsistent_state:
      return "the step led too far from the constraints to be projected onto them";
    default:
      return "Newton's method did not converge";
  }
}

}  // namespace

void component_sizes(const Problem& problem, std::span<const double> q, std::span<const double> v,
                     std::span<double> sizes) {
  const std::size_t nb = static_cast<std::size_t>(problem.bodies()), nv = v.size();
  const std::size_t q_body = nb ? q.size() / nb : 0, v_body = nb ? nv / nb : 0;
  for (std::size_t b = 0; b < nb; ++b) {
    const std::size_t at = b * v_body;
    std::fill_n(sizes.begin() + static_cast<std::ptrdiff_t>(at), 3, length(q.subspan(b * q_body, 3)));
    std::fill_n(sizes.begin() + static_cast<std::ptrdiff_t>(at + 3), v_body - 3, 1.0);
    std::fill_n(sizes.begin() + static_cast<std::ptrdiff_t>(nv + at), 3, length(v.subspan(at, 3)));
    std::fill_n(sizes.begin() + static_cast<std::ptrdiff_t>(nv + at + 3), v_body - 3,
                length(v.subspan(at + 3, v_body - 3)));
  }
}

ErrorNorm::ErrorNorm(const Problem& problem) : mechanism_(mechanisms(problem.model())) {
  parts_.resize(mechanism_count(mechanism_));
  const std::size_t per_body = mechanism_.empty() ? 0 : index(2 * problem.nv()) / mechanism_.size();
  for (const int of : mechanism_) parts_[index(of)].components += per_body;
}

double ErrorNorm::operator()(std::span<const double> x, std::span<const double> scale) {
  if (parts_.size() < 2) return std::sqrt(squared(x, scale) / static_cast<double>(std::max<std::size_t>(x.size(), 1)));
  const std::size_t nv = x.size() / 2, per_body = nv / mechanism_.size();
  for (Part& of : parts_) of.sum = 0;
  for (std::size_t b = 0; b < mechanism_.size(); ++b) {
    Part& of = parts_[index(mechanism_[b])];
    for (const std::size_t at : {b * per_body, nv + b * per_body})
      of.sum += squared(x.subspan(at, per_body), scale.subspan(at, per_body));
  }
  double most = 0;
  for (const Part& of : parts_) {
    const double mean = of.sum / static_cast<double>(of.components);
    if (!(mean <= most)) most = mean;  // NaN stays
    if (std::isnan(mean)) break;
  }
  return std::sqrt(most);
}

double StepController::accepted(double h, double error) {
  double factor = rule_.safety * std::pow(error, -rule_.alpha) * std::pow(before_, rule_.beta);
  if (rule_.predictive) {
    if (h_before_ > 0) {
      factor = std::min(factor, rule_.safety * h / h_before_ * std::pow(before_ / (error * error), rule_.alpha));
    }
    h_before_ = h;
  }
  before_ = std::max(error, rule_.predictive ? kSmallestPredicted : kSmallestError);
  // error 0 makes the factor infinite, which the clamp makes the largest growth
  const double grow = after_rejection_ ? 1.0 : rule_.grow;
  after_rejection_ = false;
  return h * std::clamp(factor, rule_.shrink, grow);
}

double StepController::rejected(double h, double error) {
  after_rejection_ = true;
  return h * std::clamp(rule_.safety * std::pow(error, -rule_.alpha), rule_.shrink, 1.0);
}

double StepController::failed(double h) {
  after_rejection_ = true;
  return h * rule_.shrink;
}

double first_trial(double y, double f, double end) {
  const double h = y > 1e-5 && f > 1e-5 ? 0.01 * y / f : 1e-6 * end;
  return std::min(h, end);
}

double first_step(double h0, double f, double second, int order, double end) {
  const double rate = std::max(f, second);
  const double h1 = rate > 1e-15 ? std::pow(0.01 / rate, 1.0 / order) : std::max(1e-6 * end, 1e-3 * h0);
  return std::min({100 * h0, h1, end});
}

Status step_too_small(double t, double h, const Status& cause) {
  std::string last;
  if (!cause.ok()) {
    Status attempt = cause;
    attempt.withdraw_remedy();  // of steps of a given length
    last = "; the last attempt: " + (attempt.message.empty() ? unsaid(attempt.failure) : attempt.message);
  }
  return {Failure::step_size_too_small, t,
          fmt::format("at t = {:.9g} s the steps became too small to get on with ({:.3g} s){}", t, h, last)};
}

Status singular_sample(double t, const std::string& row) {
  return with_remedy(
      Failure::singular_position, t,
      fmt::format("at t = {:.9g} s, an output time, the mechanism is in a singular position{}, where the constraints "
                  "leave velocities and accelerations to rounding: they cannot be given out",
                  t, row.empty() ? "" : " (singular here: " + row + ")"),
      "take output times beside it");
}

}  // namespace poinsot
