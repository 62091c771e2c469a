#include "bench/view/comparison.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "bench/study/motion.h"
#include "core/so3.h"

namespace poinsot::view {
namespace {

// Position and Euler parameters of a body, with their derivatives.
struct Pose {
  Eigen::Matrix<double, 7, 1> x, v, a;
};

Pose pose(const BodyState& body) {
  const Eigen::Quaterniond q(body.A), w(0, body.w.x(), body.w.y(), body.w.z()),
      wd(0, body.wd.x(), body.wd.y(), body.wd.z());
  const Eigen::Quaterniond qd((q * w).coeffs() / 2);
  Pose p;
  p.x << body.r, q.coeffs();
  p.v << body.rd, qd.coeffs();
  p.a << body.rdd, ((qd * w).coeffs() + (q * wd).coeffs()) / 2;
  return p;
}

// Between two frames h s apart, at a share s of h. A straight line would be off by h²/8 of the acceleration, which is
// more than what good methods are apart: Hermite's polynomial of degree 5 takes velocities and accelerations as well.
// Where accelerations are not those of the motion it moves the cubic further than velocities moved the line, and the
// cubic is taken.
BodyState between(const BodyState& from, const BodyState& to, double h, double s) {
  const Pose p = pose(from);
  Pose q = pose(to);
  if (p.x.tail<4>().dot(q.x.tail<4>()) < 0)
    for (auto* of : {&q.x, &q.v, &q.a}) of->tail<4>() *= -1;
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const Eigen::Matrix<double, 7, 1> line = p.x + s * (q.x - p.x);
  const Eigen::Matrix<double, 7, 1> cubic =
      p.x + (3 * s2 - 2 * s3) * (q.x - p.x) + h * (s - 2 * s2 + s3) * p.v + h * (s3 - s2) * q.v;
  const Eigen::Matrix<double, 7, 1> quintic =
      p.x + (10 * s3 - 15 * s4 + 6 * s5) * (q.x - p.x) + h * (s - 6 * s3 + 8 * s4 - 3 * s5) * p.v +
      h * (-4 * s3 + 7 * s4 - 3 * s5) * q.v + h * h / 2 * (s2 - 3 * s3 + 3 * s4 - s5) * p.a +
      h * h / 2 * (s3 - 2 * s4 + s5) * q.a;
  const auto& best = (quintic - cubic).norm() > (cubic - line).norm() ? cubic : quintic;
  BodyState body;
  body.r = best.head<3>();
  body.A = Eigen::Quaterniond(best.tail<4>().normalized()).toRotationMatrix();
  return body;
}

}  // namespace

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
      const BodyState &x = frame.bodies[b],
                      y = share == 0 ? from.bodies[b] : between(from.bodies[b], to.bodies[b], to.t - from.t, share);
      if (const double distance = (x.r - y.r).norm(); distance > most.position) {
        most.position = distance;
        most.body = b;
      }
      most.angle = std::max(most.angle, angle_between(x.A, y.A));
    }
  }
  return result;
}

}  // namespace poinsot::view
