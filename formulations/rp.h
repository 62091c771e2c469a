// The rp formulation: orientation by Euler parameters p ∈ R⁴ with ½ pᵀp − ½ = 0 as a constraint of its own per body.
//
// A(p) is homogeneous of degree two, so that an attached vector s = A(p) s̄ varies, also off the unit sphere, by
//   δs = B(p, s̄) δp = E(s) Ŵ δp, E(s) = [−s̃, s], Ŵ = [2 E(p); 2 pᵀ]/pᵀp     (rotation and stretch)
//   s̈⁰ = B(ṗ, s̄) ṗ = N s̄, N = 2 A(ṗ)
//   H(S) = Σ K(s̄, w) = 2 [tr S, xᵀ; x, S + Sᵀ − tr S I], S = Σ w s̄ᵀ, x = axial vector Σ s̄ × w
// Kinetics: 4 GᵀJ̄G p̈ − 8 ĠᵀJ̄Ġ p = 2 GᵀJ̄ (2G p̈) + 4 ĠᵀJ̄ ω̄ with ω̄ = 2 G ṗ (the paper's equation of motion; its
// discrete form differs from Newton–Euler's by a term of the order of the step, because p·ṗ is not zero there).
#pragma once

#include <Eigen/Geometry>
#include <string_view>

#include "core/so3.h"
#include "formulations/formulation.h"

namespace poinsot {

struct RP {
  static constexpr std::string_view name = "rp";
  static constexpr std::string_view about =
      "Euler parameters with a normalization constraint per body; no orientation is singular";
  static constexpr int m = 4;
  static constexpr int stored = 4;
  static constexpr int ambient = 4;
  static constexpr bool normalized = true;
  static constexpr CoordinateSpace space = CoordinateSpace::vector_space;

  template <class T>
  using X = Eigen::Matrix<T, m, 1>;
  template <class T>
  using XX = Eigen::Matrix<T, m, m>;
  template <class T>
  using Map = Eigen::Matrix<T, ambient, m>;

  template <class T>
  struct Position {
    Mat3<T> A;
    Vec4<T> p;
    Map<T> W_hat;
    const Map<T>& W() const { return W_hat; }
  };
  template <class T>
  struct Velocity {
    Vec3<T> w;
    Vec3<T> wg;
  };

  template <class T>
  static void position(const T* x, Position<T>& at) {
    at.p = Eigen::Map<const Vec4<T>>(x);
    at.A = rotation_from_parameters<T>(at.p);
    const T scale = T(2) / at.p.squaredNorm();
    at.W_hat.template topRows<3>() = scale * E_matrix<T>(at.p);
    at.W_hat.row(3) = scale * at.p.transpose();
  }
  template <class T>
  static void velocity(const Position<T>& at, const T* xd, Velocity<T>& rate) {
    const Eigen::Map<const Vec4<T>> pd(xd);
    rate.w = T(2) * (G_matrix<T>(at.p) * pd);
    rate.wg = at.W_hat.template topRows<3>() * pd;
  }

  template <class T>
  static Mat3<T> A_ddot0(const Position<T>&, const Velocity<T>&, const T* xd) {
    return T(2) * rotation_from_parameters<T>(Eigen::Map<const Vec4<T>>(xd));
  }
  template <class T>
  static Eigen::Matrix<T, 3, m> s_dot_variation(const Position<T>&, const Velocity<T>&, const T* xd,
                                                const Vec3<T>& s_bar) {
    const Vec4<T> pd = Eigen::Map<const Vec4<T>>(xd);  // B(ṗ, s̄)
    const Mat3<T> C = pd[0] * Mat3<T>::Identity() + tilde<T>(pd.template tail<3>());
    Eigen::Matrix<T, 3, m> B;
    B.col(0) = T(2) * (C * s_bar);
    B.template rightCols<3>() = T(2) * (pd.template tail<3>() * s_bar.transpose() - C * tilde<T>(s_bar));
    return B;
  }

  template <class T>
  static XX<T> H(const Position<T>&, const Mat3<T>& S) {
    const Vec3<T> x(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1));
    XX<T> K;
    K(0, 0) = S.trace();
    K.template block<3, 1>(1, 0) = x;
    K.template block<1, 3>(0, 1) = x.transpose();
    K.template block<3, 3>(1, 1) = S + S.transpose();
    K.template block<3, 3>(1, 1).diagonal().array() -= S.trace();
    return T(2) * K;
  }
  // Variation of 2 E(p)ᵀ n/pᵀp at a fixed global torque n: (2/pᵀp) (T_E(n) − 2 Eᵀn pᵀ/pᵀp), E(p)ᵀ n = T_E(n) p.
  template <class T>
  static XX<T> torque_variation(const Position<T>& at, const Vec3<T>& n) {
    const Vec4<T> e = at.W_hat.template topRows<3>().transpose() * n;
    return T(2) / at.p.squaredNorm() * pulled_back(n, T(1)) - e * at.W_hat.row(3);
  }

