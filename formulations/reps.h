// The reps formulation: orientation by the ZXZ Euler angles ε = (φ, θ, ψ), R(ε) = A₁(φ) A₂(θ) A₃(ψ), singular at sin θ
// = 0.
//
// Near the singularity the body-fixed frame is chosen anew: A = R(ε) C with C one of three cyclic permutations of the
// axes, the chart (formulations/euler_chart.h), stored beside the angles. Everything below is written for A, so vectors
// and inertias of the scene stay as they are, and a change of chart is a change of (ε, ε̇, ε̈) and of nothing else.
//   δs = E(s) W δε, E(s) = −s̃, W = [e_z, A₁ e_x, A₁A₂ e_z]: global angular velocity ω = W ε̇
//   s̈⁰ = N s̄, N = Σ_ab (∂²A/∂ε_a∂ε_b) ε̇_a ε̇_b (the paper's D),   H(S)_ab = (∂²A/∂ε_a∂ε_b) : S
// Kinetics in the chart's frame (J_c = C J̄ Cᵀ, ω_c = B ε̇): Bᵀ (J_c (B ε̈ + Ḃ ε̇) + ω̃_c J_c ω_c).
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/so3.h"
#include "formulations/euler_chart.h"
#include "formulations/formulation.h"

namespace poinsot {

struct REPS {
  static constexpr std::string_view name = "reps";
  static constexpr std::string_view about = "ZXZ Euler angles; the body-fixed frame is chosen anew near sin(theta) = 0";
  static constexpr int m = 3;
  static constexpr int stored = 4;  // φ, θ, ψ, number of the chart
  static constexpr int ambient = 3;
  static constexpr bool normalized = false;
  static constexpr CoordinateSpace space = CoordinateSpace::charts;

  static constexpr double kLeaveChart = 0.25;  // |sin θ| below which the chart is left; another one offers √(2/3)

  template <class T>
  using X = Eigen::Matrix<T, m, 1>;
  template <class T>
  using XX = Eigen::Matrix<T, m, m>;
  template <class T>
  using Map = Eigen::Matrix<T, ambient, m>;

  template <class T>
  struct Position {
    Mat3<T> A, W_hat, B;
    T sp, cp, st, ct, ss, cs;  // sines and cosines of φ, θ, ψ
    int chart;
    const Mat3<T>& W() const { return W_hat; }
  };
  template <class T>
  struct Velocity {
    Vec3<T> w;
    Vec3<T> wg;
    Vec3<T> wc;  // in the chart's frame
  };

  template <class T>
  static void position(const T* x, Position<T>& at) {
    using std::cos, std::sin;
    const T phi = x[0], theta = x[1], psi = x[2];  // of values the compiler takes sine and cosine in one call
    at.sp = sin(phi), at.cp = cos(phi);
    at.st = sin(theta), at.ct = cos(theta);
    at.ss = sin(psi), at.cs = cos(psi);
    at.chart = static_cast<int>(plain(x[3]));
    const T &sp = at.sp, &cp = at.cp, &st = at.st, &ct = at.ct, &ss = at.ss, &cs = at.cs;
    Mat3<T> R;
    R << cp * cs - sp * ct * ss, -cp * ss - sp * ct * cs, sp * st,  //
        sp * cs + cp * ct * ss, -sp * ss + cp * ct * cs, -cp * st,  //
        st * ss, st * cs, ct;
    at.A = EulerChart::to_scene(at.chart, R);
    at.W_hat << T(0), cp, sp * st,  //
        T(0), sp, -cp * st,         //
        T(1), T(0), ct;
    at.B << st * ss, cs, T(0),  //
        st * cs, -ss, T(0),     //
        ct, T(0), T(1);
  }
  template <class T>
  static void velocity(const Position<T>& at, const T* xd, Velocity<T>& rate) {
    const Eigen::Map<const Vec3<T>> ed(xd);
    rate.wc = at.B * ed;
    rate.wg = at.W_hat * ed;
    rate.w = EulerChart::vector_to_scene<T>(at.chart, rate.wc);
  }

