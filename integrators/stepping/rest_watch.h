// Whether steps of fixed length have come to rest in a singular position and gone on by another branch.
//
// Where branches meet and velocities vanish, velocities do not tell branches apart (branch.h), accelerations do: those
// of another branch differ altogether from those before, in the direction that the constraints leave free there. Every
// eighth step the mean acceleration since the last look is compared with those before; where it turned round,
// velocities are what such stretches make of them, and the constraints are much steeper at one of the looks than at
// another, it was left. Each of the scene's mechanisms is looked at by itself. (With error control:
// Consistent::leaves_branch.)
#pragma once

#include <array>
#include <vector>

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/parts.h"
#include "linsolve/linear_system.h"

namespace poinsot {

// What is said of a motion seen at t, which was on its branch at `since`.
Status other_branch_after_rest(double t, double since);

class RestWatch {
 public:
  explicit RestWatch(const Problem& problem);  // steps allocate nothing

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
    Eigen::VectorXd q, v, a;  // a: the mean since the look before
  };
  bool left_branch(const Problem& problem, const LinearChoice& choice, const State& at, const Look& then,
                   std::size_t part) const;

  const Parts parts_;
  int wait_ = kApart, looks_ = 0;
  std::array<Look, 2> before_;  // the last one first
  Eigen::VectorXd a_;           // as of a look, now
  std::vector<double> usual_;   // by mechanism, the largest of the looks so far, those long ago forgotten
};

}  // namespace poinsot
