// Which function of time of a model has no finite value at a time, and why: for messages of runs that cannot go on.
#pragma once

#include <string>

#include "core/model.h"
#include "core/status.h"

namespace poinsot {

// "at t = 1 s driver 'motor': '1/(t - 1)' is not finite": the first of constraints, drivers, forces and torques; empty
// where all of them, and the derivatives that rows need, are finite. A length that is not positive is none.
std::string fault_of_functions(const Model& model, double t);
// The sentence that begins so.
std::string fault_sentence(double t, const std::string& whose, const std::string& what);

// "constraint 'tilt' asks for a cosine beyond 1 from t = 2 s on": the first row that from a time in [from, to] on asks
// for what no position of any two bodies has, a cosine beyond ±1 or the square of a distance below 0; empty where there
// is none.
std::string beyond_any_position(const Model& model, double from, double to);

// "force 'push', component x: '1/(t - 0.5)^2' grows without bound towards t = 0.5 s", "driver 'slide': the rate of
// 'sqrt(1 - t)' ...": the first function that does, as does the inverse of a power of the time that is left, at a time
// in [from, to]; of constraints and drivers with the rates that rows need. Empty where none does.
std::string growing_without_bound(const Model& model, double from, double to);

// "driver 'spin' turns at 1e+100 rad/s, ...": the first driven angle that within [from, to] changes by more than a
// tenth of a radian from one time before `end` to the next that numbers tell apart, so that no step is short enough for
// it; empty where there is none.
std::string faster_than_times(const Model& model, double from, double to, double end);

// The failure that a fault is, and what to try: an end before it, where it is not at the start.
Status no_value(double t, const std::string& fault);

}  // namespace poinsot
