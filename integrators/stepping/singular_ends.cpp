#include "integrators/stepping/singular_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// Whether M a + Gᵀλ and Q of the mechanism are a tenth of their size apart.
bool leaves_loads(Problem& problem, const State& at, const Parts& parts, std::size_t part) {
  constexpr double kPart = 0.1;
  std::vector<double> a(at.a().begin(), at.a().end()), load(a.size());
  problem.equations_of_motion(a, at.lambda(), load);
  const double off = parts.largest(part, load);
  problem.momentum(a, load);
  double most = parts.largest(part, load);
  std::ranges::fill(a, 0.0);
  problem.equations_of_motion(a, {}, load);
  most = std::max(most, parts.largest(part, load));
  return off > kPart * most;
}

}  // namespace

bool SingularEnds::settle(Problem& problem, const Eigen::VectorXd& v_n, State& at) {
  if (of_ != &problem) {
    of_ = &problem;
    passage_.reset();
    consistent_.emplace(problem, choice_);
    passage_.emplace(problem, *consistent_);
  }
  const bool settled = passage_->settle_end(at, v_n);
  if (!settled) {
    for (Largest& of : largest_) {
      of.acceleration = std::max(of.acceleration, std::exchange(of.doubted, 0));
      of.multiplier = std::max(of.multiplier, std::exchange(of.doubted_multiplier, 0));
    }
  }
  return settled;
}

void SingularEnds::take_largest(const Problem& problem, std::span<const double> lambda, double Largest::*into) {
  if (largest_.size() == 1) {  // once a step
    double multiplier = 0;
    for (const double x : lambda) multiplier = std::max(multiplier, std::abs(x));
    largest_[0].*into = multiplier;
    return;
  }
  for (Largest& of : largest_) of.*into = 0;
  for (std::size_t k = 0; k < lambda.size(); ++k) {
    double& most = largest_[parts_.of_row(problem, k)].*into;
    most = std::max(most, std::abs(lambda[k]));
  }
}

bool SingularEnds::grow(const Problem& problem, std::span<const double> lambda) {
  constexpr double kGrown = 100;
  for (Largest& of : largest_) of.before = of.last;
  take_largest(problem, lambda, &Largest::last);
  bool any = false;
  for (Largest& of : largest_) {
    const bool grown = of.multiplier > 0 && of.last > kGrown * of.multiplier;
    of.doubted_multiplier = grown ? of.last : 0;
    if (!grown) of.multiplier = std::max(of.multiplier, of.last);
    any = any || grown;
  }
  return any;
}

bool SingularEnds::doubts(Problem& problem, const State& at, const Eigen::VectorXd& v_n, double h) {
  constexpr double kPart = 0.25, kLarger = 1.5;
  const auto a = at.z.head(v_n.size());
  const auto mean = (at.v - v_n) / h;
  bool any = false;
  take_largest(problem, at.lambda(), &Largest::given);
  const double all = largest(at.a());
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    Largest& of = largest_[part];
    double end = 0, over = 0, apart = 0;
    parts_.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
      end = std::max(end, a.segment(first, count).lpNorm<Eigen::Infinity>());
      over = std::max(over, mean.segment(first, count).lpNorm<Eigen::Infinity>());
      apart = std::max(apart, (a - mean).segment(first, count).lpNorm<Eigen::Infinity>());
    });
    const bool doubtful = apart > kPart * std::max(over, end) && end > of.acceleration && !parts_.rests(end, all);
    of.doubted = doubtful ? end : 0;
    any = any || doubtful || (of.given > kLarger * of.before && leaves_loads(problem, at, parts_, part));
  }
  return any;
}

}  // namespace poinsot
