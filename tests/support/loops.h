// Planar loops of revolutes, which constrain too often, and the same mechanisms written without redundancy.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/scene.h"

namespace poinsot::test {

// Orientation of the links' frames: along the global axes, turned by quarter turns as CAD programs write them (with the
// rounding of cos 90°), or at random.
enum class Frames { drawn, quarter_turns, random };

inline Matrix3 frame(Frames frames, int seed) {
  if (frames == Frames::drawn) return Matrix3::Identity();
  if (frames == Frames::random) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    const Eigen::Vector4d e(normal(random), normal(random), normal(random), normal(random));
    return Eigen::Quaterniond(e.normalized()).toRotationMatrix();
  }
  const auto quarter = [](int axis) {
    const double c = std::cos(std::numbers::pi / 2), s = 1;
    Matrix3 A = Matrix3::Identity();
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    A(j, j) = A(k, k) = c;
    A(k, j) = s, A(j, k) = -s;
    return A;
  };
  return quarter(seed % 3) * quarter((2 * seed + 1) % 3);
}

struct LoopOf {
  int links = 4;  // the base among them
  Frames frames = Frames::drawn;
  bool carried = false;   // by a body that turns about the y axis
  bool redundant = true;  // revolutes only; else one joint is spherical and one cylindrical
};

