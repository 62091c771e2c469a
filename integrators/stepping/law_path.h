// A spring that has a law over one step: the way its ends go, and what the law comes to on it.
//
// Over a step the ends of a spring go by d(s) = the cubic of Hermite through d and ḋ at both ends, s = (t − t_n)/h. It
// errs by no more than e ≈ h²/50 (|δ_n| + |δ_{n+1}|), δ what its second derivative and the true one differ by at an
// end, no more than the turning of bodies and the change of ḋ account for: stiff forces make noise of accelerations.
// With x(s) = |d(s)| − length (an angle less its zero for a torsion spring), F(s) = law(x(s), v, t), v that of the
// middle, or v(s) of a law that is looked at by its rate.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "formulations/problem.h"

namespace poinsot {

// What a law depends on: the span of a spring, the angle of a torsion spring in its first component.
struct LawPlace {
  Vector3 d = Vector3::Zero(), rate = Vector3::Zero(), second = Vector3::Zero();
  double turning = 0;  // m/s², of the second derivative what points owe to how their bodies turn
  double extent = 0;   // m, rad: of what d is a difference, and so rounded as
};

struct SpringLaw {
  const Expression* F;                       // null of a spring whose law is linear or constant
  int spring, torsion;                       // of the model; one is −1
  double zero;                               // m, rad
  double inertia;                            // kg, kg m², of the lighter body
  double without_length = 0, stiffness = 0;  // N, N/m, where F is null: its force there, and how that grows
  bool by_rate = false;                      // v is what it varies with on its way

  // As it is where the problem, and the bodies, stand.
  LawPlace place(const Model& model, const Problem& problem, std::span<const BodyState> bodies) const;
  Arguments<double> arguments(const LawPlace& place, double t) const;
  double change(const LawPlace& place) const;     // of v with time
  double at_rest(double length, double t) const;  // N, the force of a spring
  double at_no_length(double t) const;            // N; 0 where it is what digits of the law are rounded to
  // N, what turns round where a spring passes through no length: 0 where up to `length` the force does not stay alike.
  double turning(double length, double t) const;
  const std::string& name(const Model& model) const;
  std::string called(const Model& model) const;                    // what it is, too
  const char* unit() const { return torsion >= 0 ? "N m" : "N"; }  // of F
};
// Those that a step may pass over: neither constants nor functions of the program.
std::vector<SpringLaw> spring_laws(const Model& model);
// Of the others those whose force where they have no length is not zero.
std::vector<SpringLaw> springs_that_turn_round(const Model& model);
// These, and those of laws: their force may turn round.
std::vector<SpringLaw> springs_that_may_turn_round(const Model& model);

// F at the ends of a step, and its first derivatives by s.
struct LawEnds {
  Jet2<double> from, to;
  Bounds range() const { return {std::min(from.f, to.f), std::max(from.f, to.f)}; }
};

// F by s from 0 to 1.
class LawPath {
 public:
  // From a place to another one.
  LawPath(const SpringLaw& of, const LawPlace& from, const LawPlace& to, double t_from, double t_to);
  // As the motion goes on from a place.
  LawPath(const SpringLaw& of, const LawPlace& from, double t_from, double t_to);

  double force(double s) const { return along(s).f; }
  Jet2<double> along(double s) const;  // F, and its first derivative by s
  LawEnds ends() const { return {along(0), along(1)}; }
  // The same with v as it is at s, of a law that varies with it.
  Jet2<double> moving_along(double s) const;
  bool moves() const { return of_.F->depends_on_rate(); }
  bool by_rate() const { return of_.by_rate; }
  // What the law depends on at s, with the rate there: not the derivative of d, which in a short step is rounding.
  Arguments<double> moving(double s) const;
  Bounds force(double from, double to) const;
  // The same, closer to it in short pieces without a switch where x, or v, occurs twice, as in x/√(x² + ε), which
  // arithmetic on intervals alone makes far too wide; for more work.
  Bounds close_force(double from, double to) const;
  double slope(double s) const;  // of F by x
  bool asks_tables() const { return of_.F->asks_tables(); }
  void cubics(double s, std::span<int> out) const { of_.F->cubics(by_rate() ? moving(s) : arguments(s), out); }
  // Of a spring, d and ḋ at s as moving() has them.
  LawPlace place(double s) const { return {at(s), rate_ + s * (change_ + (1 - s) * bulge_)}; }

 private:
  using Vector = Vector3;
  void lead(const Vector& from, const Vector& from_rate, const Vector& step, const Vector& end_rate, double extent);
  Vector at(double s) const { return c_[0] + s * (c_[1] + s * (c_[2] + s * c_[3])); }
  Vector derivative(double s) const { return c_[1] + s * (2 * c_[2] + 3 * s * c_[3]); }
  Arguments<double> arguments(double s) const;
  Arguments<Bounds> reached(double from, double to) const;
  Bounds component(int k, double from, double to) const;
  Bounds rate_component(int k, double from, double to) const;

  const SpringLaw& of_;
  const double t_, h_;
  std::array<Vector, 4> c_;
  Vector rate_, change_, bulge_;  // of the rate: where the step begins, over it, beyond a straight line in its middle
  double error_ = 0, v_ = 0;
};

}  // namespace poinsot
