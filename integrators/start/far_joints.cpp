#include "integrators/start/far_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/index.h"
#include "integrators/start/far_bodies.h"

namespace poinsot {
namespace {

// From the nearest of the joint's bodies; the ground is near to everything.
double arm(const Group& joint, const JointFrames& f) {
  double least = std::numeric_limits<double>::infinity();
  if (joint.i != kGround) least = std::min(least, f.s_i.norm());
  if (joint.j != kGround) least = std::min(least, f.s_j.norm());
  return least;
}

double extent(const std::vector<Body>& bodies) {
  Vector3 low = bodies.front().position, high = low;
  for (const Body& body : bodies) {
    low = low.cwiseMin(body.position);
    high = high.cwiseMax(body.position);
  }
  return (high - low).norm();
}

// How far a body is from the origin, about which scenes are written, or how long it is.
double own_size(const Body& body) {
  return std::max(body.position.norm(), rod_length(body));
}

}  // namespace

void tell_far_joints(const Model& model, std::vector<std::string>& notices) {
  constexpr double kFar = 2;
  if (model.joints.empty()) return;
  double first = 0, second = 0;  // the two longest arms
  for_each_joint(model, [&](const Group& group, const JointFrames& f) {
    const double a = arm(group, f);
    second = std::max(second, std::min(first, a));
    first = std::max(first, a);
  });
  const double centres = extent(model.bodies);
  for_each_joint(model, [&](const Group& group, const JointFrames& f) {
    const double a = arm(group, f), others = std::max(centres, a == first ? second : first);
    const bool alone = others == 0;
    const double size = alone ? own_size(model.bodies[index(group.i == kGround ? group.j : group.i)]) : others;
    if (group.body_fixed || a <= kFar * size) return;
    const auto from = [&](int body, const Vector3& s) {
      return body == kGround ? std::string()
                             : fmt::format(" {:.3g} m from '{}'", s.norm(), model.bodies[index(body)].name);
    };
    const std::string i = from(group.i, f.s_i), j = from(group.j, f.s_j);
    notices.push_back(fmt::format(
        "joint '{}' is far from its bodies:{}{}{}, where {} {:.3g} m; is its point meant?", group.name, i,
        i.empty() || j.empty() ? "" : " and", j,
        alone ? "the body's size and its way from the origin are at most" : "the mechanism without it measures", size));
  });
}

}  // namespace poinsot
