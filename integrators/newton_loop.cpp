#include "integrators/newton_loop.h"

#include <fmt/format.h>

namespace poinsot {

Status NewtonLoop::not_converged(double t, double correction) const {
  if (!std::isfinite(correction)) {
    return {Failure::not_finite, t,
            fmt::format("at t = {:.9g} s Newton's correction is not finite; try a smaller step", t)};
  }
  Eigen::Index largest = 0;
  delta_.cwiseAbs().maxCoeff(&largest);
  return {Failure::not_converged, t,
          fmt::format("at t = {:.9g} s Newton's method did not converge: after {} iterations the correction is {:.3g}, "
                      "the tolerance {:.3g}; the largest correction is that of {}; try a smaller step, the exact "
                      "jacobian or a larger tolerance",
                      t, settings_.max_iterations, correction, settings_.tolerance,
                      problem_.describe_unknown(static_cast<int>(largest)))};
}

}  // namespace poinsot
