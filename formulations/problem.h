// The seam between a mechanism in one formulation and everything that solves it.
//
// A Problem is an immutable system (shared between threads) together with the workspace of one thread. It evaluates
//
//   M(q) a + Gᵀ λ = Q(q, v, t),   Φ(q, t) = 0,   G v = ν,   G a = γ,
//
// where the formulation decides what q, v and a are, body by body: r with A (rA, v = ṙ, ω̄), with p (rp, v = ṙ, ṗ) or
// with ε (reps, v = ṙ, ε̇). Q holds the applied forces and the velocity terms of the inertia. Layout of the vectors:
// q by body, nq/bodies numbers each; v, a and position variations by body, nv/bodies numbers each, r first; λ by row,
// rows in the model's order, after them rp's normalization rows, one per body.
//
// First set_position, then set_velocity, then ask; a new position invalidates the velocity. The problem keeps what it
// needs of q and v and refers to no vector of the caller's once a call is over. Position variations δq are applied by
// retract(); a velocity v held for a time h is the variation h v (in rA: A exp(h ω̃̄)).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "core/status.h"
#include "linsolve/pattern.h"

namespace poinsot {

enum class MatrixKind {
  kinematic,   // G, nc × nv: square for a mechanism without degrees of freedom
  rates,       // ∂(G v − ν)/∂q, nc × nv: how the velocity constraints vary with the position
  consistent,  // [M Gᵀ; G 0]: accelerations and multipliers of a state, mass-orthogonal projections
  simplified,  // the original study's Newton matrix: no variation of the reactions (nor, in rp and reps, of the
               // inertia)
  exact,       // the Newton matrix
};

// How a step's unknown acceleration δa acts on the levels: δv = velocity δa, and the scaled position variation
// z = δq/position is the unknown of the step's linear system. Implicit Euler: 1, h, h².
struct StepScale {
  double acceleration = 1;
  double velocity = 0;
  double position = 0;
};

// The angle that turns fastest of those a step must not turn by half a turn, because positions tell them up to full or
// half turns only: of torsion springs, driven angles, and angles of joints that are followed.
struct CountedTurn {
  double rate = 0;                               // rad/s
  int torsion = -1, driver = -1, followed = -1;  // which: index of the model's torsion spring, row, or followed angle
  double across = 1;  // of its direction on body j, what lies across the axis; at 0 there is no angle
};

// Largest |Φ| and |G v − ν| of rows.
struct LargestResidual {
  double position = 0, velocity = 0;
};

class Problem {
 public:
  virtual ~Problem() = default;
  virtual std::unique_ptr<Problem> clone() const = 0;  // same system, own workspace
  // The same bodies and forces, discrete state included, with other rows: those of the model listed take no part.
  virtual std::unique_ptr<Problem> clone_without(std::span<const int> dropped) const = 0;

  virtual std::string_view formulation() const = 0;
  virtual const Model& model() const = 0;
  // The model's row of each row that takes part (dependent ones are left out), without rp's normalization rows.
  virtual const std::vector<int>& model_rows() const = 0;
  // Counts how often accept() has exchanged rows for others: their number stays, patterns are to be asked for anew.
  virtual int revision() const { return 0; }
  int bodies() const { return bodies_; }
  int nq() const { return nq_; }
  int nv() const { return nv_; }
  int nc() const { return nc_; }

  // State of the model's bodies at the start, in this formulation's coordinates; the same from and to body states.
  virtual void from_bodies(std::span<const BodyState> states, std::span<double> q, std::span<double> v) const = 0;
  // Of the first bodies, as many as there are states. Needs position and velocity set; `a` as solved.
  virtual void to_bodies(std::span<const double> a, std::span<BodyState> states) const = 0;
  // Where some of them stand: by body r and A by columns, as intrinsic_formulation() has them in q.
  virtual void poses(std::span<const int> bodies, std::span<double> out) const = 0;

  virtual void retract(std::span<const double> q, std::span<const double> dq, std::span<double> q_out) const = 0;

  virtual void set_position(double t, std::span<const double> q) = 0;
  virtual void set_velocity(std::span<const double> v) = 0;

