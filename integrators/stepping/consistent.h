// A state made consistent: accelerations and multipliers, mass-orthogonal projections onto the constraints.
//
//   [M Gᵀ; G 0] [a; λ] = [Q; γ]
//   positions: M δq + Gᵀμ = 0, G δq = −Φ, q ← q ⊞ δq, repeated;   velocities: M δv + Gᵀμ = 0, G δv = ν − G v
//
// From afar (project_position, project_velocity) every correction of the position has a matrix of its own. From nearby
// (project) all share one: a method that leaves the constraints by the size e of its local error is brought back by
// simplified Newton steps with the factorization that belongs to the accelerations; one correction leaves e². One step
// of iterative refinement makes a and λ belong to the projected state, again up to e². Neither costs a factorization or
// the order.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "integrators/stepping/step_system.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

class Consistent {
 public:
  // Part of a run: counted and timed there.
  Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock);
  // Beside a run: with a linear system of its own, counted nowhere.
  Consistent(Problem& problem, const LinearChoice& choice);

  // Analyses the pattern. Where steps must not allocate, call it before the clock starts; else the first factorization
  // does.
  Status prepare();
  // Factors [M Gᵀ; G 0] at the point where the problem stands.
  Status factor(double t);
  // b ← [M Gᵀ; G 0]⁻¹ b with the factorization at hand.
  Status solve(double t, std::span<double> b) { return system_.solve(t, b); }

  // The problem stands at (t, q, v); z = (a, λ) is written. The factorization belongs to this point.
  Status accelerations(double t, std::span<double> z);
  // Moves q onto Φ = 0 to rounding; the problem stands at the result. Fails with inconsistent_state where it cannot.
  Status project_position(double t, std::span<double> q);
  // The problem stands at (t, q) and (·, v); v and the problem are moved onto G v = ν.
  Status project_velocity(double t, std::span<double> v);

  // The same for a state, `at`.
  void stand(const State& at);
  Status accelerations(State& at);
  // M a + Gᵀλ − Q and G a − γ of a state the problem stands at.
  void residual(const State& at, std::span<double> out);
  // Moves q and v onto the constraints with the factorization at hand, which belongs to a state nearby, and says
  // whether they moved; the problem stands at the result. Fails with singular_position, without words, where rounding
  // would decide about velocities.
  Status project(State& at, bool& moved);
  // How far project() moved the last state, δq and then δv.
  std::span<const double> moved_by() const { return span(moved_by_); }
  // Of project(): how many times more than it usually does it moves positions for what they are off the constraints,
  // |δq|/|Φ|: 1, or far more beside a singular position, as the inverse of the distance. The last time, and whether
  // ever since asked last.
  double amplification() const { return amplification_; }
  bool beside_singular();
  // Whether accelerations where the problem stands are far larger than they were, and than forces and γ account for, so
  // that [M Gᵀ; G 0]⁻¹ is what makes them, next to a singular position.
  bool made_of_rounding(const State& at);
  // Whether such a state has gone another way than the velocities led: they differ by a hundredth from what they were
  // before. Rounding has then chosen among branches.
  bool leaves_branch(const State& at);
  // A step ends there that leaves none.
  void follow(const State& at);
  // x ← its part along the constraints, M-orthogonally, with the factorization at hand; nv numbers. The problem stands
  // at `at`, before and after.
  Status along_constraints(const State& at, std::span<double> x);
  // (a, λ) of the state the problem stands at, from those of a state nearby and its factorization.
  Status refine(State& at);
  // Accelerations, projection, refinement: the consistent state beside (q, v).
  Status complete(State& at);
  // Makes a state whose time is just past a switch of the data consistent on the far side of it. Where the rate of a
  // driver jumps, v does, by the least change in M: the impulse of the constraints. Positions cannot; then it fails.
  Status cross(State& at);

 private:
  // What a run lends.
  struct Aside {
    LinearSystem linear;
    Statistics statistics;
    PhaseClock clock;
  };
  Consistent(Problem& problem, std::unique_ptr<Aside>&& aside);
  Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock,
             std::unique_ptr<Aside>&& aside);

  // δq and δv for the constraints' residuals at the problem's point, in moves().
  Status position_correction(double t);
  Status velocity_correction(double t);
  void measure_steepness(double off, double moved);
  std::span<double> moves() { return std::span(rhs_.data(), nv_); }
  std::span<double> rows() { return std::span(rhs_.data() + nv_, nc_); }

  Problem& problem_;
  std::unique_ptr<Aside> aside_;
  StepSystem system_;
  bool prepared_ = false;
  double usual_steepness_ = 0, amplification_ = 1;  // of |δq|/|Φ|
  bool beside_singular_ = false;
  struct Calm {  // the last state whose accelerations were as usual
    double t = 0, usual = 0;
    Eigen::VectorXd v;
  } calm_;
  double off_ = 0;  // largest |Φ| or |G v − ν| that the last correction was for
  const std::size_t nv_, nc_;
  Eigen::VectorXd rhs_, zeros_, rows_, q_moved_, moved_by_;
};

}  // namespace poinsot
