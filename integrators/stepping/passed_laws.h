// What laws of springs do between two ends of a step and no stage sees: balls that touch for a millisecond in a step of
// a second, a catch that a slide runs over.
//
// Over a step the ends of a spring go by d(s) = the cubic of Hermite through d and ḋ at both ends, s = (t − t_n)/h. It
// errs by no more than e ≈ h²/50 (|δ_n| + |δ_{n+1}|), δ what its second derivative and the true one differ by at an
// end, no more than the turning of bodies and the change of ḋ account for: stiff forces make noise of accelerations.
// With x(s) = |d(s)| − length (an angle less its zero for a torsion spring), F(s) = law(x(s), v, t), v that of the
// middle: the step sees F where interval arithmetic holds it, piece by piece, within what it comes to at its ends or at
// four of nine places in between, widened by twice as much to either side. Else it is cut to where F is known to come
// to more, or is not known to stay below, from where error control sees it. What is below the tolerance, as a velocity
// of the lighter body, does not matter.
//
// That F varies with v is left to error control, and with time alone to pulses.h. A scene without laws costs nothing,
// and one whose laws show in a step two bounds and three values of each.
#pragma once

#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/integrator.h"
#include "integrators/state.h"

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
  static constexpr int kPartings = 12;       // of a step
  static constexpr int kMostPieces = 300;    // of one look
  static constexpr int kHalvings = 8;        // towards where F comes to more
  static constexpr int kMostUnknown = 400;   // steps
  static constexpr double kInstant = 1e-14;  // of the time: what rounding may make of it
  static constexpr double kBeyond = 2;       // of the range that is seen
  static constexpr int kPlaces = 4;          // that stages do not miss
  static constexpr double kNodes[] = {0, 0.11, 0.23, 0.36, 0.49, 0.63, 0.77, 0.89, 1};  // no period goes with them

  using Vector = Eigen::Vector3d;
  // Of what a law depends on: the span of a spring, the angle of a torsion spring in its first component.
  struct Place {
    Vector d = Vector::Zero(), rate = Vector::Zero(), second = Vector::Zero();
    double turning = 0;  // m/s², of the second derivative what points owe to how their bodies turn
  };
  struct Law {
    const Expression* F;
    int spring, torsion;  // of the model; one is −1
    double zero;          // m, rad
    double inertia;       // kg, kg m², of the lighter body
    Place before, from, to;
    double largest = 0;  // |F| so far
    int unknown = 0;     // steps on end that it cut for nothing
  };
  class Path;
  class Seen;
  // The first place of a step at which F may come to more than is seen; known: it does.
  struct Unseen {
    double s = 1;
    bool known = false;
  };

  void look(const Problem& problem, const State& at);
  Place place(const Problem& problem, const Law& of) const;
  static double entry(const Path& path, const Seen& seen, double from, double to);
  static Unseen first_unseen(const Path& path, const Seen& seen, double from, double to, int partings, int& pieces);
  double cut(Law& of, const Path& path, double from, double to) const;
  void leave_unknown(double t);

  const Model& model_;
  const double end_, rtol_, atol_;
  const Tell tell_;
  std::vector<Law> laws_;
  std::vector<BodyState> bodies_;
  double t_ = 0, before_ = 0;
};

}  // namespace poinsot
