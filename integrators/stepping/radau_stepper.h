// One step of the three-stage Radau IIA method after the other, on the acceleration level, with projection.
//
// Collocation at c = ((4 − √6)/10, (4 + √6)/10, 1) of δq' = T(δq)⁻¹ v, v' = a in the coordinates δq about the start of
// the step (explicit_stepper.h), with the stages' accelerations and multipliers as unknowns:
//
//   M a_i + Gᵀλ_i − Q = 0,   G a_i − γ = 0   at (q_n ⊞ δq_i, v_i),
//   v_i = v_n + h Σ A_ij a_j,   δq_i = h Σ A_ij T(δq_j)⁻¹ v_j      (in rA by sweeps, which contract by h |ω̄|)
//
// Index 1: no order is lost in the multipliers, as it would be in index 2 or 3, and nothing is scaled by powers of h.
// The stage at the end of the step is projected onto Φ = 0 and G v = ν (consistent.h).
//
// Newton's matrix has the exact stiffness and damping of every stage: with D_i and K_i at stage i, its block rows are
//   Σ_j (δ_ij M_i + h A_ij D_i + h² (A²)_ij K_i) Δa_j + G_iᵀ Δλ_i,   G_i Δa_i,
// one linear system of 3 n unknowns. (One point's D and K for all stages would let the eigenvectors of A take it apart,
// but a stiff spring that turns by a small angle within the step would already make that iteration diverge.) It is kept
// over steps of the same length while it converges well; starting values are extrapolated. Error estimate of order 3,
// filtered by M + hμ D + h²μ² K with the real eigenvalue μ of A. E. Hairer, G. Wanner, "Solving Ordinary Differential
// Equations II", sec. IV.8.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/linearization.h"
#include "integrators/stepping/narrow_gap.h"
#include "integrators/stepping/passage.h"
#include "integrators/stepping/singular_switch.h"
#include "integrators/stepping/step_control.h"

namespace poinsot {

class RadauStepper {
 public:
  using Vector = Eigen::VectorXd;

  RadauStepper(Problem& problem, LinearSystems& systems, double rtol, double atol, Statistics& statistics,
               PhaseClock& clock);

  Status prepare();
  // From a consistent state. The problem stands there afterwards.
  Status start(const State& state);

  // A step whose explicit Euler error is small; no evaluation.
  double first_step(double end) const;
  // Stages of a step to time `to`; its error, 1 being the tolerance. The state stays what it is.
  Status attempt(double to, double& error);
  // The motion shortly beyond the state, as its accelerations lead it on, in interpolated().
  Status lead(double t);
  // Where an attempted step ends, by position and velocity; the problem stands there.
  const State& trial_end();
  // Makes the end of the attempted step the state. Where its projection moves it by more than the error, so much is the
  // error. The state is still the old one where it cannot be projected, or where the error is above `most`.
  Status complete(double& error, double most = 1);
  // The motion within the completed step at time t, consistent, in interpolated(): a shorter step from where that one
  // began, because the collocation polynomial has order 3 only; that polynomial where Newton's method does not take the
  // shorter step.
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

  // Whether steps of the same length are worth their kept matrix.
  bool converges_fast() const { return fast_; }
  bool beside_singular() { return consistent_.beside_singular(); }  // since asked last
  const State& state() const { return state_; }
  const State& interpolated() const { return sample_; }

 private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  static std::span<double> column(Columns& m, Eigen::Index k) {
    return {m.col(k).data(), static_cast<std::size_t>(m.rows())};
  }

  // The matrices of the stages of a step of length h; h = 0: none.
  struct Linearized {
    explicit Linearized(const Problem& problem)
        : at{Linearization(problem), Linearization(problem), Linearization(problem)} {}
    std::array<Linearization, 3> at;
    double h = 0;
    bool is_for(double step) const { return std::abs(step - h) <= 1e-9 * step; }  // differences of times are rounded
  };

  template <class Sink>
  static void write_stages(const Linearized& linear, double h, int n, int nv, Sink&& entry);
  template <class Sink>
  static void write_filter(const Linearized& linear, double h, int nv, Sink&& entry);
  void stand_at_stage(const State& from, double to, Eigen::Index i);
  Status refresh(const State& from, double to, Linearized& linear);
  void forget();
  Status take_rows();
  Status stages(const State& from, double to, Linearized& linear);
  Status newton(const State& from, double to, Linearized& linear);
  void predict(const State& from, double h);
  void move(const State& from, double h, int sweeps);
  void set_scale(const State& from, const Vector& q, const Vector& v);
  Status error_of(const State& from, double h, double& error);
  void end_of_step(const State& from, double to, State& at);

  Problem& problem_;
  TimedSystem system_, filter_;
  Consistent consistent_;
  Passage passage_;
  NarrowGap gap_;
  Linearized step_, within_;               // within_: of samples
  const Linearized* in_solver_ = nullptr;  // whose matrix system_ has factored; filter_'s is always that of step_
  const double rtol_, atol_;
  const Eigen::Index nv_, n_;
  Statistics& statistics_;
  int revision_;  // of the rows that step_ and within_ are of

  State state_, next_, sample_, before_, stage_;  // before_: where the completed step began
  Columns Z_, V_, dQ_;                            // (a, λ), velocity and δq of the stages
  Columns Z_before_;                              // of the completed step
  double h_ = 0, h_before_ = 0;                   // h_before_ = 0: nothing to extrapolate
  Columns R_, V_old_, dQ_old_, rates_;
  bool fast_ = false;
  double convergence_ = 1;  // θ/(1 − θ)
  double counted_ = 0;      // rate of the fastest counted angle at the state, rad/s
  ErrorNorm norm_;
  Vector sizes_, sizes_next_, scale_, change_, e_, filtered_;
};

}  // namespace poinsot
