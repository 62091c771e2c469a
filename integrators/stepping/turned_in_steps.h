// Steps of a fixed length over which a spring passes through no length, and its force turns round: error control steps
// onto that (law_switches.h), here it is told, once a run.
//
// What the force does in the meantime is unknown to the step, which leaves F h/m of velocity open: an error of first
// order, whatever the method's. Nothing is looked at while the ends cannot have come near one another.
//
// Of a spring that is stiff beside the step, h² k/m > 1, the equations of a step have a solution on either side of no
// length. One on the other side than the ends' velocities lead to is none of the motion: such a step fails.
#pragma once

#include <vector>

#include "integrators/integrator.h"
#include "integrators/state.h"
#include "integrators/stepping/law_path.h"
#include "integrators/stepping/next_look.h"

namespace poinsot {

class TurnedInSteps {
 public:
  // Of a model that has to live as long.
  TurnedInSteps(const Model& model, Tell tell);

  // Whether the end of the step under way is to be looked at.
  bool due(double h) { return !springs_.empty() && look_.due(h); }
  // The problem stands at `at`, where a step of h has ended or the run begins. A step that has failed was not looked
  // at.
  Status look(const Problem& problem, const State& at, double h);

 private:
  struct Spring {
    SpringLaw of;
    double arm;             // m, the longer one on a body
    LawPlace from{}, to{};  // where the last look was, and this one is
  };
  Status thrown_over(const Spring& spring, const State& at, double h) const;

  const Model& model_;
  const Tell tell_;
  std::vector<Spring> springs_;
  std::vector<BodyState> bodies_;
  NextLook look_;
  bool begun_ = false, told_ = false;
};

}  // namespace poinsot
