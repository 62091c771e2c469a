// Whether a step of fixed length has gone over to another branch beside a singular position.
//
// Where branches meet, what Newton's method finds at the end of a step may lie on any of them: the constraints hold on
// all. The velocities that a position allows, G v = ν, are continuous along a branch and others on another. So a step
// may have left its branch where what its last position takes from its first velocity,
//
//   M δ + Gᵀμ = 0,   G δ = (G(q_n) − G) v_n,   G = G(q)
//
// is comparable to v_n though bodies have turned by little: along a branch δ is of the order of that turn, except
// beside a dead centre, where it may be as large on the right one. It is asked for, at the price of a factorization,
// after a step that changes velocities by a fifth of them, and by several times what steps before it did. Sudden loads
// and kinks of drivers do that, too, and leave no such δ. What follows is decided in fixed_steps.cpp.
#pragma once

#include <vector>

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/parts.h"
#include "linsolve/linear_system.h"

namespace poinsot {

class BranchWatch {
 public:
  explicit BranchWatch(const Problem& problem);

  // The first step begins with velocities that change by a per second.
  void begin(std::span<const double> a);
  // The part of the velocities that changes in a step of length h from v_n to v, where that is several times what steps
  // before lead to expect; else 0. The largest of a mechanism.
  double jump(const Eigen::VectorXd& v_n, const Eigen::VectorXd& v, double h);
  // The last step that was looked at stands.
  void follow();

 private:
  struct Changes {  // of velocities per second
    double way = 0, turn = 0, usual_way = 0, usual_turn = 0;
  };

  const bool constrained_;
  const Parts parts_;
  std::vector<Changes> changes_;  // by mechanism
  bool begun_ = false;
  double length_;  // m, the longest arm
};

struct Departure {
  double share = 0;  // |δ|/|v|: of the larger one of v_n and v, points and turns each for itself, but beside no less
                     // than a hundredth of the other, the largest of a mechanism; infinite where it ends in a singular
                     // position
  int row = 0;       // whose impulse μ is the largest, as an unknown of the problem
};
struct StepEnd {
  double t;
  const Eigen::VectorXd &q, &v;
};
// The problem stands at the end of the step, before and after.
Departure departure(Problem& problem, const LinearChoice& choice, const StepEnd& from, const StepEnd& to);

}  // namespace poinsot