inline Scene loop(const LoopOf& of) {
  Scene scene;
  scene.name = fmt::format("loop of {}", of.links);
  scene.gravity = {1, -9.81, -2};
  const Vector3 z = Vector3::UnitZ();
  int base = kGround;
  if (of.carried) {
    Body& body = scene.bodies.emplace_back();
    body.name = "base";
    body.mass = 5;
    body.inertia = Vector3(1, 2, 1.5).asDiagonal();
    body.angular_velocity = {0, 2, 0};
    Joint& hinge = scene.joints.emplace_back();
    hinge.name = "hinge";
    hinge.j = 0;
    hinge.axis = Vector3::UnitY();
    base = 0;
  }
  std::vector<Vector3> corners;
  for (int k = 0; k < of.links; ++k) {
    const double angle = 0.3 + 2 * std::numbers::pi * k / of.links + 0.15 * std::sin(3.0 * k),
                 r = 1 + 0.2 * std::cos(2.0 * k);
    corners.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  int before = base;
  for (int k = 0; k < of.links; ++k) {
    const bool last = k + 1 == of.links;
    const int link = last ? base : static_cast<int>(scene.bodies.size());
    if (!last) {
      const Vector3 &a = corners[static_cast<std::size_t>(k)], &b = corners[static_cast<std::size_t>(k + 1)];
      Body& body = scene.bodies.emplace_back();
      body.name = fmt::format("link{}", k + 1);
      body.mass = 1 + 0.1 * k;
      const double l = (b - a).norm();
      body.inertia = Vector3(0.02 * l, 0.1 * l * l, 0.1 * l * l + 0.01).asDiagonal();
      body.position = 0.5 * (a + b);
      body.orientation = frame(of.frames, k + 1);
      if (of.carried) {  // carried along
        body.angular_velocity = body.orientation.transpose() * Vector3(0, 2, 0);
        body.velocity = Vector3(0, 2, 0).cross(body.position);
      }
    }
    Joint& joint = scene.joints.emplace_back();
    joint.name = fmt::format("joint{}", k + 1);
    joint.type = of.redundant || k == 0 || k > 2 ? JointType::revolute
                 : k == 1                        ? JointType::spherical
                                                 : JointType::cylindrical;
    joint.i = before, joint.j = link;
    joint.point = corners[static_cast<std::size_t>(k)];
    joint.axis = z;
    before = link;
  }
  return scene;
}

// Posts of 1 m at x = 0 … N on revolutes, joined at their ends by couplers of 1 m: all of them at the angle from the
// x axis, turning at w. At 0 everything lies in a line.
inline Scene posts(int N, double angle, double w, bool redundant) {
  Scene scene;
  scene.name = fmt::format("{} four-bars", N);
  scene.gravity = {0, -9.81, 0};
  const Vector3 post(std::cos(angle), std::sin(angle), 0), spin(0, 0, w);
  const auto body = [&](std::string name, const Vector3& at, const Vector3& velocity, double turns) {
    Body& b = scene.bodies.emplace_back();
    b.name = std::move(name);
    b.mass = 1;
    b.inertia = Vector3(0.02, 0.1, 0.1).asDiagonal();
    b.position = at;
    b.velocity = velocity;
    b.angular_velocity = {0, 0, turns};
  };
  const auto joint = [&](JointType type, int i, int j, const Vector3& at) {
    Joint& x = scene.joints.emplace_back();
    x.name = fmt::format("joint{}", scene.joints.size());
    x.type = redundant ? JointType::revolute : type;
    x.i = i, x.j = j;
    x.point = at;
    x.axis = Vector3::UnitZ();
  };
  for (int k = 0; k <= N; ++k) {
    const Vector3 foot(k, 0, 0);
    body(fmt::format("post{}", k), foot + 0.5 * post, spin.cross(0.5 * post), w);
    joint(JointType::revolute, kGround, k, foot);
  }
  for (int k = 0; k < N; ++k) {
    const Vector3 a = Vector3(k, 0, 0) + post, b = a + Vector3::UnitX();
    body(fmt::format("coupler{}", k), 0.5 * (a + b), spin.cross(post), 0);
    joint(JointType::cylindrical, k, N + 1 + k, a);
    joint(JointType::spherical, N + 1 + k, k + 1, b);
  }
  return scene;
}

// Its first post driven from where it stands.
inline Scene with_motor(Scene scene, const char* angle) {
  Driver& motor = scene.drivers.emplace_back();
  motor.name = "motor", motor.i = kGround, motor.j = 0, motor.axis = {0, 0, 1};
  motor.value = Expression::parse(angle);
  for (Body& body : scene.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  return scene;
}

// A crank of length 1 that turns at 3 rad/s, a rod as long, a slider on the x axis, no row too many: `before` rad
// before the slider passes the crank's hinge, where it could stay there as well, crank and rod turning on together.
inline Scene folding_crank(double before) {
  Scene scene;
  scene.name = "folding crank";
  scene.gravity = {0, -9.81, 0};
  const double phi = std::numbers::pi / 2 - before, w = 3;
  const Vector3 tip(std::cos(phi), std::sin(phi), 0), foot(2 * tip.x(), 0, 0), tip_rate(-w * tip.y(), w * tip.x(), 0);
  const auto body = [&](const char* name, const Vector3& at, const Vector3& velocity, double turns) {
    Body& b = scene.bodies.emplace_back();
    b.name = name;
    b.mass = 1;
    b.inertia = Vector3(0.02, 0.1, 0.1).asDiagonal();
    b.position = at;
    b.velocity = velocity;
    b.angular_velocity = {0, 0, turns};
  };
  body("crank", 0.5 * tip, 0.5 * tip_rate, w);
  body("rod", 0.5 * (tip + foot), {1.5 * tip_rate.x(), 0.5 * tip_rate.y(), 0}, -w);
  body("slider", foot, {2 * tip_rate.x(), 0, 0}, 0);
  const auto joint = [&](JointType type, int i, int j, const Vector3& at, const Vector3& axis) {
    Joint& x = scene.joints.emplace_back();
    x.name = fmt::format("joint{}", scene.joints.size());
    x.type = type;
    x.i = i, x.j = j;
    x.point = at;
    x.axis = axis;
  };
  joint(JointType::revolute, kGround, 0, Vector3::Zero(), Vector3::UnitZ());
  joint(JointType::cylindrical, 0, 1, tip, Vector3::UnitZ());
  joint(JointType::spherical, 1, 2, foot, Vector3::UnitZ());
  joint(JointType::translational, kGround, 2, foot, Vector3::UnitX());
  return scene;
}

// All posts swing alike, as one pendulum of the posts' and the couplers' inertia: their angle after `time`.
inline double swung(int N, double angle, double w, double time) {
  const double J = (N + 1) * (0.1 + 0.25) + N, m = (N + 1) * 0.5 + N;
  constexpr int kSteps = 20000;
  const double h = time / kSteps;
  double phi = angle;
  for (int n = 0; n < kSteps; ++n) {  // midpoint rule
    const double half = phi + 0.5 * h * w, w_half = w - 0.5 * h * m * 9.81 * std::cos(phi) / J;
    w -= h * m * 9.81 * std::cos(half) / J;
    phi += h * w_half;
  }
  return phi;
}

}  // namespace poinsot::test
