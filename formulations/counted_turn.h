// Angles that are counted with their turns, of torsion springs, angle drivers and those that are followed: how fast
// they change.
//
// θ = atan2(y, x) with x = a·v and y = b·v of a direction v on body j, which is of length ρ = sqrt(x² + y²) across the
// axis a × b: θ̇ = (x ẏ − y ẋ)/ρ². On a hinge ρ stays what it is. Where v comes to lie along the axis θ jumps by π, with
// no rate to be seen on the way straight towards it: so ρ̇/ρ, by which ρ would be gone in so much time, counts twice.
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
  CountedTurn fastest;
  const auto look = [&](int a, int b, int direction, int i, int j, const CountedTurn& of) {
    const Vector3& v = c.s[index(direction)];
    const Vector3 vd = (turn(j) - turn(i)).cross(v);
    const double x = c.s[index(a)].dot(v), y = c.s[index(b)].dot(v);
    const double xd = c.s[index(a)].dot(vd), yd = c.s[index(b)].dot(vd);
    const double square = x * x + y * y, round = x * yd - y * xd, towards = x * xd + y * yd;
    const double rate = square > 0 ? std::sqrt(round * round + 4 * towards * towards) / square : HUGE_VAL;
    if (!(rate > fastest.rate)) return;
    fastest = of;
    fastest.rate = rate, fastest.across = std::sqrt(square);
  };
  for (std::size_t k = 0; k < e.torsions.size(); ++k) {
    const TorsionSpringElement& spring = e.torsions[k];
    look(spring.a, spring.b, spring.c, spring.i, spring.j, {.torsion = static_cast<int>(k)});
  }
  for (const AngleRow& k : e.angle) {
    const double rate = std::abs(c.f[index(k.f)].fd);
    if (rate > fastest.rate) fastest = {.rate = rate, .driver = e.model_row[index(k.row)]};
  }
  for (std::size_t k = 0; k < e.followed.size(); ++k) {
    const FollowedAngle& angle = e.model->followed[k];
    look(e.followed[k].a, e.followed[k].b, e.followed[k].c, angle.i, angle.j, {.followed = static_cast<int>(k)});
  }
  return fastest;
}

}  // namespace poinsot
