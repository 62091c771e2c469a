// Whether a motion comes to rest in a singular position, accelerations included, and goes on from there.
//
// Where branches meet, velocities tell them apart, or accelerations where these vanish (Consistent::leaves_branch,
// rest_watch.h). Where both vanish, as of a wheel driven by cos((1 − t)³), which branch a motion goes on by is up to
// derivatives that no method looks at: the run says so. Each of the scene's mechanisms is looked at by itself.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/parts.h"

namespace poinsot {

class StillWatch {
 public:
  StillWatch(const Problem& problem, std::function<void(const std::string&)> tell);  // steps allocate nothing

  // The end of a step. The problem is not touched. Where thousands of rows hold one body nothing is seen.
  void look(const Problem& problem, const State& at);

 private:
  enum class Motion { under_way, at_rest, going_on };
  struct Part {  // of the scene, a mechanism
    Motion motion = Motion::under_way;
    double speed = 0, acceleration = 0;         // usual ones: the largest so far, those long ago forgotten
    double t_rest = 0, slowest = 0, share = 1;  // of the last rest
  };
  void look(const Problem& problem, const State& at, std::size_t part, double since, double speed);
  double least_share(const Problem& problem, const State& at, std::size_t part);

  const Parts parts_;
  std::vector<Part> of_;
  std::function<void(const std::string&)> tell_;
  double t_ = -1;               // of the last look
  Eigen::VectorXd v_, change_;  // v then
  double fastest_ = 0;          // of all
  Eigen::VectorXd shares_;      // of rows, where they are known at this look
  bool told_ = false, shares_known_ = false;
};

}  // namespace poinsot
