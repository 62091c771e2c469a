// Steps of a fixed length that pass over a contact or a catch: what error control does not step over (passed_laws.h) is
// told here, once a law, with a step that sees it.
//
// A look at every step would cost as much as many a step. About where a spring is, a law has a quiet box of x and v:
// there its slope with x keeps its sign, so that F lies between what it comes to at both ends of a step, or changes so
// little that F is all but a straight line; and it does not jump. While the ends cannot have come near the edge of the
// box, which does not go beyond a span of 0, nothing is looked at, for up to eight steps. Of a spring
// whose force only rises with its length every box is quiet. Where there is none each step is looked at.
#pragma once

#include <vector>

#include "integrators/integrator.h"
#include "integrators/state.h"
#include "integrators/stepping/law_terms.h"
#include "integrators/stepping/next_look.h"

namespace poinsot {

class PassedInSteps {
 public:
  // Of the expressions of the model, which has to live as long.
  PassedInSteps(const Model& model, double end, Tell tell);

  // Whether the end of the step under way is to be looked at.
  bool due(double h) { return !laws_.empty() && look_.due(h); }
  // The problem stands at `at`, where a step of h has ended or the run begins.
  void look(const Problem& problem, const State& at, double h);

 private:
  static constexpr double kMostSteps = 8;  // between two looks
  static constexpr int kMostUnknown = 8;   // steps
  static constexpr double kCounts = 1e-3;  // of the largest force, or of what stops the ends within a step
  static constexpr double kFaster = 4;     // a spring may become before it is looked at again
  static constexpr int kNoBoxFor = 8;      // steps, once there is none

  struct Box {
    double least = 0, most = -1;  // of x
    double speed = 0;             // the most
    double way = 0;               // of a step, the longest over which F is a straight line
  };
  struct Law {
    SpringLaw of;
    LawTerms terms;
    LawPlace from;        // where the last look was
    bool watched = true;  // the step from there is to be looked at
    Box box;
    double largest = 0;  // |F| so far
    int unknown = 0;     // steps on end that have no close bounds
    int no_box_for = 0;  // steps, for which none is looked for
  };

  double quiet_for(Law& law, double t, double h) const;
  bool find_box(Law& law, double t, double way, double h) const;
  bool stays(Law& law, const LawPlace& to, double t, double h) const;
  void tell_passed(const Law& law, const LawPath& path, double s, double t, double h) const;
  // What of F does not matter where the ends go at a speed in steps of h.
  double nothing(const Law& law, double speed, double h) const;

  const Model& model_;
  const double end_;
  const Tell tell_;
  std::vector<Law> laws_;
  std::vector<BodyState> bodies_;
  NextLook look_;
};

}  // namespace poinsot
