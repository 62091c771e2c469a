// Forces that a program computes (CallbackForce in core/scene.h), for every formulation.
//
// A body's load is (f, n̄), the force global and the torque in the body's frame. It depends on positions by (δr, θ̄),
// δA = A θ̃̄, and on velocities by (δṙ, δω̄), with P and R the sensitivities given. With W the rows of Ŵ that are a
// rotation,
//   Q = Uᵀ (f, n̄),   (δr, θ̄) = U (δr, δx),   (δṙ, δω̄) = U (δṙ, δẋ) + V δx,
//   U = diag(1, B),  B = AᵀW,   V = diag(0, Aᵀ (∂ω/∂x + ω̃ W)), in rp and ω̄ times how A stretches,
//   K = −Uᵀ (P U + R V) − (variation of Bᵀn̄ at fixed n̄),   D = −Uᵀ R U.
#pragma once

#include <type_traits>

#include "core/dual.h"
#include "core/index.h"
#include "formulations/callback_loads.h"
#include "formulations/configuration.h"

namespace poinsot {

template <class F, class T>
class Callbacks {
 public:
  using C = Configuration<F, T>;
  static constexpr int n = 3 + F::m;
  using Block = Eigen::Matrix<T, n, n>;

  // add(body, f, n̄)
  template <class Add>
  static void loads(const C& c, CallbackLoads& k, Add&& add) {
    evaluate(c, k);
    if constexpr (kDual) k.differentiate(plain(c.time));
    for (std::size_t a = 0; a < k.loads.size(); ++a) {
      Vec3<T> force = k.loads[a].force.template cast<T>(), torque = k.loads[a].torque.template cast<T>();
      if constexpr (kDual) vary(c, k, a, force, torque);
      add(k.force->bodies[a], force, torque);
    }
  }

  // put(row_body, col_body, K, D)
  template <class Put>
  static void matrix(const C& c, CallbackLoads& k, bool places_only, Put&& put) {
    const std::vector<int>& bodies = k.force->bodies;
    if (!places_only) {
      evaluate(c, k);
      k.differentiate(plain(c.time));
    }
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        Block K = Block::Zero(), D = Block::Zero();
        if (!places_only) {
          const auto at = [](std::size_t body) { return static_cast<Eigen::Index>(6 * body); };
          const Sixes P = k.by.position.template block<6, 6>(at(a), at(b)).template cast<T>();
          const Sixes R = k.by.velocity.template block<6, 6>(at(a), at(b)).template cast<T>();
          const Lift U_a = lift_of(c, bodies[a]), U_b = lift_of(c, bodies[b]);
          K = -U_a.transpose() * (P * U_b + R * rate_of(c, bodies[b]));
          D = -U_a.transpose() * (R * U_b);
          if (a == b) K.template bottomRightCorner<F::m, F::m>() -= turned(c, bodies[a], k.loads[a].torque);
        }
        put(bodies[a], bodies[b], K, D);
      }
    }
  }

 private:
  static constexpr bool kDual = !std::is_floating_point_v<T>;
  using Sixes = Eigen::Matrix<T, 6, 6>;
  using Lift = Eigen::Matrix<T, 6, n>;
  using W = Eigen::Matrix<T, 3, F::m>;

  static W rotation(const C& c, int body) { return c.at[index(body)].W().template topRows<3>(); }

  static void evaluate(const C& c, CallbackLoads& k) {
    const auto number = [](const T& x) { return plain(x); };
    for (std::size_t a = 0; a < k.states.size(); ++a) {
      const int body = k.force->bodies[a];
      BodyState& state = k.states[a];
      state.r = c.r(body).unaryExpr(number);
      state.A = c.at[index(body)].A.unaryExpr(number);
      state.rd = c.rd(body).unaryExpr(number);
      state.w = c.rate[index(body)].w.unaryExpr(number);
    }
    k.evaluate(plain(c.time));
  }

  // Of dual numbers: the load's derivative by the chain rule.
  static void vary(const C& c, const CallbackLoads& k, std::size_t a, Vec3<T>& force, Vec3<T>& torque) {
    const auto derivative = [](const T& x) { return x.d; };
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t b = 0; b < k.states.size(); ++b) {
      const int body = k.force->bodies[b];
      const Matrix3 turn = k.states[b].A.transpose() * c.at[index(body)].A.unaryExpr(derivative);
      Eigen::Matrix<double, 6, 1> position, velocity;
      position << c.r(body).unaryExpr(derivative), 0.5 * (turn(2, 1) - turn(1, 2)), 0.5 * (turn(0, 2) - turn(2, 0)),
          0.5 * (turn(1, 0) - turn(0, 1));
      velocity << c.rd(body).unaryExpr(derivative), c.rate[index(body)].w.unaryExpr(derivative);
      const auto row = static_cast<Eigen::Index>(6 * a), column = static_cast<Eigen::Index>(6 * b);
      sum += k.by.position.template block<6, 6>(row, column) * position +
             k.by.velocity.template block<6, 6>(row, column) * velocity;
    }
    for (Eigen::Index l = 0; l < 3; ++l) force[l].d = sum[l], torque[l].d = sum[3 + l];
  }

  static Lift lift_of(const C& c, int body) {
    Lift U = Lift::Zero();
    U.template topLeftCorner<3, 3>().setIdentity();
    U.template bottomRightCorner<3, F::m>() = c.at[index(body)].A.transpose() * rotation(c, body);
    return U;
  }
  static Lift rate_of(const C& c, int body) {
    const auto& at = c.at[index(body)];
    const auto& rate = c.rate[index(body)];
    Lift V = Lift::Zero();
    V.template bottomRightCorner<3, F::m>() = at.A.transpose() * W(F::angular_velocity_variation(at, rate, c.xd(body)) +
                                                                   tilde<T>(rate.wg) * rotation(c, body));
    if constexpr (F::ambient == 4) V.template bottomRightCorner<3, F::m>() += rate.w * at.W().row(3);
    return V;
  }
  // How Wᵀ A n̄ varies with x at fixed n̄.
  static Eigen::Matrix<T, F::m, F::m> turned(const C& c, int body, const Vector3& torque) {
    const auto& at = c.at[index(body)];
    const Vec3<T> moment = at.A * torque.template cast<T>();
    return F::torque_variation(at, moment) + rotation(c, body).transpose() * (C::E(moment) * at.W());
  }
};

}  // namespace poinsot
