#include "integrators/stepping/singular_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// Whether M a + Gᵀλ and Q are a tenth of their size apart.
bool leaves_loads(Problem& problem, const State& at) {
  constexpr double kPart = 0.1;
  std::vector<double> a(at.a().begin(), at.a().end()), load(a.size());
  problem.equations_of_motion(a, at.lambda(), load);
  const double off = largest(load);
  problem.momentum(a, load);
  double most = largest(load);
  std::ranges::fill(a, 0.0);
  problem.equations_of_motion(a, {}, load);
  most = std::max(most, largest(load));
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
    largest_ = std::max(largest_, std::exchange(doubted_, 0));
    largest_multiplier_ = std::max(largest_multiplier_, std::exchange(doubted_multiplier_, 0));
  }
  return settled;
}

bool SingularEnds::grow(std::span<const double> lambda) {
  constexpr double kGrown = 100;
  double multiplier = 0;  // once a step
  for (const double x : lambda) multiplier = std::max(multiplier, std::abs(x));
  const bool grown = largest_multiplier_ > 0 && multiplier > kGrown * largest_multiplier_;
  doubted_multiplier_ = grown ? multiplier : 0;
  before_ = std::exchange(last_, multiplier);
  if (!grown) largest_multiplier_ = std::max(largest_multiplier_, multiplier);
  return grown;
}

bool SingularEnds::doubts(Problem& problem, const State& at, const Eigen::VectorXd& v_n, double h) {
  constexpr double kPart = 0.25, kLarger = 1.5;
  const auto a = at.z.head(v_n.size());
  const auto change = (at.v - v_n) / h;
  const double mean = change.lpNorm<Eigen::Infinity>(), end = a.lpNorm<Eigen::Infinity>();
  const double apart = (a - change).lpNorm<Eigen::Infinity>();
  const bool doubtful = apart > kPart * std::max(mean, end) && end > largest_;
  doubted_ = doubtful ? end : 0;
  return doubtful || (largest(at.lambda()) > kLarger * before_ && leaves_loads(problem, at));
}

}  // namespace poinsot