  // Ä⁰ = (ω̇⁰)~ A + ω̃ω̃ A with ω̇⁰ = Ẇ ε̇
  template <class T>
  static Mat3<T> A_ddot0(const Position<T>& at, const Velocity<T>& rate, const T* xd) {
    const Mat3<T> w = tilde<T>(rate.wg);
    return (tilde<T>(W_dot(at, xd) * Eigen::Map<const Vec3<T>>(xd)) + w * w) * at.A;
  }
  // Column a: Σ_b (∂²A/∂ε_a∂ε_b) ε̇_b s̄.
  template <class T>
  static Eigen::Matrix<T, 3, m> s_dot_variation(const Position<T>& at, const Velocity<T>&, const T* xd,
                                                const Vec3<T>& s_bar) {
    const Vec3<T> s = at.A * s_bar;
    Eigen::Matrix<T, 3, m> v = Eigen::Matrix<T, 3, m>::Zero();
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) v.col(a) += second_partial(at, a, b, s) * xd[b];
    }
    return v;
  }

  template <class T>
  static XX<T> H(const Position<T>& at, const Mat3<T>& S) {
    // With Z = S Aᵀ = Σ w sᵀ: ∂²s/∂ε_a∂ε_b = W_a × (W_b × s) for a ≤ b (the order of the rotations), so that
    // H_ab = Σ (W_a·s)(W_b·w) − (W_a·W_b)(s·w).
    const Mat3<T> Z = S * at.A.transpose();
    XX<T> h = at.W_hat.transpose() * Z * at.W_hat - Z.trace() * (at.W_hat.transpose() * at.W_hat);
    for (int a = 0; a < 3; ++a) {
      for (int b = a + 1; b < 3; ++b) h(a, b) = h(b, a);
    }
    return h;
  }
  template <class T>
  static XX<T> torque_variation(const Position<T>& at, const Vec3<T>& n) {
    XX<T> v = XX<T>::Zero();
    for (int k = 1; k < 3; ++k) {
      for (int l = 0; l < k; ++l) v(k, l) = W_partial(at, k, l).dot(n);
    }
    return v;
  }

  template <class T>
  static Eigen::Matrix<T, 3, m> angular_velocity_variation(const Position<T>& at, const Velocity<T>&, const T* xd) {
    Eigen::Matrix<T, 3, m> v = Eigen::Matrix<T, 3, m>::Zero();
    for (int l = 0; l < 3; ++l) {
      for (int k = l + 1; k < 3; ++k) v.col(l) += W_partial(at, k, l) * xd[k];
    }
    return v;
  }

  template <class T>
  static X<T> inertia_residual(const Position<T>& at, const Velocity<T>& rate, const T* xd, const T* xdd,
                               const Mat3<T>& J) {
    const Mat3<T> Jc = EulerChart::inertia_to_chart(at.chart, J);
    const Vec3<T> wd = at.B * Eigen::Map<const Vec3<T>>(xdd) + B_dot_times(at, xd);
    return at.B.transpose() * (Jc * wd + rate.wc.cross(Jc * rate.wc));
  }
  template <class T>
  static XX<T> mass(const Position<T>& at, const Mat3<T>& J) {
    return at.B.transpose() * EulerChart::inertia_to_chart(at.chart, J) * at.B;
  }
  static constexpr bool simplified_keeps_rate_term = false;
  template <class T>
  static XX<T> inertia_rate_variation(const Position<T>& at, const Velocity<T>& rate, const T* xd, const Mat3<T>& J) {
    const Mat3<T> Jc = EulerChart::inertia_to_chart(at.chart, J);
    const Mat3<T> L = tilde<T>(rate.wc) * Jc - tilde<T>(Jc * rate.wc);
    const Partials<T> d(at);
    Mat3<T> inner = L * at.B;
    inner.col(0) += Jc * (xd[1] * d.theta + xd[2] * d.psi0);
    inner.col(1) += Jc * (xd[2] * d.psi1 + d.theta_times(xd));
    inner.col(2) += Jc * d.psi_times(xd);
    return at.B.transpose() * inner;
  }
  static constexpr bool inertia_depends_on_position = true;
  template <class T>
  static XX<T> inertia_position_variation(const Position<T>& at, const Velocity<T>& rate, const T* xd, const T* xdd,
                                          const Mat3<T>& J) {
    const Mat3<T> Jc = EulerChart::inertia_to_chart(at.chart, J);
    const Mat3<T> L = tilde<T>(rate.wc) * Jc - tilde<T>(Jc * rate.wc);
    const Vec3<T> wd = at.B * Eigen::Map<const Vec3<T>>(xdd) + B_dot_times(at, xd);
    const Vec3<T> u = Jc * wd + rate.wc.cross(Jc * rate.wc);
    const Partials<T> d(at);
    // Of (∂B/∂θ)˙ and (∂B/∂ψ)˙ times ε̇.
    const Vec3<T> theta_dot = (xd[1] * d.theta_theta() + xd[2] * d.theta_psi()) * xd[0];
    const Vec3<T> psi_dot = (xd[1] * d.theta_psi() + xd[2] * d.psi_psi0()) * xd[0] + (xd[2] * xd[1]) * d.psi_psi1();
    XX<T> v;
    v.col(0).setZero();
    v.col(1) = at.B.transpose() * (Jc * (d.theta_times(xdd) + theta_dot) + L * d.theta_times(xd));
    v.col(2) = at.B.transpose() * (Jc * (d.psi_times(xdd) + psi_dot) + L * d.psi_times(xd));
    v(0, 1) += d.theta.dot(u);
    v(0, 2) += d.psi0.dot(u);
    v(1, 2) += d.psi1.dot(u);
    return v;
  }

  template <class T>
  static void retract(const T* x, const T* dx, T* out) {
    for (int k = 0; k < 3; ++k) out[k] = x[k] + dx[k];
    out[3] = x[3];
  }

  // Chart 0 is the scene's own frame; another one is taken only where it is (nearly) singular.
  template <class T>
  static void from_rotation(const Mat3<T>& A, T* x) {
    EulerChart::angles(A, plain(EulerChart::sin_theta(A, 0)) > kLeaveChart ? 0 : EulerChart::best(A), x);
  }
  template <class T>
  static void rates_from(const Position<T>& at, const Vec3<T>& w, T* xd) {  // ε̇ = B⁻¹ ω_c
    const Vec3<T> wc = EulerChart::vector_to_chart<T>(at.chart, w);
    xd[0] = (at.ss * wc[0] + at.cs * wc[1]) / at.st;
    xd[1] = at.cs * wc[0] - at.ss * wc[1];
    xd[2] = wc[2] - at.ct * xd[0];
  }
  template <class T>
  static Vec3<T> angular_acceleration(const Position<T>& at, const Velocity<T>&, const T* xd, const T* xdd) {
    const Vec3<T> wd = at.B * Eigen::Map<const Vec3<T>>(xdd) + B_dot_times(at, xd);
    return EulerChart::vector_to_scene<T>(at.chart, wd);
  }

  // Changes to the best chart where this one is nearly singular; ε̈ keeps the angular acceleration. True when it did.
  static bool rechart(const Position<double>& at, const Velocity<double>& rate, double* x, double* xd, double* xdd) {
    if (std::abs(at.st) >= kLeaveChart) return false;
    const Vec3<double> wd = angular_acceleration(at, rate, xd, xdd);
    EulerChart::angles(at.A, EulerChart::best(at.A), x);
    Position<double> there;
    position(x, there);
    rates_from(there, rate.w, xd);
    const Vec3<double> bias = EulerChart::vector_to_scene<double>(there.chart, B_dot_times(there, xd));
    rates_from<double>(there, wd - bias, xdd);
    return true;
  }

 private:
  // ∂W_k/∂ε_l: a later axis is turned by an earlier angle, W_l × W_k for l < k, else 0.
  template <class T>
  static Vec3<T> W_partial(const Position<T>& at, int k, int l) {
    return l < k ? Vec3<T>(at.W_hat.col(l).cross(at.W_hat.col(k))) : Vec3<T>(Vec3<T>::Zero());
  }
  template <class T>
  static Mat3<T> W_dot(const Position<T>& at, const T* xd) {
    Mat3<T> W;
    W.col(0).setZero();
    W.col(1) = W_partial(at, 1, 0) * xd[0];
    W.col(2) = W_partial(at, 2, 0) * xd[0] + W_partial(at, 2, 1) * xd[1];
    return W;
  }
  // ∂²s/∂ε_a∂ε_b for s = A s̄
  template <class T>
  static Vec3<T> second_partial(const Position<T>& at, int a, int b, const Vec3<T>& s) {
    const Vec3<T> first = at.W_hat.col(std::min(a, b)), second = at.W_hat.col(std::max(a, b));
    return first.cross(second.cross(s));
  }

  // B depends on θ and ψ only: ∂B/∂θ has a first column, ∂B/∂ψ two, all else is 0. So with the second partials.
  template <class T>
  struct Partials {
    const Position<T>& at;
    Vec3<T> theta, psi0, psi1;

    explicit Partials(const Position<T>& where)
        : at(where),
          theta(at.ct * at.ss, at.ct * at.cs, -at.st),
          psi0(at.st * at.cs, -at.st * at.ss, T(0)),
          psi1(-at.ss, -at.cs, T(0)) {}
    Vec3<T> theta_times(const T* x) const { return theta * x[0]; }
    Vec3<T> psi_times(const T* x) const { return psi0 * x[0] + psi1 * x[1]; }
    Vec3<T> theta_theta() const { return {-at.st * at.ss, -at.st * at.cs, -at.ct}; }
    Vec3<T> theta_psi() const { return {at.ct * at.cs, -at.ct * at.ss, T(0)}; }
    Vec3<T> psi_psi0() const { return {-at.st * at.ss, -at.st * at.cs, T(0)}; }
    Vec3<T> psi_psi1() const { return {-at.cs, at.ss, T(0)}; }
  };
  // Ḃ ε̇
  template <class T>
  static Vec3<T> B_dot_times(const Position<T>& at, const T* xd) {
    const Partials<T> d(at);
    return xd[1] * d.theta_times(xd) + xd[2] * d.psi_times(xd);
  }
};
static_assert(Formulation<REPS>);

}  // namespace poinsot
