// Ends of fixed steps in a singular position, or so near to one that the constraints leave velocities, or accelerations
// found at index 1, to rounding: the state there is the limit of those beside it on the branch (passage.h). They are
// looked for where something changes that might come of it, as that costs some dozens of factorizations.
#pragma once

#include <optional>
#include <vector>

#include "integrators/stepping/parts.h"
#include "integrators/stepping/passage.h"

namespace poinsot {

class SingularEnds {
 public:
  SingularEnds(const Problem& problem, const Settings& settings)
      : choice_(settings.linear()), parts_(problem), largest_(parts_.count()) {}

  // Makes `at`, the end of a step that began with v_n, that limit if there is one, and says whether. `problem` stands
  // at `at`, before and after.
  bool settle(Problem& problem, const Eigen::VectorXd& v_n, State& at);
  // Whether multipliers at the end of a step, of a mechanism, are larger, by far, than where they were the motion's.
  bool grow(const Problem& problem, std::span<const double> lambda);
  // Whether a sample, whose a is not what steps go on with, has to be asked about: where a differs from the mean of the
  // step, from v_n in time h, by a quarter of the larger one, and is larger than where that was the motion's; or where
  // λ has grown in the step and leaves a tenth of the loads unbalanced. `problem` stands there.
  bool doubts(Problem& problem, const State& at, const Eigen::VectorXd& v_n, double h);

 private:
  struct Largest {
    // Acceleration and multiplier last doubted, and the largest that were the motion's.
    double doubted = 0, acceleration = 0, doubted_multiplier = 0, multiplier = 0;
    double before = 0, last = 0;  // the largest multiplier of the last two ends
    double given = 0;             // of a sample
  };
  void take_largest(const Problem& problem, std::span<const double> lambda, double Largest::*into);

  LinearChoice choice_;
  const Parts parts_;
  std::vector<Largest> largest_;  // by mechanism
  Problem* of_ = nullptr;
  std::optional<Consistent> consistent_;
  std::optional<Passage> passage_;
};

}  // namespace poinsot
