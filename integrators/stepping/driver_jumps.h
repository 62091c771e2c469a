// Jumps of what drivers and constraints prescribe, seen by what it comes to at the ends of steps: those that no switch
// of the data tells of (switch_times.h), as of atan2, of 1/(t − c) or tanh(1e13 (t − c)), and those of an angle by half
// a turn or a whole one, which leave the row of the angle as it is, a sine.
//
// What f changes by over a step beside what the smaller ḟ of its ends tells of it, |f(b) − f(a) − (b − a) ḟ|, falls
// with every halving of the step where f is smooth or has a kink, and stays what it is in that half that a jump lies
// in. One that it stays in down to a stretch of 1e-10 of the run is a jump. Functions without a sign or step whose ḟ
// interval arithmetic bounds so that they change by no more than 1e-6 in such a stretch are not looked at, which are
// most.
//
// Distances that come to zero, beyond which no motion is told either, are looked for along with them.
#pragma once

#include <cmath>
#include <vector>

#include "core/model.h"
#include "core/status.h"
#include "integrators/stepping/closing_lengths.h"

namespace poinsot {

class DriverJumps {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  DriverJumps(const Model& model, double end);

  bool none() const { return functions_.empty() && lengths_.none(); }  // that may
  // From the time looked up to before, first 0, to this one; fails where a prescribed position jumps, or a distance
  // comes to zero.
  Status look(double to);

 private:
  struct Value {
    double t = 0, f = 0, fd = 0;
    bool is_finite() const { return std::isfinite(f) && std::isfinite(fd); }
  };
  struct Function {
    const Expression* f;
    int row;
    Value at;
  };

  static Value value(const Expression& f, double t);
  bool jumps(const Expression& f, Value& from, Value to) const;

  const Model& model_;
  const double shortest_;
  double looked_to_ = 0;
  std::vector<Function> functions_;
  ClosingLengths lengths_;
};

}  // namespace poinsot
