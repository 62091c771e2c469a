// The power, W, of the loads of a model that have no potential, written out from the states of its bodies.
#pragma once

#include <cmath>
#include <span>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot::test {

// What a law F(x, v, t) does beside its potential, the integral of F(x, 0, t).
inline double power_beside_potential(const Expression& law, const Arguments<double>& at) {
  return -(law.law(at).F - law.law<double>({at.t, at.x, 0}).F) * at.v;
}

// Point forces, torques, drag and the damping of springs; without the damping of torsion springs.
inline double power_of_loads(const Model& model, std::span<const BodyState> states, double t) {
  const auto at = [](const Expression(&w)[3], double time) {
    return Vector3(w[0].at(time).f, w[1].at(time).f, w[2].at(time).f);
  };
  const auto state = [&](int body) { return body == kGround ? BodyState() : states[static_cast<std::size_t>(body)]; };
  double power = 0;
  for (const PointForce& load : model.point_forces) {
    const BodyState s = state(load.body);
    const Vector3 force = (load.frame == Frame::body ? s.A : Matrix3::Identity()) * at(load.force, t);
    power += force.dot(s.rd + s.A * s.w.cross(load.point));
  }
  for (const Torque& load : model.torques) {
    const BodyState s = state(load.body);
    power += ((load.frame == Frame::body ? s.A : Matrix3::Identity()) * at(load.torque, t)).dot(s.A * s.w);
  }
  for (const Spring& spring : model.springs) {
    const BodyState i = state(spring.i), j = state(spring.j);
    const Vector3 d = j.r + j.A * spring.s_j - i.r - i.A * spring.s_i;
    const Vector3 d_dot = j.rd + j.A * j.w.cross(spring.s_j) - i.rd - i.A * i.w.cross(spring.s_i);
    const double rate = d.normalized().dot(d_dot);
    power -= spring.damping * rate * rate;
    if (spring.law) power += power_beside_potential(*spring.law, {t, d.norm() - spring.length, rate});
  }
  for (const LinearDrag& drag : model.drags) {
    const BodyState s = state(drag.body);
    power -= drag.translational * s.rd.squaredNorm() + drag.rotational * s.w.squaredNorm();
  }
  return power;
}

}  // namespace poinsot::test
