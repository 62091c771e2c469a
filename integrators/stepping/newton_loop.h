// Newton's method for the unknowns z = (a, λ) of one step, as the implicit integrators share it.
//
//   matrix · correction = −residual(z),  z ← z ⊕ correction,  until the 2-norm of the correction is below the tolerance
//
// or rounding lets it shrink no further. What a step's residual, matrix and ⊕ are, the integrator says. Nothing is
// allocated in a step.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "integrators/stepping/step_system.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

class NewtonLoop {
 public:
  using Vector = Eigen::VectorXd;

  NewtonLoop(const Problem& problem, StepSystem& system, const Settings& settings, Refresh refresh,
             Statistics& statistics)
      : problem_(problem),
        system_(system),
        settings_(settings),
        refresh_(refresh),
        statistics_(statistics),
        delta_(problem.nv() + problem.nc()) {}

  // The step to t. `position` is δq/δa of the step, `q` the vector that positions' rounding is measured by.
  //   residual(r)     writes the residual at z, nv + nc
  //   matrix()        assembles and factors: Status
  //   correct(delta)  turns the linear system's solution into the correction and applies it to z: Status
  template <class Residual, class Matrix, class Correct>
  Status solve(double t, double position, const Vector& q, Residual&& residual, Matrix&& matrix, Correct&& correct) {
    double correction = 0, before = INFINITY;
    for (int k = 0; k < settings_.max_iterations; ++k) {
      residual(delta_);
      if (due(k)) {
        if (Status status = matrix(); !status.ok()) return status;
        slow_ = false;
      }
      delta_ = -delta_;
      if (Status status = system_.solve(t, span(delta_)); !status.ok()) return status;
      if (Status status = correct(delta_); !status.ok()) return status;
      correction = delta_.norm();
      ++statistics_.newton_iterations;
      if (k > 0) {
        statistics_.convergence.sum += correction / before;
        ++statistics_.convergence.count;
        slow_ = !(correction < kSlow * before);
      }
      if (correction < settings_.tolerance || (correction > 0.5 * before && is_rounding(position, q))) return {};
      before = correction;
      if (!std::isfinite(correction)) break;
    }
    return not_converged(t, correction);
  }

 private:
  // A kept matrix is made anew where corrections shrink by less than this: four more iterations would cost more.
  static constexpr double kSlow = 0.25;

  bool due(int k) const {
    switch (refresh_) {
      case Refresh::every_iteration:
        return true;
      case Refresh::every_step:
      case Refresh::before_step:
        return k == 0;
      case Refresh::when_slow:
        return slow_ || !system_.ready();
    }
    return true;
  }

  // A correction that has stopped to shrink and moves positions by no more than their rounding: Newton's method cannot
  // do better in this arithmetic, whatever the tolerance asks (with small steps Φ/h² magnifies the rounding of Φ). The
  // rounding of each body's orientation moves all that hang on it; over N bodies in a row this adds up to √N of it.
  bool is_rounding(double position, const Vector& q) const;
  Status not_converged(double t, double correction) const;

  const Problem& problem_;
  StepSystem& system_;
  const Settings& settings_;
  Refresh refresh_;
  Statistics& statistics_;
  Vector delta_;
  bool slow_ = false;  // the last corrections did not shrink as they should
};

}  // namespace poinsot
