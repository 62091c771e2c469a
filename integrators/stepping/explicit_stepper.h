// One step of an explicit Runge–Kutta pair after the other, on the acceleration level, with projection.
//
// State of a step: y = (δq, v), position q = q_n ⊞ δq (Runge–Kutta–Munthe-Kaas: in rA δq holds rotation vectors in the
// body frame, in rp and reps ⊞ is an addition), with
//
//   δq' = T(δq)⁻¹ v,   v' = a,   [M Gᵀ; G 0] [a; λ] = [Q; γ]:   one assembly, factorization and solve a stage
//
// f(y_{n+1}) is the first stage of the next step. Its factorization serves the projection onto the constraints as well
// (consistent.h), which costs neither a stage nor the order.
//
// Beside a singular position (where G loses rank, at a distance τ in time) a stage that is off the constraints by e has
// accelerations wrong by e/τ, and error control would creep up to the point and never pass it. Accelerations of points
// on the constraints stay smooth through it: with Stages::projected every stage is projected before it is evaluated, at
// twice the cost, and steps go over the singular position at their usual length.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/narrow_gap.h"
#include "integrators/stepping/passage.h"
#include "integrators/stepping/runge_kutta_pair.h"
#include "integrators/stepping/singular_switch.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/stiffness.h"

namespace poinsot {

class ExplicitStepper {
 public:
  using Vector = Eigen::VectorXd;

  ExplicitStepper(const RungeKuttaPair& pair, Problem& problem, LinearSystems& systems, double rtol, double atol,
                  Statistics& statistics, PhaseClock& clock);

  Status prepare() { return consistent_.prepare(); }
  // From a consistent state. The problem stands there afterwards.
  Status start(const State& state);

  // After start(): see Consistent.
  void expect(double t, std::span<const double> a, double turned, const Consistent& other) {
    consistent_.expect(t, a, turned, other);
  }

  // Hairer's automatic choice; one evaluation.
  Status first_step(double end, double& h);
  enum class Stages { as_they_come, projected };
  // Stages and y_{n+1} of a step to time `to`; its error, 1 being the tolerance. The state stays what it is.
  Status attempt(double to, Stages stages, double& error);
  // The motion shortly beyond the state, as its accelerations lead it on, in interpolated().
  Status lead(double t);
  // Where an attempted step ends, by position and velocity; the problem stands there.
  const State& trial_end();
  // Makes the attempted step the state: f(y_{n+1}), projection. Where that moves it by more than the error, so much is
  // the error. The state is still the old one where the result cannot be projected, or where the error is above `most`.
  Status complete(double& error, double most = 1);
  // The same in two: whether the attempted step may stand, where there is no failure and the error is not above `most`;
  // and makes it the state. Between the two whether it, or a stage, comes by a singular position.
  Status examine(double& error, double most);
  bool comes_by_singular();
  void keep();
  // The motion within the completed step at time t, consistent, in interpolated(). The problem stands there. Where the
  // step is so long that the polynomial is too far off the constraints, a shorter step from where that one began.
  Status interpolate(double t);
  // Makes the state what it was before the completed step.
  void take_back();
  // Before the state is given out: next to a singular position it becomes the limit of states beside. Fails with
  // singular_position where there is none.
  Status give() { return passage_.give(state_, sample_); }
  // Before the next attempt: brings up to date what is discrete. The problem stands at the state.
  Status settle();
  // Of redundant rows keeps others where those kept are not the best here: true where they are others now.
  bool choose_rows();
  // Goes over a switch of the data, on to the time just past it; the state is else what it was.
  Status cross(double t);
  // Over one of a law that lies at a singular position, so near that accelerations vary linearly up to it: whether that
  // was possible, and for how long the position is near, as Run has it. From where the last step began, or ended.
  bool cross_singular(Before from, double t, double& singular_for);
  bool near_singular() const { return consistent_.amplification() > 1; }
  // Whether stability holds the steps, not accuracy.
  bool stiff() const { return stiffness_.stiff(); }
  // Whether accuracy holds them for a part of the motion that has decayed below the tolerance.
  bool held_by_the_decayed() const { return stiffness_.decayed_below(rtol_); }
  double last_step() const { return h_; }
  bool beside_singular() { return consistent_.beside_singular(); }  // since asked last

  const State& state() const { return state_; }
  const State& interpolated() const { return sample_; }

 private:
  // y_n + h Σ weight k
  void advance(double h, Terms terms, Vector& y) const;
  Status norm(Terms terms, double& size);
  // Within the attempt, where the error asks for it.
  bool end_is_evaluated() const { return error_needs_last_ || project_stages_; }
  Status evaluate(State& at, const Vector& y, Eigen::Index k);
  Status run_through_stages(double to, State& at);
  bool ends_agree();
  void test_stiffness();
  Status prepare_dense();
  void stand_at_end();
  Status project_end(double& error, double most);
  Status by_polynomial(double t);
  Status by_short_step(double t);

  const RungeKuttaPair& pair_;
  Problem& problem_;
  Consistent consistent_;
  Passage passage_;
  NarrowGap gap_;
  const double rtol_, atol_;
  const std::size_t nv_;
  const Eigen::Index last_;  // index of k_{s+1}
  const bool error_needs_last_;
  int revision_;  // of the rows that the state is on
  bool project_stages_ = false;
  bool settled_ = false;  // the last state evaluated lay beside a singular position and was made the limit there

  State state_, next_, sample_;
  Vector zeros_;    // 2 nv
  Vector q_n_;      // where the step began; y_n_ = (0, v_n)
  Vector y_n_, y_;  // 2 nv
  Vector g_;        // where the last stage stands
  Eigen::MatrixXd k_, r_;
  double h_ = 0, t_n_ = 0;
  bool elsewhere_ = false;
  enum class Dense { missing, ready, too_coarse } dense_ = Dense::missing;
  ErrorNorm norm_;
  Vector sizes_, sizes_next_, scale_, combined_;
  StiffnessTest stiffness_;
};

}  // namespace poinsot
