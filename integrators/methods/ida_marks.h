// Accelerations along the way that IDA goes. By them the branch is known beyond a singular position in which the motion
// came to rest: what turns round there without a reason leads on another one.
#pragma once

#include "integrators/state.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/parts.h"

namespace poinsot {

class IdaMarks {
 public:
  IdaMarks(Problem& problem, Consistent& consistent);

  // Where the way begins.
  void begin(const State& at);
  // Where a step of IDA ends that turned a body by so many radians at the most; whether it is on another branch.
  Status pass(State& end, double turned);
  // Those beyond a switch are others.
  void forget();
  // The way goes on from t.
  void go_back_to(double t);
  // What a pair that has started at t is to expect of its way.
  void expect(ControlledPair& pair, double t) const;

 private:
  struct Mark {
    bool known = false;
    double t = 0, way = 0;  // rad, since the one before
    Eigen::VectorXd a;
  };

  Problem& problem_;
  Consistent& consistent_;
  const Parts parts_;
  Mark before_, last_;
  double way_ = 0;  // since the last one
};

}  // namespace poinsot
