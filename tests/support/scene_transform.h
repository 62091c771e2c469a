// The same mechanism told differently: turned and moved as a whole, body frames chosen anew, bodies renumbered, rows in
// another order, joints with their bodies exchanged.
//
// A motion x of the transformed scene belongs to the motion back(x) of the one it was made from.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/scene.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

struct Transform {
  Matrix3 R = Matrix3::Identity();  // the whole: r → R r + t, A → R A
  Vector3 t = Vector3::Zero();
  std::vector<Matrix3> F;  // by body: A → A F; empty: as they are
  std::vector<int> place;  // body b becomes body place[b]; empty: as they are
  unsigned shuffle = 0;    // seed of the order of rows; 0: as it is
  bool exchange = false;   // bodies i and j of joints

  Scene apply(const Scene& scene) const;
  std::vector<Snapshot> back(std::vector<Snapshot> samples) const;

 private:
  const Matrix3 frame(int body) const { return F.empty() ? Matrix3::Identity() : F[static_cast<std::size_t>(body)]; }
  int new_body(int body) const {
    return body == kGround || place.empty() ? body : place[static_cast<std::size_t>(body)];
  }
  // Of a body, in its frame: the ground's turns with the whole, a body's own is chosen anew.
  Vector3 direction(int body, const Vector3& a) const {
    return body == kGround ? Vector3(R * a) : Vector3(frame(body).transpose() * a);
  }
  Vector3 point(int body, const Vector3& s) const {
    return body == kGround ? Vector3(R * s + t) : Vector3(frame(body).transpose() * s);
  }
  static void rotate(const Matrix3& by, Expression (&f)[3]) {
    Expression turned[3];
    for (int k = 0; k < 3; ++k) {
      turned[k] = Expression::parse(fmt::format("({:.17g})*({}) + ({:.17g})*({}) + ({:.17g})*({})", by(k, 0),
                                                f[0].text(), by(k, 1), f[1].text(), by(k, 2), f[2].text()));
    }
    std::copy_n(turned, 3, f);
  }
  void rotate(int body, Frame in, Expression (&f)[3]) const {
    rotate(in == Frame::global ? R : Matrix3(frame(body).transpose()), f);
  }
  void transform(PointForce& f) const {
    f.point = point(f.body, f.point);
    rotate(f.body, f.frame, f.force);
    f.body = new_body(f.body);
  }
  void transform(Torque& f) const {
    rotate(f.body, f.frame, f.torque);
    f.body = new_body(f.body);
  }
  void transform(Spring& f) const {
    f.s_i = point(f.i, f.s_i), f.s_j = point(f.j, f.s_j);
    f.i = new_body(f.i), f.j = new_body(f.j);
  }
  void transform(TorsionSpring& f) const {
    f.axis = direction(f.i, f.axis);
    f.a_i = direction(f.i, f.a_i), f.a_j = direction(f.j, f.a_j);
    f.i = new_body(f.i), f.j = new_body(f.j);
  }
  void transform(LinearDrag& f) const { f.body = new_body(f.body); }
  void transform(CallbackForce&) const {}  // no file holds one
};

inline Scene Transform::apply(const Scene& scene) const {
  Scene s = scene;
  s.gravity = R * scene.gravity;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& from = scene.bodies[b];
    const Matrix3 f = frame(static_cast<int>(b));
    Body& body = s.bodies[static_cast<std::size_t>(new_body(static_cast<int>(b)))];
    body = from;
    body.inertia = f.transpose() * from.inertia * f;
    body.position = R * from.position + t;
    body.orientation = R * from.orientation * f;
    body.velocity = R * from.velocity;
    body.angular_velocity = f.transpose() * from.angular_velocity;
  }
  for (Constraint& c : s.constraints) {
    if (c.alternate) {
      c.alternate->a_i = direction(c.i, c.alternate->a_i);
      c.alternate->a_j = direction(c.j, c.alternate->a_j);
    }
    c.a_i = direction(c.i, c.a_i), c.a_j = direction(c.j, c.a_j);
    c.s_i = point(c.i, c.s_i), c.s_j = point(c.j, c.s_j);
    c.c = R * c.c;
    c.i = new_body(c.i), c.j = new_body(c.j);
  }
  for (Joint& j : s.joints) {
    j.point = R * j.point + t;
    j.axis = R * j.axis, j.axis_i = R * j.axis_i, j.axis_j = R * j.axis_j;
    j.i = new_body(j.i), j.j = new_body(j.j);
    if (exchange) std::swap(j.i, j.j), std::swap(j.axis_i, j.axis_j);
  }
  for (Driver& d : s.drivers) {
    d.axis = direction(d.i, d.axis);
    d.a_i = direction(d.i, d.a_i), d.a_j = direction(d.j, d.a_j);
    d.s_i = point(d.i, d.s_i), d.s_j = point(d.j, d.s_j);
    d.i = new_body(d.i), d.j = new_body(d.j);
  }
  for (Force& force : s.forces) {
    std::visit([&](auto& f) { transform(f); }, force);
  }
  if (shuffle) {
    std::mt19937 random(shuffle);
    std::shuffle(s.constraints.begin(), s.constraints.end(), random);
    std::shuffle(s.joints.begin(), s.joints.end(), random);
    std::shuffle(s.drivers.begin(), s.drivers.end(), random);
    std::shuffle(s.forces.begin(), s.forces.end(), random);
  }
  return s;
}

inline std::vector<Snapshot> Transform::back(std::vector<Snapshot> samples) const {
  for (Snapshot& sample : samples) {
    const std::vector<BodyState> from = sample.bodies;
    for (std::size_t b = 0; b < from.size(); ++b) {
      const BodyState& x = from[static_cast<std::size_t>(new_body(static_cast<int>(b)))];
      const Matrix3 f = frame(static_cast<int>(b));
      BodyState& y = sample.bodies[b];
      y.r = R.transpose() * (x.r - t);
      y.A = R.transpose() * x.A * f.transpose();
      y.rd = R.transpose() * x.rd, y.rdd = R.transpose() * x.rdd;
      y.w = f * x.w, y.wd = f * x.wd;
    }
  }
  return samples;
}

}  // namespace poinsot::test
