// Prescribed distances that come to zero: of drivers the length, of constraints D its square.
//
// Where two points meet the gradient of their distance vanishes, and it says neither in which direction they part nor
// whether they pass one another or turn back: one method goes on to one side, another to the other. So no run goes over
// it. What is stepped over is bounded by interval arithmetic, halved until it is bounded away from zero or is as short
// as switches are resolved (switch_times.h), so that it does not matter where steps end. Functions that are seen to
// stay positive over the whole run are not looked at again, which are most.
#pragma once

#include <vector>

#include "core/model.h"
#include "core/status.h"

namespace poinsot {

class ClosingLengths {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`. Those that are zero where the run
  // begins are left to who assembles it.
  ClosingLengths(const Model& model, double end);

  bool none() const { return functions_.empty(); }  // that may
  // From the time looked up to before, first 0, to this one; fails where a distance comes to zero.
  Status look(double to);

 private:
  struct Function {
    const Expression* f;
    int row;
    int budget = 0;
  };

  // The time at which f comes to zero in a stretch; infinite where it does not, as far as the budget tells.
  double closes(Function& of, double from, double to) const;

  const Model& model_;
  const double shortest_;
  double looked_to_ = 0;
  std::vector<Function> functions_;
};

}  // namespace poinsot
