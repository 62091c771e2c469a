// Newton's method for the unknowns z = (a, λ) of one step, as the implicit integrators share it.
//
//   matrix · correction = −residual(z),  z ← z ⊕ correction
//
// What a step's residual, matrix and ⊕ are, the integrator says. Nothing is allocated in a regular step. It ends
//   relative      where no body's acceleration is corrected by more than tolerance · max(|g|, rms of accelerations), a
//                 turn counted as the way it makes at the model's longest arm. λ is not looked at: it stands linearly
//                 in the residual, so that its correction leaves nothing behind with a matrix of this step. With one of
//                 steps before, the largest correction of λ is to be below tolerance · max |λ| besides. It moves no
//                 body by more than a thousandth of that arm, from where the constraints held to so much.
//   correction    where the 2-norm of the correction of all unknowns is below the tolerance, as in the original study,
//                 (46)
// by the settings' key "stopping", or where it can do no better in this arithmetic, once corrections have stopped to
// shrink (with small steps Φ/h² magnifies the rounding of Φ; beside a singular position λ is noise, and the part of a
// that the constraints say least of): where
//   positions are corrected by no more than their rounding, 16 ε √bodies · max(1, |q|): that of each body's orientation
//   moves all that hang on it, which adds up to √N of it over N bodies in a row;
//   or than 64 ε max(1, |q|) times what rows that are off by one move them by, more beside a singular position;
//   or Φ is so small and |M a + Gᵀλ − Q| ≤ 256 ε (|M a| + |Gᵀ||λ|), in maximum norms.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "integrators/stepping/step_system.h"
#include "integrators/stepping/vectors.h"
#include "integrators/stopping_test.h"

namespace poinsot {

class NewtonLoop {
 public:
  using Vector = Eigen::VectorXd;

  // divides: a step that fails is done in parts, unless the settings want none.
  NewtonLoop(Problem& problem, StepSystem& system, const Settings& settings, Refresh refresh, Statistics& statistics,
             bool divides = true);

  // The step to t, for the unknowns z, from what they are. `position` is δq/δa of the step, `q` the vector that
  // positions' rounding is measured by.
  //   residual(r)     writes the residual at z, nv + nc
  //   matrix(ahead)   assembles and factors, for what is ahead: Status
  //   correct(delta)  turns the linear system's solution into the correction and applies it to z: Status
  template <class Residual, class Matrix, class Correct>
  Status solve(double t, double position, const Vector& z, const Vector& q, Residual&& residual, Matrix&& matrix,
               Correct&& correct) {
    if (gradient_ < 0) measure_gradient();
    const double far_off = kFar * std::min(1.0, arm_ * arm_);
    double correction = 0, before = INFINITY, off = 0;
    bool of_this_step = false;
    stalled_ = false;
    since_stall_ = std::numeric_limits<int>::max() / 2;
    for (int k = 0; k < settings_.max_iterations; ++k) {
      residual(delta_);
      off = delta_.tail(problem_.nc()).template lpNorm<Eigen::Infinity>();
      if (stalled_ && balanced(position, z, q)) return {};
      delta_ = -delta_;
      if (due(refresh_, k, slow_ || !system_.ready())) {
        if (Status status = matrix(Ahead{span(delta_), refresh_ == Refresh::every_iteration}); !status.ok())
          return status;
        slow_ = false;
        of_this_step = refresh_ != Refresh::before_step;
      }
      if (Status status = system_.solve(t, span(delta_)); !status.ok()) return status;
      if (Status status = correct(delta_); !status.ok()) return status;
      correction = stopping_ == Stopping::relative ? relative(z, of_this_step) : delta_.norm();
      ++statistics_.newton_iterations;
      if (k > 0) {
        statistics_.convergence.sum += correction / before;
        ++statistics_.convergence.count;
        slow_ = !(correction < kSlow * before);
      }
      stalled_ = correction > 0.5 * before;
      since_stall_ = stalled_ ? 0 : since_stall_ + 1;
      if (correction <= settings_.tolerance && moved_ * position <= kFar * arm_ && off * position <= far_off) return {};
      if (stalled_ && is_rounding(t, position, q)) return {};
      before = correction;
      if (!std::isfinite(correction)) break;
    }
    return not_converged(t, correction, position, off);
  }

  // Whether corrections had stopped to shrink in one of the last iterations of a step.
  bool stalled() const { return since_stall_ < 4; }
  // The step's size has changed: a kept matrix is that of another.
  void renew() { slow_ = true; }

 private:
  // A kept matrix is made anew where corrections shrink by less than this: four more iterations would cost more.
  static constexpr double kSlow = 0.25;
  // A correction that moves a body by more of the longest arm is none to end with, whatever it is compared with, nor is
  // one of positions that were so far off the constraints: where a step has no solution accelerations may grow until
  // corrections are small beside them, and a matrix that is nearly singular answers by λ alone.
  static constexpr double kFar = 1e-3;

  double relative(const Vector& z, bool of_this_step);
  bool is_rounding(double t, double position, const Vector& q);
  double steepness(double t, double position);
  void measure_gradient();
  bool balanced(double position, const Vector& z, const Vector& q);
  Status not_converged(double t, double correction, double position, double off) const;

  Problem& problem_;
  StepSystem& system_;
  const Settings& settings_;
  Refresh refresh_;
  Stopping stopping_;
  Statistics& statistics_;
  bool divided_;  // a step that failed was done in parts to where that does not help
  double arm_;    // m, the longest of a body to a constraint
  Vector delta_, momentum_, rows_;
  double moved_ = 0;      // m/s², the largest correction of a body's acceleration where those are compared
  double gradient_ = -1;  // |Gᵀ|, of the first step: directions and arms stay what they are
  bool stalled_ = false;
  int since_stall_ = 0;  // iterations
  bool slow_ = false;    // the last corrections did not shrink as they should
};

}  // namespace poinsot
