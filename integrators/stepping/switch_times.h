// Where the functions of time of a scene have kinks and jumps: the times at which the argument of an abs, sign or step,
// or the difference of the two of a min or max, changes its sign.
//
// What lies ahead is searched before it is stepped into, by interval arithmetic: a stretch of time over which a
// switching function is bounded away from zero has no switch, any other is halved until it has none or is as short as
// kResolved of the run. So a pulse is found however short it is beside a step, down to that; and a function that
// touches zero without a change of sign is passed. One that is zero up to rounding over a stretch has no sign there:
// what rounding makes of it is no switch, and where a sign or a step has such an argument, the user is told. Laws of
// springs switch by the state besides, which nobody knows ahead: see law_switches.h.
#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "core/model.h"
#include "core/status.h"
#include "integrators/integrator.h"

namespace poinsot {

class SwitchTimes {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  SwitchTimes(const Model& model, double end, Tell tell = {});

  // A switch: `before` is the last time of the one side, `after` the first of the other, a rounding later.
  struct Switch {
    double before = std::numeric_limits<double>::infinity(), after = before;
  };
  // The first one after t and not after `to`; none: at infinity. The times asked for do not go back.
  Switch first(double t, double to);

 private:
  struct Switching {
    const Expression* f;
    int k;
    int budget;
    bool told;
  };
  enum class Side { below, on, above, undecided };  // the last: zero within its rounding

  Switch find(Switching& of, double from, double to);
  Switch between(const Switching& of, double from, double to);
  double last_after(Switching& of, double from, double to);
  Side side(const Switching& of, double t) const;
  Side computed_side(const Switching& of, double t);
  bool rests(const Switching& of, double from, double to) const;
  void say(Switching& of, const char* what, double t) const;

  static constexpr double kResolved = 1e-10, kInstant = 1e-17, kLeastStep = 1e-3;

  std::vector<Switching> switching_;
  std::vector<double> values_;
  const double resolution_, instant_;
  const Tell tell_;
  double clear_to_ = 0;  // no switch between the last one that was asked for and here
  Switch found_;
};

// Whether it has a sign or a step.
bool may_jump(const Expression& f);

// A prescribed position that jumps, past the start: the last time before, and the row of the model that prescribes it.
struct PositionJump {
  double after = std::numeric_limits<double>::infinity();
  int row = -1;
};
// The first one before `end`, if there is one.
PositionJump first_jump(const Model& model, double end);
// The stop where it does, by `what`.
Status jump_of_positions(double t, std::string_view what);
// A kink or a jump of the data at a singular position, where no state is found just past it.
Status singular_switch(double t);

}  // namespace poinsot
