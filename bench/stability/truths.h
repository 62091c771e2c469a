// Motions in closed form and by few coordinates.
#pragma once

#include <Eigen/Core>

namespace poinsot::stability {

// sn(u, k) by descending arithmetic-geometric means (Abramowitz and Stegun, 16.4), and K(k), the quarter period.
double jacobi_sn(double u, double k);
double quarter_period(double k);

// θ̈ = −w² sin θ from rest at `start`, 0 < start < π: θ and its rates at t.
struct Swing {
  double angle, rate, acceleration;
};
Swing swing(double w, double start, double t);

// ẏ = f(y) by the classical Runge-Kutta method, in so many steps.
template <int n, class F>
Eigen::Matrix<double, n, 1> runge_kutta(Eigen::Matrix<double, n, 1> y, double end, int steps, const F& f) {
  using Y = Eigen::Matrix<double, n, 1>;
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const Y a = f(y), b = f(Y(y + h / 2 * a)), c = f(Y(y + h / 2 * b)), d = f(Y(y + h * c));
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

}  // namespace poinsot::stability
