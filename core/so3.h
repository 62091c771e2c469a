// Rotations: the cross-product matrix, the exponential of SO(3) with its tangent, and Euler parameters.
//
//   exp(θ̃) = I + a θ̃ + b θ̃θ̃,              a = sin θ/θ, b = (1 − cos θ)/θ²          (Rodrigues)
//   d/dε exp(θ̃ + ε δ̃) = exp(θ̃) (T δ)~,   T = I − b θ̃ + c θ̃θ̃, c = (θ − sin θ)/θ³   (right Jacobian)
//   T⁻¹ = I + θ̃/2 + d θ̃θ̃,                 d = (1 − (θ/2) cot(θ/2))/θ²               (singular at θ = 2π, 4π, …)
//
// A takes body to global components; Euler parameters p = (e0, e), A(p) = (e0² − e·e) I + 2 e eᵀ + 2 e0 ẽ.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/dual.h"

namespace poinsot {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Vec4 = Eigen::Matrix<T, 4, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

// s̃: s̃ b = s × b.
template <class T>
Mat3<T> tilde(const Vec3<T>& s) {
  Mat3<T> m;
  m << T(0), -s.z(), s.y(),  //
      s.z(), T(0), -s.x(),   //
      -s.y(), s.x(), T(0);
  return m;
}

// rad, 0 to π: of the rotation from A to B, by |A − B|² = 8 sin²(angle/2).
inline double angle_between(const Mat3<double>& A, const Mat3<double>& B) {
  return 2 * std::asin(std::min(1.0, (A - B).norm() / std::sqrt(8.0)));
}

// Σ_k (−x)ᵏ n!/(n + 2k)!, the series behind the coefficients above (n = 1: a, 2: 2b, 3: 6c), up to xᵗ, t = terms.
template <int n, int terms, class T>
T factorial_series(const T& x) {
  T sum = T(1);
#pragma GCC unroll 9
  for (int k = terms - 1; k >= 0; --k) sum = T(1) - x * T(1.0 / ((n + 2 * k + 1) * (n + 2 * k + 2))) * sum;
  return sum;
}
// What is left out is below 1e-20 of the sum; the angle of a usual step needs half the terms.
template <int n, class T>
T factorial_series(const T& x) {
  return plain(x) < 1.0 / 64 ? factorial_series<n, 5>(x) : factorial_series<n, 9>(x);
}

// The coefficients as functions of x = θ²; below 1/4 by their series, because the closed forms cancel there.
inline constexpr double kSeriesLimit = 0.25;

template <class T>
void exponential_coefficients(const T& x, T& a, T& b) {
  using std::cos, std::sin, std::sqrt;
  if (plain(x) < kSeriesLimit) {
    a = factorial_series<1>(x);
    b = factorial_series<2>(x) * T(0.5);
  } else {
    const T theta = sqrt(x), half = sin(theta * T(0.5));
    a = sin(theta) / theta;
    b = T(2) * half * half / x;
  }
}

template <class T>
T inverse_tangent_coefficient(const T& x) {  // d = Σ |B_2k| x^(k−1)/(2k)!, Bernoulli numbers
  if (plain(x) < kSeriesLimit) {
    constexpr double series[] = {1.0 / 12,
                                 1.0 / 720,
                                 1.0 / 30240,
                                 1.0 / 1209600,
                                 1.0 / 47900160,
                                 691.0 / 1307674368000,
                                 1.0 / 74724249600,
                                 3617.0 / 10670622842880000,
                                 43867.0 / 5109094217170944000};
    T sum = T(series[8]);
    for (int k = 7; k >= 0; --k) sum = T(series[k]) + x * sum;
    return sum;
  }
  T a, b;
  exponential_coefficients(x, a, b);
  return (T(1) - a / (T(2) * b)) / x;
}

// I + first θ̃ + second θ̃θ̃, with θ̃θ̃ = θθᵀ − θ² I.
template <class T>
Mat3<T> rotation_polynomial(const Vec3<T>& theta, const T& first, const T& second) {
  const T x = theta[0], y = theta[1], z = theta[2];
  const T sx = second * x, sy = second * y, sz = second * z;
  const T fx = first * x, fy = first * y, fz = first * z;
  const T xx = sx * x, yy = sy * y, zz = sz * z, xy = sx * y, xz = sx * z, yz = sy * z;
  Mat3<T> m;
  m << T(1) - (yy + zz), xy - fz, xz + fy,  //
      xy + fz, T(1) - (xx + zz), yz - fx,   //
      xz - fy, yz + fx, T(1) - (xx + yy);
  return m;
}

template <class T>
Mat3<T> exp_so3(const Vec3<T>& theta) {
  T a, b;
  exponential_coefficients<T>(theta.squaredNorm(), a, b);
  return rotation_polynomial<T>(theta, a, b);
}

// T(θ): exp(θ̃ + δ̃) = exp(θ̃) exp((T δ)~) to first order.
template <class T>
Mat3<T> right_jacobian(const Vec3<T>& theta) {
  const T x = theta.squaredNorm();
  T a, b;
  exponential_coefficients<T>(x, a, b);
  const T c = plain(x) < kSeriesLimit ? T(factorial_series<3>(x) * T(1.0 / 6)) : T((T(1) - a) / x);
  return rotation_polynomial<T>(theta, -b, c);
}

template <class T>
Mat3<T> right_jacobian_inverse(const Vec3<T>& theta) {
  return rotation_polynomial<T>(theta, T(0.5), inverse_tangent_coefficient<T>(theta.squaredNorm()));
}

// T⁻¹(θ) z
template <class T>
Vec3<T> right_jacobian_inverse_times(const Vec3<T>& theta, const Vec3<T>& z) {
  const Vec3<T> once = theta.cross(z);
  return z + T(0.5) * once + inverse_tangent_coefficient<T>(theta.squaredNorm()) * theta.cross(once);
}

// E(p) and G(p), 3×4: global and body angular velocity ω = 2 E ṗ, ω̄ = 2 G ṗ of a unit p.
template <class T>
Eigen::Matrix<T, 3, 4> E_matrix(const Vec4<T>& p) {
  Eigen::Matrix<T, 3, 4> m;
  m << -p[1], p[0], -p[3], p[2],  //
      -p[2], p[3], p[0], -p[1],   //
      -p[3], -p[2], p[1], p[0];
  return m;
}
template <class T>
Eigen::Matrix<T, 3, 4> G_matrix(const Vec4<T>& p) {
  Eigen::Matrix<T, 3, 4> m;
  m << -p[1], p[0], p[3], -p[2],  //
      -p[2], -p[3], p[0], p[1],   //
      -p[3], p[2], -p[1], p[0];
  return m;
}

// A(p), homogeneous of degree two: a rotation for unit p.
template <class T>
Mat3<T> rotation_from_parameters(const Vec4<T>& p) {
  const T e0 = p[0], e1 = p[1], e2 = p[2], e3 = p[3];
  Mat3<T> A;
  A << e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, T(2) * (e1 * e2 - e0 * e3), T(2) * (e1 * e3 + e0 * e2),  //
      T(2) * (e1 * e2 + e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, T(2) * (e2 * e3 - e0 * e1),   //
      T(2) * (e1 * e3 - e0 * e2), T(2) * (e2 * e3 + e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3;
  return A;
}

// Unit p with e0 ≥ 0; the largest component is taken from a sum, never from a difference.
template <class T>
Vec4<T> parameters_from_rotation(const Mat3<T>& A) {
  using std::sqrt;
  const T trace = A.trace();
  int largest = 0;
  T best = trace;
  for (int k = 0; k < 3; ++k) {
    if (plain(A(k, k)) > plain(best)) best = A(k, k), largest = k + 1;
  }
  Vec4<T> p;
  if (largest == 0) {
    p << T(1) + trace, A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1);
  } else {
    const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    p[0] = A(k, j) - A(j, k);
    p[1 + i] = T(1) + T(2) * A(i, i) - trace;
    p[1 + j] = A(j, i) + A(i, j);
    p[1 + k] = A(k, i) + A(i, k);
  }
  p /= sqrt(p.squaredNorm());
  if (plain(p[0]) < 0) p = -p;
  return p;
}

}  // namespace poinsot
