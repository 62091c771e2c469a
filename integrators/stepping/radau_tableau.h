// The coefficients of the three-stage Radau IIA method: y_i = y_n + h Σ A_ij f(y_j), at t_n + c_i h, and those of its
// error estimate. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", sec. IV.5 and IV.8.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace poinsot::radau {

struct Tableau {
  Eigen::Matrix3d A;
  Eigen::Vector3d c, e;  // e: weights of the stages in the error estimate, in units of μ
  double mu;             // real eigenvalue of A
};

inline Tableau make_tableau() {
  Tableau m;
  const double s = std::sqrt(6.0);
  m.A << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225,  //
      (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,     //
      (16 - s) / 36, (16 + s) / 36, 1.0 / 9;
  m.c << (4 - s) / 10, (4 + s) / 10, 1;
  m.e << -(13 + 7 * s) / 3, (-13 + 7 * s) / 3, -1.0 / 3;
  m.mu = (6 + std::cbrt(81.0) - std::cbrt(9.0)) / 30;
  return m;
}

inline const Tableau& tableau() {
  static const Tableau the = make_tableau();
  return the;
}

// The values at x of the polynomials that are 1 at one node c and 0 at the others.
inline Eigen::Vector3d lagrange(double x) {
  const Eigen::Vector3d& c = tableau().c;
  Eigen::Vector3d l;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    l[i] = (x - c[j]) * (x - c[k]) / ((c[i] - c[j]) * (c[i] - c[k]));
  }
  return l;
}

}  // namespace poinsot::radau