  template <class T>
  static Eigen::Matrix<T, 3, m> angular_velocity_variation(const Position<T>& at, const Velocity<T>& rate,
                                                           const T* xd) {
    const Eigen::Matrix<T, 3, m> E = E_matrix<T>(Eigen::Map<const Vec4<T>>(xd));
    return T(-2) / at.p.squaredNorm() * E - rate.wg * at.W_hat.row(3);
  }

  template <class T>
  static X<T> inertia_residual(const Position<T>& at, const Velocity<T>& rate, const T* xd, const T* xdd,
                               const Mat3<T>& J) {
    const Eigen::Matrix<T, 3, 4> G = G_matrix<T>(at.p), Gd = G_matrix<T>(Eigen::Map<const Vec4<T>>(xd));
    const Vec3<T> w_dot = T(2) * (G * Eigen::Map<const Vec4<T>>(xdd));
    return T(2) * (G.transpose() * (J * w_dot)) + T(4) * (Gd.transpose() * (J * rate.w));
  }
  template <class T>
  static XX<T> mass(const Position<T>& at, const Mat3<T>& J) {
    const Eigen::Matrix<T, 3, 4> G = G_matrix<T>(at.p);
    return T(4) * (G.transpose() * J * G);
  }
  static constexpr bool simplified_keeps_rate_term = false;
  // −8 (T(J̄Ġp) − ĠᵀJ̄G) with G(p)ᵀ n̄ = T(n̄) p
  template <class T>
  static XX<T> inertia_rate_variation(const Position<T>& at, const Velocity<T>& rate, const T* xd, const Mat3<T>& J) {
    const Eigen::Matrix<T, 3, 4> G = G_matrix<T>(at.p), Gd = G_matrix<T>(Eigen::Map<const Vec4<T>>(xd));
    return T(4) * pulled_back<T>(J * rate.w, T(-1)) + T(8) * (Gd.transpose() * J * G);
  }
  static constexpr bool inertia_depends_on_position = true;
  // 4 (T(J̄Gp̈) − GᵀJ̄G(p̈)) − 8 ĠᵀJ̄Ġ
  template <class T>
  static XX<T> inertia_position_variation(const Position<T>& at, const Velocity<T>&, const T* xd, const T* xdd,
                                          const Mat3<T>& J) {
    const Vec4<T> pdd = Eigen::Map<const Vec4<T>>(xdd);
    const Eigen::Matrix<T, 3, 4> G = G_matrix<T>(at.p), Gd = G_matrix<T>(Eigen::Map<const Vec4<T>>(xd));
    return T(4) * (pulled_back<T>(J * (G * pdd), T(-1)) - G.transpose() * J * G_matrix<T>(pdd)) -
           T(8) * (Gd.transpose() * J * Gd);
  }

  template <class T>
  static void retract(const T* x, const T* dx, T* out) {
    for (int k = 0; k < 4; ++k) out[k] = x[k] + dx[k];
  }

  template <class T>
  static void from_rotation(const Mat3<T>& A, T* x) {
    Eigen::Map<Vec4<T>>{x} = parameters_from_rotation<T>(A);
  }
  template <class T>
  static void rates_from(const Position<T>& at, const Vec3<T>& w, T* xd) {  // ṗ = ½ Gᵀ ω̄
    Eigen::Map<Vec4<T>>{xd} = T(0.5) * (G_matrix<T>(at.p).transpose() * w);
  }
  template <class T>
  static Vec3<T> angular_acceleration(const Position<T>& at, const Velocity<T>&, const T*, const T* xdd) {
    return T(2) * (G_matrix<T>(at.p) * Eigen::Map<const Vec4<T>>(xdd));
  }

 private:
  // T(n) = [0, −nᵀ; n, ± ñ]: E(p)ᵀ n = T p with +, G(p)ᵀ n = T p with −.
  template <class T>
  static XX<T> pulled_back(const Vec3<T>& n, const T& sign) {
    XX<T> t;
    t(0, 0) = T(0);
    t.template block<1, 3>(0, 1) = -n.transpose();
    t.template block<3, 1>(1, 0) = n;
    t.template block<3, 3>(1, 1) = sign * tilde<T>(n);
    return t;
  }
};
static_assert(Formulation<RP>);

}  // namespace poinsot