  // Φ by row; a velocity row (pfaffian) gives 0.
  virtual void position_residual(std::span<double> Phi) const = 0;
  // G v − ν by row, velocity rows included.
  virtual void velocity_residual(std::span<double> r) const = 0;
  virtual void nu(std::span<double> out) const = 0;
  virtual void gamma(std::span<double> out) = 0;
  // M v at the position set: the momentum of any v, in the dual of the formulation's velocities.
  virtual void momentum(std::span<const double> v_in, std::span<double> out) const = 0;
  // Gᵀλ.
  virtual void constraint_forces(std::span<const double> lambda, std::span<double> out) = 0;
  // M a + Gᵀλ − Q; an empty λ stands for none.
  virtual void equations_of_motion(std::span<const double> a, std::span<const double> lambda,
                                   std::span<double> out) = 0;
  // A step's residual, nv + nc: M a + Gᵀλ − Q, then Φ/position by row, (Ψv − f)/velocity for velocity rows.
  virtual void step_residual(const StepScale& scale, std::span<const double> a, std::span<const double> lambda,
                             std::span<double> out) = 0;

  virtual Pattern pattern(MatrixKind kind) const = 0;
  // Writes the matrix of `kind` at the current point into values, where blocks that share an entry share a place;
  // whatever the places of its blocks held before, others are to hold zeros:
  //   [acceleration M + velocity ∂(Ma+Gᵀλ−Q)/∂v] T⁻¹ + position ∂(Ma+Gᵀλ−Q)/∂q,  Gᵀ;   G, 0
  // with T = T(dq) the tangent of the retraction that led here by dq from where the step began. dq may be empty: T = I.
  virtual void assemble(MatrixKind kind, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                        std::span<const double> lambda, std::span<const int> slots, std::span<double> values) = 0;
  // z ← T(dq)⁻¹ z for the body part of a solution: the acceleration correction δa.
  virtual void lower(std::span<const double> dq, std::span<double> z) const = 0;

  // Whether accept() has something to do after every step.
  virtual bool has_discrete_state() const = 0;
  // Whether it has where the problem stands: rows stand in for others than when it was called last.
  virtual bool exchanges_rows() const = 0;
  // The step to (t, q, v) is accepted, and the problem stands there. What is discrete is brought up to date: turns of
  // torsion springs and angles that are followed, the body-fixed frames of reps, the choice among rows that depend on
  // one another. May rewrite q, v, a and λ (not what they mean) and says so; then set_position and set_velocity are due
  // again. Fails where rows left out do not follow from the others any more.
  virtual Status accept(double t, std::span<double> q, std::span<double> v, std::span<double> a,
                        std::span<double> lambda, bool& rewritten) = 0;
  // Whether accept() of a step to t that ends with accelerations a, at the end of which the problem stands, or where
  // Newton's method saw it last, would find all as it is; then it is done.
  virtual bool accepts_as_is(double /*t*/, std::span<const double> /*a*/) {
    return !has_discrete_state() && !exchanges_rows();
  }
  // The rows that take part depend on one another where the problem stands, or all but do. Whether others could take
  // their place, and do so now: then λ of the state (t, q, v) is that of those, and revision() has gone up. The problem
  // stands at that state afterwards.
  virtual bool choose_rows_here(double t, std::span<const double> q, std::span<const double> v,
                                std::span<double> lambda) {
    (void)lambda;
    set_position(t, q);
    set_velocity(v);
    return false;
  }
  // Of the scene's rows where the problem stands, those left out because they follow from others as well: of the bodies
  // of to_bodies().
  virtual LargestResidual largest_residual() const = 0;

  // Force (N, global) and moment about point_j of the group (N m, global) on body j by the rows of a group.
  virtual void reaction(int group, std::span<const double> lambda, Vector3& force, Vector3& moment) const = 0;
  // Kinetic and potential energy (gravity, springs, torsion springs), J.
  virtual double energy() const = 0;
  // Which function of time or law is not finite where the problem stands, and when: "at t = 1 s driver 'motor': ...";
  // empty where none is. For messages of runs that failed.
  virtual std::string fault() const { return {}; }
  // Angle of a torsion spring of the model, and of an angle that is followed: rad, with full turns.
  virtual double twist(int torsion) const = 0;
  virtual double followed_angle(int of) const = 0;
  // Counts their turns on from those of a problem of the same kind, of the same model.
  virtual void count_turns_from(const Problem& other) = 0;
  // |ω| of a body, rad/s, and the largest of one. Need the velocity.
  virtual double turn(int body) const = 0;
  virtual double fastest_turn() const = 0;
  virtual CountedTurn counted_turn() const = 0;  // needs the velocity
  // How messages speak of unknown k of the step's linear system: a body's coordinates or a constraint row.
  virtual std::string describe_unknown(int k) const = 0;

 protected:
  int bodies_ = 0, nq_ = 0, nv_ = 0, nc_ = 0;
};

}  // namespace poinsot
