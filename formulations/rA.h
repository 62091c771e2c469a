// The rA formulation: orientation is the matrix A itself, its rate the body angular velocity ω̄.
//
// How an attached vector s = A s̄ varies (formulations/README.md, "A formulation"):
//   δs = E(s) Ŵ δx with E(s) = −s̃, Ŵ = A and δx = θ, a rotation in the body frame:  δs = −A s̃̄ θ
//   s̈⁰ = N s̄, N = A ω̃̄ω̃̄
//   Σ (variation of (∂s/∂x)ᵀ w at fixed w) = H(S) = AᵀS − tr(AᵀS) I, S = Σ w s̄ᵀ      (= Σ s̃̄ (Aᵀw)~)
// Kinetics: J̄ ω̄̇ + ω̃̄ J̄ ω̄. The paper's Π̄(Φ) is the x part of a constraint's gradient.
#pragma once

#include <Eigen/Geometry>
#include <string_view>

#include "core/so3.h"
#include "formulations/formulation.h"

namespace poinsot {

struct RA {
  static constexpr std::string_view name = "rA";
  static constexpr std::string_view about = "orientation matrix on SO(3), angular velocity; no orientation is singular";
  static constexpr int m = 3;        // orientation variations
  static constexpr int stored = 9;   // numbers that hold the orientation: A by columns
  static constexpr int ambient = 3;  // columns of E(s)
  static constexpr bool normalized = false;
  static constexpr CoordinateSpace space = CoordinateSpace::lie_group;

  template <class T>
  using X = Eigen::Matrix<T, m, 1>;
  template <class T>
  using XX = Eigen::Matrix<T, m, m>;
  template <class T>
  using Map = Eigen::Matrix<T, ambient, m>;

  template <class T>
  struct Position {
    Mat3<T> A;
    const Mat3<T>& W() const { return A; }
  };
  template <class T>
  struct Velocity {
    Vec3<T> w;   // ω̄, body
    Vec3<T> wg;  // ω, global
  };

  template <class T>
  static void position(const T* x, Position<T>& at) {
    at.A = Eigen::Map<const Mat3<T>>(x);
  }
  template <class T>
  static void velocity(const Position<T>& at, const T* xd, Velocity<T>& rate) {
    rate.w = Eigen::Map<const Vec3<T>>(xd);
    rate.wg = at.A * rate.w;
  }

  // N, so that s̈⁰ = N s̄.
  template <class T>
  static Mat3<T> A_ddot0(const Position<T>& at, const Velocity<T>& rate, const T*) {
    return rate.wg * rate.w.transpose() - rate.w.squaredNorm() * at.A;  // A ω̃̄ω̃̄ without a product of matrices
  }
  // ∂ṡ/∂x at fixed rates.
  template <class T>
  static Eigen::Matrix<T, 3, m> s_dot_variation(const Position<T>& at, const Velocity<T>& rate, const T*,
                                                const Vec3<T>& s_bar) {
    return at.A * -tilde<T>(rate.w.cross(s_bar));
  }

  template <class T>
  static XX<T> H(const Position<T>& at, const Mat3<T>& S) {
    XX<T> h = at.A.transpose() * S;
    h.diagonal().array() -= h.trace();
    return h;
  }
  // Variation of Ŵᵀ n at a fixed global torque n.
  template <class T>
  static XX<T> torque_variation(const Position<T>& at, const Vec3<T>& n) {
    return tilde<T>(at.A.transpose() * n);
  }

  // ∂ω/∂x (global) at fixed rates.
  template <class T>
  static Eigen::Matrix<T, 3, m> angular_velocity_variation(const Position<T>& at, const Velocity<T>& rate, const T*) {
    return at.A * -tilde<T>(rate.w);
  }

  template <class T>
  static X<T> inertia_residual(const Position<T>&, const Velocity<T>& rate, const T*, const T* xdd, const Mat3<T>& J) {
    return J * Eigen::Map<const Vec3<T>>(xdd) + rate.w.cross(J * rate.w);
  }
  template <class T>
  static XX<T> mass(const Position<T>&, const Mat3<T>& J) {
    return J;
  }
  // ∂/∂ω̄ of the inertia residual; it does not depend on A. The study's simplified matrix keeps this term.
  static constexpr bool simplified_keeps_rate_term = true;
  template <class T>
  static XX<T> inertia_rate_variation(const Position<T>&, const Velocity<T>& rate, const T*, const Mat3<T>& J) {
    return tilde<T>(rate.w) * J - tilde<T>(J * rate.w);
  }
  static constexpr bool inertia_depends_on_position = false;
  template <class T>
  static XX<T> inertia_position_variation(const Position<T>&, const Velocity<T>&, const T*, const T*, const Mat3<T>&) {
    return XX<T>::Zero();
  }

  template <class T>
  static void retract(const T* x, const T* dx, T* out) {
    const Mat3<T> A = Eigen::Map<const Mat3<T>>(x);
    Eigen::Map<Mat3<T>>(out).noalias() = A * exp_so3<T>(Eigen::Map<const Vec3<T>>(dx));
  }

  // Between the coordinates and A, ω̄, ω̄̇.
  template <class T>
  static void from_rotation(const Mat3<T>& A, T* x) {
    Eigen::Map<Mat3<T>>{x} = A;
  }
  template <class T>
  static void rates_from(const Position<T>&, const Vec3<T>& w, T* xd) {
    Eigen::Map<Vec3<T>>{xd} = w;
  }
  template <class T>
  static Vec3<T> angular_acceleration(const Position<T>&, const Velocity<T>&, const T*, const T* xdd) {
    return Eigen::Map<const Vec3<T>>(xdd);
  }
};
static_assert(Formulation<RA>);

}  // namespace poinsot
