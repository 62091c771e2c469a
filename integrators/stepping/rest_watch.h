// Whether steps of fixed length have come to rest in a singular position and gone on by another branch.
//
// Where branches meet and velocities vanish, velocities do not tell branches apart (branch.h), accelerations do: those
// of another branch differ altogether from those before, in the direction that the constraints leave free there. Every
// eighth step the mean acceleration since the last look is compared with that before; where it turned round, velocities
// are what one such stretch makes of them, and the constraints are much steeper at one of the looks than at another, it
// was left. (With error control: Consistent::leaves_branch.)
#pragma once

#include "formulations/problem.h"
#include "integrators/state.h"
#include "linsolve/linear_system.h"

namespace poinsot {

class RestWatch {
 public:
  // Whether the end of the step that was done is to be looked at.
  bool due() { return --wait_ == 0; }
  // That end, `at`; failed where the branch was left. The problem is not touched.
  Status look(const Problem& problem, const LinearChoice& choice, const State& at);
  // Coordinates are others.
  void forget() { looks_ = 0, wait_ = kApart; }

 private:
  static constexpr int kApart = 8;  // steps

  struct Look {
    double t = 0;
    Eigen::VectorXd q, v;
  };
  bool turned_round(const State& at) const;
  bool left_branch(const Problem& problem, const LinearChoice& choice, const State& at) const;

  int wait_ = kApart, looks_ = 0;
  Look last_, before_;
};

}  // namespace poinsot
