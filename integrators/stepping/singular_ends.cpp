#include "integrators/stepping/singular_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {

bool SingularEnds::settle(Problem& problem, const Eigen::VectorXd& v_n, State& at) {
  if (of_ != &problem) {
    of_ = &problem;
    passage_.reset();
    consistent_.emplace(problem, choice_);
    passage_.emplace(problem, *consistent_);
  }
  const bool settled = passage_->settle_end(at, v_n, open_);
  if (!settled) largest_ = std::max(largest_, std::exchange(doubted_, 0));
  return settled;
}

bool SingularEnds::doubts(const State& at, const Eigen::VectorXd& v_n, double h) {
  constexpr double kPart = 0.25;
  double mean = 0, end = 0, apart = 0;
  for (Eigen::Index k = 0; k < v_n.size(); ++k) {
    const double a = (at.v[k] - v_n[k]) / h;
    mean = std::max(mean, std::abs(a));
    end = std::max(end, std::abs(at.z[k]));
    apart = std::max(apart, std::abs(at.z[k] - a));
  }
  const bool doubtful = apart > kPart * std::max(mean, end) && end > largest_;
  doubted_ = doubtful ? end : 0;
  return doubtful;
}

}  // namespace poinsot
