#include "integrators/stepping/newton_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace poinsot {

bool NewtonLoop::is_rounding(double position, const Vector& q) const {
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  return position * delta_.head(problem_.nv()).cwiseAbs().maxCoeff() <=
         kRounding * std::sqrt(problem_.bodies()) * std::max(1.0, q.cwiseAbs().maxCoeff());
}

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
