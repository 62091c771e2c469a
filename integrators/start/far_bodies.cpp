#include "integrators/start/far_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "integrators/start/row_space.h"

namespace poinsot {
namespace {

// How long a rod of a body's mass and inertia would be, m.
double rod_length(const Body& body) {
  return std::sqrt(6 * body.inertia.trace() / body.mass);
}

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

void tell_far_bodies(const Model& model, std::vector<std::string>& notices) {
  constexpr double kMatters = kFarthest * kDependent / kRoundings;
  std::vector<double> size(model.bodies.size(), 0);
  const auto reaches = [&](int body, const Vector3& s) {
    if (body == kGround) return;
    size[index(body)] = std::max({size[index(body)], s.norm(), rod_length(model.bodies[index(body)])});
  };
  for (const Row& row : model.rows) {
    reaches(row.i, row.s_i);
    reaches(row.j, row.s_j);
  }
  double most = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < size.size(); ++k) {
    const double moved =
        size[k] > 0 ? std::numeric_limits<double>::epsilon() * model.bodies[k].position.norm() / size[k] : 0;
    if (moved > most) most = moved, worst = k;
  }
  if (most <= kMatters) return;
  const Body& body = model.bodies[worst];
  notices.push_back(
      fmt::format("body '{}' is {:.3g} m from the origin and {:.3g} m long: every step rounds its position "
                  "by up to {:.1g} of that, and velocities, accelerations and forces by more; place the "
                  "origin near the mechanism",
                  body.name, body.position.norm(), size[worst], most));
}

void tell_far_joints(const Model& model, std::vector<std::string>& notices) {
  constexpr double kFar = 4;
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
