// What is smooth in the functions of time of a scene and short beside a step: a force of 0.1 ms in the middle of a rest
// shows in no stage of a step of 0.1 s.
//
// Before a step is tried, interval arithmetic bounds f̈ over it. The step may see f at some stages only where f̈ comes
// near that bound in several places of the step (then f varies there about as everywhere), or where it makes f no more
// than rtol of its size other than a straight line. Otherwise the step is halved, so that steps go up to a pulse and
// then on in steps of its length, which error control sees. Searched is some steps ahead; functions that vary with one
// and the same pace cost one evaluation in that many steps, scenes without functions of time nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model.h"
#include "integrators/integrator.h"

namespace poinsot {

class Pulses {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  Pulses(const Model& model, double end, double rtol, Tell tell);

  // How far a step from t to `to` may go without stepping over anything. The times do not go back.
  double reach(double t, double to) { return functions_.empty() || to <= seen_to_ ? to : search(t, to); }

 private:
  struct Function {
    const Expression* f;
    double nothing;       // what of it does not matter
    int unknown = 0;      // stretches on end that it held up for nothing
    bool limits = false;  // the last one
  };

  double search(double t, double to);
  void leave_unknown(double t, bool shortest);

  std::vector<Function> functions_;
  const double end_;
  const Tell tell_;
  double seen_to_ = 0;
};

// For steps of a fixed length h, to be told: where a function of the scene first bends by more than it changes nearby,
// within one step.
struct Pulse {
  std::string function;
  double t;
};
std::optional<Pulse> pulse_within(const Model& model, double h, double end);

}  // namespace poinsot
