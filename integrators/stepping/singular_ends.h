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
  // Whether a sample, whose a is not what steps go on with, has to be asked about: where a differs from the mean of the
  // step, from v_n in time h, by a quarter of the larger one, and is larger than where that was the motion's.
  bool doubts(const State& at, const Eigen::VectorXd& v_n, double h);
  // Of the last one that was settled: its λ is that of a state beside it.
  bool leaves_multipliers_open() const { return open_; }

 private:
  LinearChoice choice_;
  Problem* of_ = nullptr;
  std::optional<Consistent> consistent_;
  std::optional<Passage> passage_;
  bool open_ = false;
  double doubted_ = 0, largest_ = 0;  // acceleration last doubted, and the largest that was the motion's
};

}  // namespace poinsot
