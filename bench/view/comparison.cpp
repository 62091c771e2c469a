#include "bench/view/comparison.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "bench/study/motion.h"

namespace poinsot::view {

std::vector<Apart> apart(const Motion& first, const Motion& second) {
  std::vector<Apart> result;
  const std::vector<Frame>& frames = second.frames;
  std::size_t k = 0;
  for (const Frame& frame : first.frames) {
    if (frame.t < frames.front().t || frame.t > frames.back().t) break;
    while (k + 1 < frames.size() && frames[k + 1].t <= frame.t) ++k;
    const Frame &from = frames[k], &to = frames[std::min(k + 1, frames.size() - 1)];
    const double share = to.t > from.t ? (frame.t - from.t) / (to.t - from.t) : 0;
    Apart& most = result.emplace_back();
    for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
      const BodyState &x = frame.bodies[b], &y = from.bodies[b], &z = to.bodies[b];
      const Eigen::Vector3d r = y.r + share * (z.r - y.r);
      const Eigen::Matrix3d A =
          share == 0 ? y.A : Eigen::Quaterniond(y.A).slerp(share, Eigen::Quaterniond(z.A)).toRotationMatrix();
      if (const double distance = (x.r - r).norm(); distance > most.position) {
        most.position = distance;
        most.body = b;
      }
      most.angle = std::max(most.angle, study::angle_between(x.A, A));
    }
  }
  return result;
}

}  // namespace poinsot::view
