// The state of a mechanism without degrees of freedom at a time t: Φ(q, t) = 0 by Newton's method with corrections (14)
// until their 2-norm is below the tolerance, then G v = ν (15b) and G a = γ (16) with the matrix at the solution.
//
// What it finds depends on where it begins. How sure one may be of it is said by the corrections: by Newton and
// Kantorovich the solution is the only one about the beginning where the second is at most a quarter of the first.
#pragma once

#include <cstdint>

#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "integrators/state.h"
#include "integrators/stepping/step_system.h"

namespace poinsot {

class PrescribedState {
 public:
  PrescribedState(const Run& run, PhaseClock& clock);

  Status prepare() { return system_.prepare(); }
  // x at t from the position x.q; the problem stands there. What corrections come to is added to `beyond`.
  // `carefully`: with matrices of its own, and up to what rounding allows where that is less than the tolerance.
  Status find(double t, double tolerance, bool carefully, State& x, Eigen::VectorXd& beyond);
  // Corrects what find() found, with the matrices of where it came to, until what is left of its error changes
  // velocities by no more than the tolerance, relatively. False where that leads elsewhere: it was found to be certain
  // on too little.
  bool sharpen(double t, double tolerance, State& x, Eigen::VectorXd& beyond);
  // The second correction over the first; infinite where the first is so large that nothing is to be said.
  double contraction() const { return contraction_; }
  bool predicts() const { return refresh_ != Refresh::before_step; }  // the original study's codes predict nothing

  // The matrix where the problem stands, and the sign of its determinant as linear solvers know it.
  Status refresh(double t) { return system_.refresh(t, {}, {}, {}, {}); }
  std::uint64_t orientation() { return system_.orientation(); }

 private:
  using Vector = Eigen::VectorXd;

  Status find_position(double t, double tolerance, bool carefully, State& x, Vector& beyond);
  Status solve(double t);
  void correct(State& x, Vector& beyond);
  Status find_rates(double t, State& x);
  double largest_turn() const;

  const Run& run_;
  Problem& problem_;
  const Settings& settings_;
  const Refresh refresh_;
  StepSystem system_;
  Vector delta_, q_next_, v_before_;
  bool slow_ = false;  // corrections did not shrink as they should
  double last_ = 0;    // of corrections
  double contraction_ = 0;
};

}  // namespace poinsot
