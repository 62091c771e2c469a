// What laws of springs do between two ends of a step and no stage sees: balls that touch for a millisecond in a step of
// a second, a catch that a slide runs over.
//
// A step that does not see what F comes to (law_path.h) is cut to where it is known to come to more, or is not known to
// stay below, from where error control sees it; one over which F varies too steeply, to where that begins or to its
// half. What is below the tolerance, as a velocity of the lighter body, does not matter.
//
// That F varies with v beside x is left to error control, and with time alone to pulses.h; where it goes on by another
// cubic of a table, steps end, if it matters (table_knots.h). A scene without laws costs nothing, and one whose laws
// show in a step two bounds and five values of each, and of what they hide (law_terms.h).
#pragma once

#include <vector>

#include "integrators/integrator.h"
#include "integrators/stepping/law_looks.h"
#include "integrators/stepping/law_steps.h"
#include "integrators/stepping/law_terms.h"

namespace poinsot {

class PassedLaws {
 public:
  // Of steps that have to live as long, in a run up to a time `end`.
  PassedLaws(const LawSteps& steps, double end, double rtol, double atol, Tell tell);

  bool none() const { return none_; }
  // How far the step looked at may go; its end where it may so.
  double reach();
  // As far as is known at its beginning, where the motion goes on as it does there up to a time `to`; of a method that
  // looks at forces where its steps end alone.
  double ahead(double to);
  // Up to where a law asks another cubic of a table, as the motion goes on now, if that matters (table_knots.h).
  double to_knot(double to);

 private:
  static constexpr double kUnseen = 0.1;     // of the tolerance
  static constexpr double kResolved = 1e-9;  // of the run
  static constexpr double kPart = 0.1;       // of a step that is worth one
  static constexpr int kMostUnknown = 400;   // steps

  struct Watch {
    LawTerms terms;
    bool on;
    double largest = 0;  // |F| so far
    int unknown = 0;     // steps on end that it cut for nothing
  };

  using Look = UnseenForce (*)(const LawPath&, const LawEnds&, double);
  double nothing(std::size_t k, const LawEnds& ends, double h, double tolerance);
  double knot(std::size_t k, const LawPath& path, const LawEnds& ends, double to);
  double cut(std::size_t k, const LawPath& path, const LawEnds& ends, double to, Look look,
             double tolerance);  // m/s, rad/s
  void leave_unknown(double t);

  const LawSteps& steps_;
  const double end_, rtol_, atol_;
  const Tell tell_;
  std::vector<Watch> watches_;  // by law
  bool none_ = true;
};

}  // namespace poinsot
