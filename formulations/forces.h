// Applied forces and torques and their sensitivities, for every formulation: springs, torsion springs, point forces,
// torques, drag, callbacks. Gravity is constant and stands with the inertia.
//
// A force w at an attached point s is the wrench (w, E(s)ᵀw), a global torque n the wrench (0, [n; 0]); a formulation
// pulls the ambient part back by Ŵᵀ. Matrices are K = ∂(−Q)/∂q and D = ∂(−Q)/∂v as small dense blocks over the bodies
// an element acts on; scenes without forces never come here.
#pragma once

#include <cmath>

#include "core/index.h"
#include "formulations/callbacks.h"
#include "formulations/configuration.h"
#include "formulations/problem.h"
#include "formulations/spring_law.h"
#include "formulations/torsion.h"

namespace poinsot {

// What acts on a body, in ambient form.
template <class F, class T>
struct Wrench {
  Vec3<T> f = Vec3<T>::Zero();
  Eigen::Matrix<T, F::ambient, 1> e = Eigen::Matrix<T, F::ambient, 1>::Zero();
};

template <class F, class T>
class Forces {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;
  static constexpr int n = 3 + F::m;
  using Block = Eigen::Matrix<T, n, n>;
  using XX = Eigen::Matrix<T, F::m, F::m>;
  using Arm = Eigen::Matrix<T, 3, n>;  // δ of a point or a span

  // Adds −Q.
  static void residual(const C& c, std::vector<Wrench<F, T>>& sum) {
    const Elements& e = *c.elements;
    const auto add = [&](int body, const Vec3<T>& force, const Ambient& moment) {
      if (body == kGround) return;
      sum[index(body)].f -= force;
      sum[index(body)].e -= moment;
    };
    for (const SpringElement& k : e.springs) {
      const Stretch s(c, k);
      add(k.i, s.force * s.direction, C::Et_times(c.s[index(k.p)], s.force * s.direction));
      add(k.j, -s.force * s.direction, -C::Et_times(c.s[index(k.q)], s.force * s.direction));
    }
    for (std::size_t k = 0; k < e.torsions.size(); ++k) {
      const typename Torsion<F, T>::Twist w(c, e.torsions[k], c.twist[k]);
      add(e.torsions[k].i, Vec3<T>::Zero(), -w.torque * C::Et_times(w.u, w.c));
      add(e.torsions[k].j, Vec3<T>::Zero(), -w.torque * C::Et_times(w.c, w.u));
    }
    for (const PointForceElement& k : e.point_forces) {
      const Vec3<T> force = global(c, k.body, k.frame, k.force);
      add(k.body, force, C::Et_times(c.s[index(k.p)], force));
    }
    for (const TorqueElement& k : e.torques) add(k.body, Vec3<T>::Zero(), torque(global(c, k.body, k.frame, k.torque)));
    for (const LinearDrag& k : e.drags) {
      add(k.body, T(-k.translational) * c.rd(k.body), torque(T(-k.rotational) * c.rate[index(k.body)].wg));
    }
    for (CallbackLoads& k : c.callbacks) {
      Callbacks<F, T>::loads(c, k, [&](int body, const Vec3<T>& force, const Vec3<T>& moment) {
        add(body, force, torque(c.at[index(body)].A * moment));
      });
    }
  }

