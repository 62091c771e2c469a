// Motions of public benchmark problems from their equations in minimal coordinates, independent of the program: the
// heavy top, the double four-bar linkage and Andrews' squeezing mechanism, by the classical Runge–Kutta method.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

namespace poinsot::test {

template <int n, class Rate>
Eigen::Matrix<double, n, 1> runge_kutta(Eigen::Matrix<double, n, 1> x, double end, int steps, const Rate& rate) {
  using X = Eigen::Matrix<double, n, 1>;
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const X a = rate(x), b = rate(x + h / 2 * a), c = rate(x + h / 2 * b), d = rate(x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return x;
}

// Euler parameters and ω̄ at `end`: J_O ω̄̇ + ω̄ × J_O ω̄ = s̄ × m Aᵀg about the fixed point, s̄ = (0, 1, 0).
inline Eigen::Matrix<double, 7, 1> heavy_top(double end, int steps) {
  using X = Eigen::Matrix<double, 7, 1>;
  const Eigen::Vector3d J(15 + 0.234375, 0.46875, 15 + 0.234375), s(0, 1, 0), weight(0, 0, -15 * 9.81);
  const X start = (X() << 1, 0, 0, 0, 0, 150, -4.61538).finished();
  return runge_kutta<7>(start, end, steps, [&](const X& x) {
    const Eigen::Quaterniond p(x[0], x[1], x[2], x[3]);
    const Eigen::Vector3d w = x.tail<3>();
    const Eigen::Quaterniond pd = p * Eigen::Quaterniond(0, w.x() / 2, w.y() / 2, w.z() / 2);
    const Eigen::Vector3d torque = s.cross(p.conjugate() * weight) - w.cross(J.cwiseProduct(w));
    return X((X() << pd.w(), pd.vec(), torque.cwiseQuotient(J)).finished());
  });
}

// θ of the vertical links from +y: ((N+1)/3 + N) θ̈ = ((N+1)/2 + N) 9.81 sin θ with N = 2.
inline double double_four_bar(double end, int steps) {
  return runge_kutta<2>({0, 1}, end, steps, [](const Eigen::Vector2d& x) {
    return Eigen::Vector2d(x[1], 3.5 / 3 * 9.81 * std::sin(x[0]));
  })[0];
}

// Andrews' mechanism by its crank angle β: I(β) β̈ + ½ I′ β̇² = torque − V′, the other angles from the closed loops.
class AndrewsMechanism {
 public:
  using Angles = Eigen::Matrix<double, 7, 1>;  // β, Θ, γ, φ, δ, Ω, ε

  // Angles and β̇ at `end`.
  std::pair<Angles, double> at(double end, int steps) {
    const Eigen::Vector2d x = runge_kutta<2>({q_[0], 0}, end, steps, [this](const Eigen::Vector2d& state) {
      constexpr double step = 1e-5;
      const double slope = (inertia(state[0] + step) - inertia(state[0] - step)) / (2 * step);
      const double mass = inertia(state[0]);
      return Eigen::Vector2d(state[1], (0.033 - spring_slope_ - slope / 2 * state[1] * state[1]) / mass);
    });
    inertia(x[0]);
    return {q_, x[1]};
  }

 private:
  using V = Eigen::Vector2d;
  using Gradient = Eigen::Matrix<double, 2, 7>;
  struct Point {  // in the plane, with its derivative by the angles
    V x = V::Zero();
    Gradient dq = Gradient::Zero();
  };

  static V c(double a) { return {std::cos(a), std::sin(a)}; }
  static V n(double a) { return {-std::sin(a), std::cos(a)}; }
  // p + along c(a) + across n(a) with a = the sum of the angles named.
  Point from(const Point& p, std::initializer_list<int> angles, double along, double across) const {
    double a = 0;
    for (int k : angles) a += q_[k];
    Point r{p.x + along * c(a) + across * n(a), p.dq};
    for (int k : angles) r.dq.col(k) += along * n(a) - across * c(a);
    return r;
  }

  // Closes the loops at β; the generalized mass. Keeps V′ aside.
  double inertia(double beta) {
    const Point O, A{V(-.06934, -.00227), Gradient::Zero()}, B{V(-.03635, .03273), Gradient::Zero()};
    q_[0] = beta;
    Point F, G, H;
    Angles tangent;
    for (int k = 0; k < 20; ++k) {
      F = from(O, {0}, .007, 0), G = from(A, {4}, .04, 0), H = from(A, {6}, 0, -.04);
      const Point E = from(F, {0, 1}, -.028, 0);
      const Point other[] = {from(B, {2}, 0, -.035), from(G, {3, 4}, 0, -.02), from(H, {5, 6}, .02, 0)};
      Eigen::Matrix<double, 6, 1> g;
      Eigen::Matrix<double, 6, 7> dg;
      for (int l = 0; l < 3; ++l) {
        g.segment<2>(2 * l) = E.x - other[l].x;
        dg.middleRows<2>(2 * l) = E.dq - other[l].dq;
      }
      const auto lu = dg.rightCols<6>().eval().partialPivLu();
      const Eigen::Matrix<double, 6, 1> correction = lu.solve(g);
      q_.tail<6>() -= correction;
      tangent << 1, -lu.solve(dg.col(0)).eval();
      if (correction.norm() < 1e-13) break;
    }
    const Point D = from(B, {2}, .02, -.018);
    const V d = D.x - V(.014, .072);
    spring_slope_ = 4530 * (d.norm() - .07785) * d.normalized().dot(D.dq * tangent);

    const auto turn = [&](std::initializer_list<int> angles) {
      double w = 0;
      for (int k : angles) w += tangent[k];
      return w;
    };
    const auto part = [&](double m, double I, const Point& centre, std::initializer_list<int> angles) {
      return m * (centre.dq * tangent).squaredNorm() + I * turn(angles) * turn(angles);
    };
    return part(.04325, 2.194e-6, from(O, {0}, .00092, 0), {0}) +
           part(.00365, 4.410e-7, from(F, {0, 1}, -.0115, 0), {0, 1}) +
           part(.02373, 5.255e-6, from(B, {2}, .01043, -.01874), {2}) +
           part(.00706, 5.667e-7, from(G, {3, 4}, 0, -(.02 - .01421)), {3, 4}) +
           part(.07050, 1.169e-5, from(A, {4}, .02308, .00916), {4}) +
           part(.00706, 5.667e-7, from(H, {5, 6}, .02 - .01421, 0), {5, 6}) +
           part(.05498, 1.912e-5, from(A, {6}, .00449, -.01228), {6});
  }

  Angles q_ = (Angles() << -0.0617138900142764496, 0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842551,
               -0.222668390165885885, 1.23054744454982120)
                  .finished();
  double spring_slope_ = 0;
};

}  // namespace poinsot::test
