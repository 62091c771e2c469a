// Kinks and jumps of laws of springs by the state: where along the way the argument of an abs, sign or step, or the
// difference of the two of a min or max, changes its sign, as of a ball that comes to the floor. And where the force of
// a spring turns round at once, because it passes through no length or next to it: d · ḋ changes its sign there.
//
// Error control alone gets over such a place by rejections, and its estimate, made for smooth forces, is off by what
// the bend does: some ten rejections and ten to a thousand tolerances each (radau5, dopri5). So a step that would go
// over one and does more there than the tolerance is taken again up to shortly before it, and a short one leads so near
// that what is left is known beyond any tolerance: accelerations as they are lead to the other side, where error
// control begins anew. Only where F or its rate jumps; kinks of its second derivative are left to error control.
//
// A scene without such laws costs nothing, and a step that goes over nothing four values of each.
#pragma once

#include <limits>
#include <vector>

#include "integrators/stepping/law_steps.h"

namespace poinsot {

class LawSwitches {
 public:
  // Of steps that have to live as long, in a run up to a time `end`.
  LawSwitches(const LawSteps& steps, double end, double rtol, double atol);

  // At the beginning of a step. One that begins on a jump, as at rest on sign(v), begins beside it.
  void begin();
  // How far the step to a time may go, that time where it may so: the step looked at or, where it ends at another time,
  // as the motion goes on at its beginning.
  double reach(double to);
  void accept();  // that step, which is steps.accept()ed thereafter
  // s, just beyond the switch that the motion stands before; none so near: infinity.
  double beyond() const { return beyond_; }
  // s, when that switch is crossed that a step comes to within a time; none: infinity.
  double crossed_within(double time);
  // The length of the next step, where one of h was wanted.
  double length(double h);

 private:
  struct Switch {
    int k;  // of the law's switches; kNoLength: the spring through no length
    bool jumps;
    bool by_x;
    double side = 0, next = 0;  // its sign where the step began, and where it ends; 0: on neither side as yet
    double last = -1;           // s, when it was crossed
    int soon = 0;               // crossings each of which came soon after the one before
  };
  struct Law {
    std::size_t law;
    std::vector<Switch> switches;  // that the state decides
  };
  // Of a step, at s.
  struct Crossing {
    Switch* of = nullptr;
    std::size_t law = 0;
    double s = 1;
  };

  void look(Law& law, const LawPath& path, double h, Crossing& first);
  void find_values(std::size_t law, const LawPath& path, double s);
  double value(const Switch& of, const LawPath& path, double s) const;
  double value(std::size_t law, const Switch& of, const LawPath& path, double s);
  bool begins_on(const Switch& of, const LawPath& path) const;
  double root(std::size_t law, const Switch& of, const LawPath& path, double from, double to);
  double left();
  double span() const { return 2 * (expected_ - steps_.from() + within_); }
  double resolution() const;
  void note_crossing(Switch& of, double t) const;
  bool counts(std::size_t law, const Switch& of, const LawPath& path, double s, double h) const;
  double turned_round(std::size_t law, const LawPath& path, double s, double h) const;
  double bent(std::size_t law, const Switch& of, const LawPath& path, double s) const;

  double tolerance(const LawSteps::Law& steps) const { return atol_ + rtol_ * steps.from.rate.norm(); }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr int kNoLength = -1;

  const LawSteps& steps_;
  const double end_, rtol_, atol_;
  std::vector<Law> laws_;
  std::vector<double> values_;
  Crossing approached_;
  double long_ = 0;                   // s, the longest step towards it, or the last one
  double expected_ = 0, within_ = 0;  // s: when it is crossed, and how far from then
  double beyond_ = kNever;
};

}  // namespace poinsot
