// What laws of springs do between two ends of a step and no stage sees: balls that touch for a millisecond in a step of
// a second, a catch that a slide runs over.
//
// A step that does not see what F comes to (law_path.h) is cut to where it is known to come to more, or is not known to
// stay below, from where error control sees it. What is below the tolerance, as a velocity of the lighter body, does
// not matter.
//
// That F varies with v is left to error control, and with time alone to pulses.h. A scene without laws costs nothing,
// and one whose laws show in a step two bounds and three values of each.
#pragma once

#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/integrator.h"
#include "integrators/state.h"
#include "integrators/stepping/law_path.h"

namespace poinsot {

class PassedLaws {
 public:
  // Of the expressions of the model, which has to live as long, up to a time `end`.
  PassedLaws(const Model& model, double end, double rtol, double atol, Tell tell);

  bool none() const { return laws_.empty(); }
  // The problem stands at `from`, where a step begins.
  void begin(const Problem& problem, const State& from);
  // The problem stands at `to`, where the step that began there ends. How far it may go, to.t where it may so; a step
  // that may is where the next one begins.
  double reach(const Problem& problem, const State& to);
  void take_back();  // that step
  // As far as is known at the beginning, where the motion goes on as it does there up to a time `to`.
  double ahead(double to);

 private:
  static constexpr double kUnseen = 0.1;     // of the tolerance
  static constexpr double kResolved = 1e-9;  // of the run
  static constexpr double kPart = 0.1;       // of a step that is worth one
  static constexpr int kMostUnknown = 400;   // steps

  struct Law {
    SpringLaw of;
    LawPlace before, from, to;
    double largest = 0;  // |F| so far
    int unknown = 0;     // steps on end that it cut for nothing
  };

  void look(const Problem& problem, const State& at);
  double cut(Law& law, const LawPath& path, double from, double to) const;
  void leave_unknown(double t);

  const Model& model_;
  const double end_, rtol_, atol_;
  const Tell tell_;
  std::vector<Law> laws_;
  std::vector<BodyState> bodies_;
  double t_ = 0, before_ = 0;
};

}  // namespace poinsot
