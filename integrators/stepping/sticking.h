// A law of a spring that jumps where a run stopped, with either side leading back to the jump: sign(v) of dry friction
// once a body comes to rest, sign(x) of a body that damping brings to rest there; or a spring that pulls on where it
// has no length.
#pragma once

#include <string>

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/law_jumps.h"
#include "linsolve/linear_system.h"

namespace poinsot {

// Sentences; empty where there is no such law, and in mechanisms too large to differentiate its rate by each velocity.
// `instant`: s, within which forces as they are would bring the motion to the jump. Either side leads back where the
// accelerations do, of states that differ in the one direction in which the force acts.
//   sticking_law  a jump by v, which the motion cannot leave
//   resting_law   a jump by x, or a spring without length, about which it vibrates to and fro within a few instants
std::string sticking_law(const Problem& problem, const LinearChoice& choice, const State& state, double instant);
std::string resting_law(const Problem& problem, const LinearChoice& choice, const State& state, double instant);

// The instant for methods that choose their steps, in a run up to `end`.
inline double instant_of(double end) {
  return 1e-4 * end;
}

// Steps under error control that go to and fro over such a jump: as short as may be, they come to no end.
class StickingWatch {
 public:
  StickingWatch(const Model& model, const LinearChoice& choice, double instant);  // the model has to live as long

  // The end of a step, where the problem stands. Failed where many steps have ended on the other side of a jump than
  // the one before, few in between have not, and sticking_law() says of one that the motion cannot leave it.
  Status look(const Problem& problem, const State& at);
  // Where the rest of the run would be a matter of minutes or more. Failed where resting_law() says of one that it
  // rests there.
  Status look_for_rest(const Problem& problem, const State& at) const;

 private:
  const LinearChoice choice_;
  const double instant_;
  LawJumps jumps_;
  LawJumps::Sides before_, sides_;  // at the step before, and at this one
  double crossings_ = 0, t_ = 0;
  int short_ = 0, many_ = 200;  // short steps on end, and how many are looked at
};

}  // namespace poinsot