  // block(body_i, body_j, full, K + D): K and D scaled; D's orientation columns multiplied by T⁻¹ of their body.
  // Blocks come in a fixed order; orientation-only blocks (torsion springs, torques) have full = false.
  template <class Sink>
  static void matrix(const C& c, const StepScale& scale, const std::vector<XX>& T_inverse, Sink&& sink) {
    const Elements& e = *c.elements;
    const auto lowered = [&](Block D, int body) {
      if (!T_inverse.empty()) D.template rightCols<F::m>() *= T_inverse[index(body)];
      return D;
    };
    const T cq = T(scale.position), cv = T(scale.velocity);

    for (const SpringElement& k : e.springs) {
      const Stretch s(c, k);
      const Arm arm[2] = {arm_of(c, k.i, k.p, -1), arm_of(c, k.j, k.q, 1)};
      const int body[2] = {k.i, k.j}, point[2] = {k.p, k.q};
      const Vec3<T> pull = s.force * s.direction;
      for (int a = 0; a < 2; ++a) {
        if (body[a] == kGround) continue;
        for (int b = 0; b < 2; ++b) {
          if (body[b] == kGround) continue;
          Block K = arm[a].transpose() * s.stiffness * arm[b];
          Block D = Block::Zero();
          if (k.damped) {  // tension's part ∂F/∂v n·ḋ varies with ḋ, and ḋ with the orientation and the velocity
            const Eigen::Matrix<T, 1, 3> along = s.damping * s.direction.transpose();
            Eigen::Matrix<T, n, 1> left = arm[a].transpose() * s.direction;
            const T sign = b == 0 ? T(-1) : T(1);
            D.template leftCols<3>() = sign * left * along;
            D.template rightCols<F::m>() = sign * left * (along * c.turn_rate_gradient(body[b], point[b]));
            K.template rightCols<F::m>() += sign * left * (along * c.turn_rate_variation(body[b], point[b]));
          }
          if (a == b) {
            const T sign = a == 0 ? T(-1) : T(1);
            K.template bottomRightCorner<F::m, F::m>() +=
                F::H(c.at[index(body[a])], Mat3<T>(sign * pull * c.s_bar(point[a]).transpose()));
          }
          sink.body_block(body[a], body[b], Block(cq * K + cv * lowered(D, body[b])));
        }
      }
    }
    for (std::size_t k = 0; k < e.torsions.size(); ++k)
      Torsion<F, T>::matrix(c, e.torsions[k], c.twist[k], cq, cv, T_inverse, sink);

    for (const PointForceElement& k : e.point_forces) {
      const Vec3<T> force = global(c, k.body, k.frame, k.force);
      const auto& at = c.at[index(k.body)];
      Block K = Block::Zero();
      K.template bottomRightCorner<F::m, F::m>() = -F::H(at, Mat3<T>(force * c.s_bar(k.p).transpose()));
      if (k.frame == Frame::body) {
        const Eigen::Matrix<T, 3, F::m> turned = C::E(force) * at.W();
        K.template topRightCorner<3, F::m>() -= turned;
        K.template bottomRightCorner<F::m, F::m>() -= (C::E(c.s[index(k.p)]) * at.W()).transpose() * turned;
      }
      sink.body_block(k.body, k.body, Block(cq * K));
    }
    for (const TorqueElement& k : e.torques) {
      const Vec3<T> moment = global(c, k.body, k.frame, k.torque);
      const auto& at = c.at[index(k.body)];
      XX K = -F::torque_variation(at, moment);
      if (k.frame == Frame::body) K -= at.W().template topRows<3>().transpose() * (C::E(moment) * at.W());
      sink.orientation_block(k.body, k.body, XX(cq * K));
    }
    for (const LinearDrag& k : e.drags) {
      const auto& at = c.at[index(k.body)];
      const T drag = T(k.rotational);
      const Eigen::Matrix<T, 3, F::m> W = at.W().template topRows<3>(), dragged = drag * W;
      Block K = Block::Zero(), D = Block::Zero();
      D.template topLeftCorner<3, 3>().diagonal().array() = T(k.translational);
      D.template bottomRightCorner<F::m, F::m>() = W.transpose() * dragged;
      K.template bottomRightCorner<F::m, F::m>() =
          F::torque_variation(at, Vec3<T>(drag * c.rate[index(k.body)].wg)) +
          dragged.transpose() * F::angular_velocity_variation(at, c.rate[index(k.body)], c.xd(k.body));
      sink.body_block(k.body, k.body, Block(cq * K + cv * lowered(D, k.body)));
    }
    for (CallbackLoads& k : c.callbacks) {
      Callbacks<F, T>::matrix(c, k, sink.places_only, [&](int a, int b, const Block& K, const Block& D) {
        sink.body_block(a, b, Block(cq * K + cv * lowered(D, b)));
      });
    }
  }

  // Springs' and torsion springs' stored energy, of laws that at v = 0.
  static T energy(const C& c) {
    const Elements& e = *c.elements;
    T sum = T(0);
    LawPotential* stored = c.stored.data();
    for (const SpringElement& k : e.springs) {
      using std::sqrt;
      const T stretch = sqrt(c.span(k.i, k.j, k.p, k.q).squaredNorm()) - T(k.length);
      sum += potential(k, *stored++, stretch, c.time);
    }
    for (std::size_t k = 0; k < e.torsions.size(); ++k) {
      const T twist = Torsion<F, T>::angle(c, e.torsions[k], c.twist[k]) - T(e.torsions[k].angle);
      sum += potential(e.torsions[k], *stored++, twist, c.time);
    }
    return sum;
  }

 private:
  static Ambient torque(const Vec3<T>& moment) {
    Ambient e = Ambient::Zero();
    e.template head<3>() = moment;
    return e;
  }
  static Vec3<T> global(const C& c, int body, Frame frame, const Expression (&components)[3]) {
    Vec3<T> w;
    for (int k = 0; k < 3; ++k) w[k] = lift(components[k].at(plain(c.time)), c.time).f;
    return frame == Frame::global ? w : Vec3<T>(c.at[index(body)].A * w);
  }

  // Tension F of a spring, ∂(F n)/∂d and ∂F/∂v.
  struct Stretch {
    Vec3<T> direction = Vec3<T>::Zero();
    T force = T(0), damping = T(0);
    Mat3<T> stiffness;

    Stretch(const C& c, const SpringElement& k) {
      using std::sqrt;
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q);
      const T l = sqrt(d.squaredNorm());
      if (plain(l) == 0) {  // the direction of a spring of no length is undefined: it pulls in none
        stiffness = spring_force(k, T(-k.length), T(0), c.time).F_x * Mat3<T>::Identity();
        return;
      }
      direction = d / l;
      const Mat3<T> along = direction * direction.transpose();
      Vec3<T> d_dot = Vec3<T>::Zero();
      T l_dot = T(0);
      if (k.damped) {
        d_dot = c.rigid_span_rate(k.i, k.j, k.p, k.q);
        l_dot = direction.dot(d_dot);
      }
      const LawValue<T> tension = spring_force(k, l - T(k.length), l_dot, c.time);
      force = tension.F;
      damping = tension.F_v;
      stiffness = tension.F_x * along;
      if (k.damped) stiffness += damping / l * direction * (d_dot - l_dot * direction).transpose();
      stiffness += force / l * (Mat3<T>::Identity() - along);
    }
  };

  // δ of s_p (with r) on one side of a span.
  static Arm arm_of(const C& c, int body, int point, int sign) {
    Arm arm = Arm::Zero();
    if (body == kGround) return arm;
    arm.template leftCols<3>().diagonal().array() = T(sign);
    arm.template rightCols<F::m>() = T(sign) * (C::E(c.s[index(point)]) * c.at[index(body)].W());
    return arm;
  }
};

}  // namespace poinsot
