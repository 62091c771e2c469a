// Whether a motion comes to rest in a singular position, accelerations included, and goes on from there.
//
// Where branches meet, velocities tell them apart, or accelerations where these vanish (Consistent::leaves_branch,
// rest_watch.h). Where both vanish, as of a wheel driven by cos((1 − t)³), which branch a motion goes on by is up to
// derivatives that no method looks at: the run says so.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "formulations/problem.h"
#include "integrators/state.h"

namespace poinsot {

class StillWatch {
 public:
  StillWatch(const Problem& problem, std::function<void(const std::string&)> tell);  // steps allocate nothing

  // The end of a step. The problem is not touched. In mechanisms too large to look at densely nothing is seen.
  void look(const Problem& problem, const State& at);

 private:
  enum class Motion { under_way, at_rest, going_on };
  Motion motion_ = Motion::under_way;
  std::function<void(const std::string&)> tell_;
  double t_ = -1;                                // of the last look
  Eigen::VectorXd v_;                            // then
  double speed_ = 0, acceleration_ = 0;          // usual ones: the largest so far, those long ago forgotten
  double t_rest_ = 0, slowest_ = 0, share_ = 1;  // of the last rest
  bool told_ = false;
};

}  // namespace poinsot
