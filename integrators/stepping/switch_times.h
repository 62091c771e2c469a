// Where the functions of time of a scene have kinks and jumps: the times at which the argument of an abs, sign or step,
// or the difference of the two of a min or max, changes its sign.
//
// What lies ahead is searched before it is stepped into, by interval arithmetic: a stretch of time over which every
// switching function is bounded away from zero has no switch, any other is halved until it has none or is as short as
// kResolved of the run. So a pulse is found however short it is beside a step, down to that; and a function that
// touches zero without a change of sign is passed. Laws of springs switch by the state, which nobody knows ahead: error
// control finds those by itself.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

class SwitchTimes {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  SwitchTimes(const Model& model, double end);

  // A switch: `before` is the last time of the one side, `after` the first of the other, a rounding later.
  struct Switch {
    double before = std::numeric_limits<double>::infinity(), after = before;
  };
  // The first one after t and not after `to`; none: at infinity. The times asked for do not go back.
  Switch first(double t, double to);

 private:
  struct Switching {
    const Expression* f;
    std::vector<double> at_start, at_end;  // the switching functions at both ends of a stretch
  };

  Switch find(Switching& of, double from, double to, int& budget);
  Switch between(Switching& of, double from, double to);

  static constexpr double kResolved = 1e-10, kInstant = 1e-17;

  std::vector<Switching> switching_;
  const double resolution_, instant_;
  double clear_to_ = 0;  // no switch between the last one that was asked for and here
  Switch found_;
};

}  // namespace poinsot
