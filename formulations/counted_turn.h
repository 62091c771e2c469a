// Angles that are counted with their turns, of torsion springs, angle drivers and those that are followed: how fast
// they change.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/index.h"
#include "formulations/configuration.h"
#include "formulations/problem.h"

namespace poinsot {

// The fastest where a mechanism stands.
template <Formulation F>
CountedTurn fastest_counted_turn(const Configuration<F, double>& c) {
  const Elements& e = *c.elements;
  const auto turn = [&](int body) { return body == kGround ? Vector3(Vector3::Zero()) : c.rate[index(body)].wg; };
  const auto about = [&](int a, int b, int i, int j) {
    const Vector3 axis = c.s[index(a)].cross(c.s[index(b)]);
    return std::abs(axis.dot(turn(j) - turn(i)));
  };
  CountedTurn fastest;
  for (std::size_t k = 0; k < e.torsions.size(); ++k) {
    const TorsionSpringElement& spring = e.torsions[k];
    const double rate = about(spring.a, spring.b, spring.i, spring.j);
    if (rate > fastest.rate) fastest = {rate, static_cast<int>(k), -1, -1};
  }
  for (const AngleRow& k : e.angle) {
    const double rate = std::abs(c.f[index(k.f)].fd);
    if (rate > fastest.rate) fastest = {rate, -1, e.model_row[index(k.row)], -1};
  }
  for (std::size_t k = 0; k < e.followed.size(); ++k) {
    const FollowedAngle& angle = e.model->followed[k];
    const double rate = about(e.followed[k].a, e.followed[k].b, angle.i, angle.j);
    if (rate > fastest.rate) fastest = {rate, -1, -1, static_cast<int>(k)};
  }
  return fastest;
}

}  // namespace poinsot
