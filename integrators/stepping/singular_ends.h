// Ends of fixed steps in a singular position, or so near to one that the constraints leave velocities, or accelerations
// found at index 1, to rounding: the state there is the limit of those beside it on the branch (passage.h). They are
// looked for where something changes that might come of it, as that costs some dozens of factorizations.
#pragma once

#include <optional>

#include "integrators/stepping/passage.h"

namespace poinsot {

class SingularEnds {
 public:
  explicit SingularEnds(const Settings& settings) : choice_(settings.linear()) {}

  // Makes `at`, the end of a step that began with v_n, that limit if there is one, and says whether. `problem` stands
  // at `at`, before and after.
  bool settle(Problem& problem, const Eigen::VectorXd& v_n, State& at);
  // Whether multipliers at the end of a step are larger, by far, than where they were the motion's.
  bool grow(std::span<const double> lambda);
  // Whether a sample, whose a is not what steps go on with, has to be asked about: where a differs from the mean of the
  // step, from v_n in time h, by a quarter of the larger one, and is larger than where that was the motion's; or where
  // λ has grown in the step and leaves a tenth of the loads unbalanced. `problem` stands there.
  bool doubts(Problem& problem, const State& at, const Eigen::VectorXd& v_n, double h);

 private:
  LinearChoice choice_;
  Problem* of_ = nullptr;
  std::optional<Consistent> consistent_;
  std::optional<Passage> passage_;
  // Acceleration and multiplier last doubted, and the largest that were the motion's.
  double doubted_ = 0, largest_ = 0, doubted_multiplier_ = 0, largest_multiplier_ = 0;
  double before_ = 0, last_ = 0;  // the largest multiplier of the last two ends
};

}  // namespace poinsot
