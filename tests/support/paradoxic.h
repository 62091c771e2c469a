// What mechanisms whose joints constrain too often are made of: rods, hinges, closed loops in space, on the ground or
// carried, with redundant rows or without.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/scene.h"
#include "tests/support/loops.h"

namespace poinsot::test {

struct Told {
  Frames frames = Frames::drawn;
  bool carried = false;   // by a free body, all of it turning together at the start; else by the ground, at rest
  bool redundant = true;  // else other joints stand in the place of some, and the motion is the same
};

inline const Vector3 kCarriedAt(2, -4, 5);  // rad/s

// Of a hinge.
struct Axis {
  Vector3 at, along;
};

class Paradoxic {
 public:
  Paradoxic(std::string name, const Told& told) : told_(told) {
    scene_.name = std::move(name);
    scene_.gravity = {1, -9.81, -2};
    if (told.carried) base_ = link("base", {-0.5, -0.4, 0.3}, {0.8, 0.5, -0.2}, 5);
  }

  int base() const { return base_; }

  // A rod, of the same inertia however its frame lies.
  int link(std::string name, const Vector3& from, const Vector3& to, double mass = 1) {
    Body& body = scene_.bodies.emplace_back();
    body.name = std::move(name);
    body.mass = mass;
    body.position = 0.5 * (from + to);
    body.orientation = frame(told_.frames, static_cast<int>(scene_.bodies.size()) + 2);
    const Vector3 way = to - from;
    const Matrix3 J = mass * ((way.squaredNorm() / 12 + 0.02) * Matrix3::Identity() - way * way.transpose() / 12);
    body.inertia = body.orientation.transpose() * J * body.orientation;
    body.inertia = (0.5 * (body.inertia + body.inertia.transpose())).eval();
    if (told_.carried) {
      body.angular_velocity = body.orientation.transpose() * kCarriedAt;
      body.velocity = kCarriedAt.cross(body.position);
    }
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  void hinge(int i, int j, const Axis& axis) { join(JointType::revolute, i, j, axis); }

  // A hinge, or what has to stand in its place where rows are not to be redundant.
  void hinge_or(JointType type, int i, int j, const Axis& axis) {
    join(told_.redundant ? JointType::revolute : type, i, j, axis);
  }

  void join(JointType type, int i, int j, const Axis& axis) {
    Joint& x = scene_.joints.emplace_back();
    x.name = fmt::format("joint{}", scene_.joints.size());
    x.type = type;
    x.i = i, x.j = j;
    x.point = axis.at;
    x.axis = axis.along;
    x.axis_i = axis.along.normalized();
    x.axis_j = x.axis_i.cross(Vector3(1, 2, 3)).normalized();
  }

  // Two directions, global at the start, that stay at a right angle.
  void perpendicular(int i, const Vector3& of_i, int j, const Vector3& of_j) {
    const auto in_frame = [&](int body, const Vector3& a) -> Vector3 {
      return body == kGround ? a : scene_.bodies[static_cast<std::size_t>(body)].orientation.transpose() * a;
    };
    Constraint& row = scene_.constraints.emplace_back();
    row.type = ConstraintType::DP1;
    row.i = i, row.j = j;
    row.a_i = in_frame(i, of_i), row.a_j = in_frame(j, of_j);
  }

  // Links from each hinge to the next, the last one the base; instead[k]: what stands in the place of hinge k where
  // rows are not to be redundant.
  void loop(const std::vector<Axis>& axes, const std::vector<std::pair<std::size_t, JointType>>& instead) {
    int before = base_;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const bool last = k + 1 == axes.size();
      const int next = last ? base_ : link(fmt::format("link{}", k + 1), axes[k].at, axes[k + 1].at);
      JointType type = JointType::revolute;
      for (const auto& [at, other] : instead)
        if (at == k) type = other;
      hinge_or(type, before, next, axes[k]);
      before = next;
    }
  }

  Scene& scene() { return scene_; }
  bool redundant() const { return told_.redundant; }

 private:
  Scene scene_;
  Told told_;
  int base_ = kGround;
};

// The hinges of a closed loop by lengths, twists and angles (Denavit and Hartenberg), the first link along x from the
// origin, the first hinge along z.
inline std::vector<Axis> closed_loop(const std::vector<double>& length, const std::vector<double>& twist,
                                     const std::vector<double>& angle) {
  std::vector<Axis> axes;
  Matrix3 A = Eigen::AngleAxisd(-angle[0], Vector3::UnitZ()).toRotationMatrix();
  const Matrix3 first = A;
  Vector3 at = Vector3::Zero();
  for (std::size_t k = 0; k < length.size(); ++k) {
    axes.push_back({at, A.col(2)});
    A = A * Eigen::AngleAxisd(angle[k], Vector3::UnitZ()) * Eigen::AngleAxisd(twist[k], Vector3::UnitX());
    at += length[k] * A.col(0);
  }
  check(at.norm() < 1e-12 && (A - first).norm() < 1e-12, "the linkage closes");
  return axes;
}

}  // namespace poinsot::test
