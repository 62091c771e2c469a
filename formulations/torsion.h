// Torsion springs, for every formulation: torque F(x, v, t) about the axis of a hinge, x = θ − angle and v = θ̇.
//
// θ = atan2(y, x), x = a·c, y = b·c with a, b on body i and c on body j; ∇θ is the gradient of u·c at fixed
// u = (x b − y a)/(x² + y²), so that the torque acts on the orientations as a direction constraint's multiplier does.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/index.h"
#include "formulations/configuration.h"
#include "formulations/spring_law.h"

namespace poinsot {

template <class F, class T>
class Torsion {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;
  using XX = Eigen::Matrix<T, F::m, F::m>;

  // Angle of a torsion spring, or of one that is followed, with its full turns: of all that fit, the one nearest to
  // `before`, so that it goes on over ±π within a step.
  template <class Element>
  static T angle(const C& c, const Element& k, double before) {
    using std::atan2;
    constexpr double turn = 2 * std::numbers::pi;
    const Vec3<T>& v = c.s[index(k.c)];
    const T principal = atan2(c.s[index(k.b)].dot(v), c.s[index(k.a)].dot(v));
    return principal + T(turn * std::round((before - plain(principal)) / turn));
  }

  // Where a spring stands.
  struct Twist {
    T x, y, xd = T(0), yd = T(0), rate = T(0), rho2, torque, stiffness, damping;
    Vec3<T> u, c;

    Twist(const C& at, const TorsionSpringElement& k, double before) : c(at.s[index(k.c)]) {
      const Vec3<T>&a = at.s[index(k.a)], &b = at.s[index(k.b)];
      x = a.dot(c);
      y = b.dot(c);
      rho2 = x * x + y * y;
      u = (x * b - y * a) / rho2;
      if (k.damped) {
        const Vec3<T>&ad = at.s_dot[index(k.a)], &bd = at.s_dot[index(k.b)], &cd = at.s_dot[index(k.c)];
        xd = ad.dot(c) + a.dot(cd);
        yd = bd.dot(c) + b.dot(cd);
        rate = (x * yd - y * xd) / rho2;
      }
      const LawValue<T> law = spring_force(k, angle(at, k, before) - T(k.angle), rate, at.time);
      torque = law.F;
      stiffness = law.F_x;
      damping = law.F_v;
    }
  };

  // K = k ∇θ∇θᵀ + torque ∇²θ + c ∇θ (∂θ̇/∂q)ᵀ, D = c ∇θ∇θᵀ, with k = ∂F/∂x, c = ∂F/∂v.
  template <class Sink>
  static void matrix(const C& c, const TorsionSpringElement& k, double before, const T& cq, const T& cv,
                     const std::vector<XX>& T_inverse, Sink&& sink) {
    const Twist w(c, k, before);
    const Vec3<T>&a = c.s[index(k.a)], &b = c.s[index(k.b)];
    const int body[2] = {k.i, k.j};
    Line gx[2], gy[2], gxd[2], gyd[2];  // gradients of x, y, ẋ, ẏ with the orientations of i and j
    const auto pulled = [&](int of, const Ambient& e) {
      return Line((c.at[index(of)].W().transpose() * e).transpose());
    };
    if (k.i != kGround) {
      gx[0] = pulled(k.i, C::Et_times(a, w.c));
      gy[0] = pulled(k.i, C::Et_times(b, w.c));
    }
    if (k.j != kGround) {
      gx[1] = pulled(k.j, C::Et_times(w.c, a));
      gy[1] = pulled(k.j, C::Et_times(w.c, b));
    }
    if (k.damped) {
      const Vec3<T>&ad = c.s_dot[index(k.a)], &bd = c.s_dot[index(k.b)], &cd = c.s_dot[index(k.c)];
      if (k.i != kGround) {
        gxd[0] = w.c.transpose() * c.s_dot_variation(k.i, k.a) + pulled(k.i, C::Et_times(a, cd));
        gyd[0] = w.c.transpose() * c.s_dot_variation(k.i, k.b) + pulled(k.i, C::Et_times(b, cd));
      }
      if (k.j != kGround) {
        gxd[1] = a.transpose() * c.s_dot_variation(k.j, k.c) + pulled(k.j, C::Et_times(w.c, ad));
        gyd[1] = b.transpose() * c.s_dot_variation(k.j, k.c) + pulled(k.j, C::Et_times(w.c, bd));
      }
    }
    const T x = w.x, y = w.y, r2 = w.rho2, tx = -y / r2, ty = x / r2;
    const T txx = T(2) * x * y / (r2 * r2), txy = (y * y - x * x) / (r2 * r2);
    for (int p = 0; p < 2; ++p) {
      if (body[p] == kGround) continue;
      const Line grad_p = tx * gx[p] + ty * gy[p];
      for (int q = 0; q < 2; ++q) {
        if (body[q] == kGround) continue;
        const Line grad_q = tx * gx[q] + ty * gy[q];
        XX second = txx * (gx[p].transpose() * gx[q] - gy[p].transpose() * gy[q]) +
                    txy * (gx[p].transpose() * gy[q] + gy[p].transpose() * gx[q]);
        if (p == q) {
          const Vec3<T>& weigh_i = w.c;
          second += p == 0 ? F::H(c.at[index(k.i)], Mat3<T>(weigh_i * u_bar(c, k, w).transpose()))
                           : F::H(c.at[index(k.j)], Mat3<T>(w.u * c.s_bar(k.c).transpose()));
        } else {
          const auto block = p == 0 ? C::EtE(w.u, w.c) : C::EtE(w.c, w.u);
          second += c.at[index(body[p])].W().transpose() * block * c.at[index(body[q])].W();
        }
        XX K = w.stiffness * grad_p.transpose() * grad_q + w.torque * second;
        XX D = XX::Zero();
        if (k.damped) {  // θ̇ = tx ẋ + ty ẏ
          const Line rate_q =
              (txx * w.xd + txy * w.yd) * gx[q] + (txy * w.xd - txx * w.yd) * gy[q] + tx * gxd[q] + ty * gyd[q];
          K += w.damping * grad_p.transpose() * rate_q;
          D = w.damping * grad_p.transpose() * grad_q;
          if (!T_inverse.empty()) D *= T_inverse[index(body[q])];
        }
        sink.orientation_block(body[p], body[q], XX(cq * K + cv * D));
      }
    }
  }

 private:
  using Line = Eigen::Matrix<T, 1, F::m>;

  static Vec3<T> u_bar(const C& c, const TorsionSpringElement& k, const Twist& w) {
    return (w.x * c.s_bar(k.b) - w.y * c.s_bar(k.a)) / w.rho2;
  }
};

}  // namespace poinsot
