// Planar mechanisms whose motion is known as a function of time, also before 0: how their bodies lie, what rates that
// has, and how far a run is off it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/support/simulation.h"

namespace poinsot::test {

struct Planar {
  double x, y, angle;
};
// How the bodies lie in the plane z = 0 by time, also before 0.
using Way = std::function<std::vector<Planar>(double t)>;

struct Rates {
  Planar at, rate, second;
};

// By differences of fourth order.
inline std::vector<Rates> rates(const Way& way, double t) {
  constexpr double e = 2e-3;
  const std::vector<Planar> x[] = {way(t - 2 * e), way(t - e), way(t), way(t + e), way(t + 2 * e)};
  std::vector<Rates> all;
  for (std::size_t b = 0; b < x[2].size(); ++b) {
    Rates& of = all.emplace_back(Rates{x[2][b], Planar{}, Planar{}});
    for (double Planar::*c : {&Planar::x, &Planar::y, &Planar::angle}) {
      of.rate.*c = (8 * (x[3][b].*c - x[1][b].*c) - (x[4][b].*c - x[0][b].*c)) / (12 * e);
      of.second.*c = (16 * (x[3][b].*c + x[1][b].*c) - (x[4][b].*c + x[0][b].*c) - 30 * x[2][b].*c) / (12 * e * e);
    }
  }
  return all;
}

// The angle after a time, which may be negative, from its acceleration; of fourth order.
inline double turned(double t, double phi, double w, const std::function<double(double phi, double w)>& acceleration) {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(t) / 2e-3)));
  const double h = t / steps;
  for (int n = 0; n < steps; ++n) {
    const double k1 = w, l1 = acceleration(phi, w);
    const double k2 = w + h / 2 * l1, l2 = acceleration(phi + h / 2 * k1, k2);
    const double k3 = w + h / 2 * l2, l3 = acceleration(phi + h / 2 * k2, k3);
    const double k4 = w + h * l3, l4 = acceleration(phi + h * k3, k4);
    phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    w += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }
  return phi;
}

// The most that a motion is off its way, m and rad, over bodies and samples.
struct Off {
  double position = 0, velocity = 0, first_acceleration = 0, acceleration = 0;
};

inline Off off_way(const Way& way, const std::vector<Snapshot>& samples) {
  Off off;
  const auto vector = [](const Planar& p) { return Vector3(p.x, p.y, 0); };
  for (const Snapshot& s : samples) {
    const std::vector<Rates> right = rates(way, s.t);
    for (std::size_t b = 0; b < right.size(); ++b) {
      const auto& [at, rate, second] = right[b];
      const BodyState& body = s.bodies[b];
      const Vector3 x(std::cos(at.angle), std::sin(at.angle), 0), z = Vector3::UnitZ();
      off.position = std::max(off.position, (body.r - vector(at)).norm() + (body.A.col(0) - x).norm());
      off.velocity = std::max(off.velocity, (body.rd - vector(rate)).norm() + (body.w - rate.angle * z).norm());
      double& worst = s.t == 0 ? off.first_acceleration : off.acceleration;
      worst = std::max(worst, (body.rdd - vector(second)).norm() + (body.wd - second.angle * z).norm());
    }
  }
  return off;
}

// Bodies as they lie and move on the way at t = 0.
inline Scene scene_on(const Way& way, const Vector3& gravity) {
  Scene scene;
  scene.gravity = gravity;
  for (const auto& [at, rate, second] : rates(way, 0)) {
    Body& b = scene.bodies.emplace_back();
    b.name = fmt::format("bar{}", scene.bodies.size());
    b.mass = 1, b.inertia = Vector3(0.02, 0.1, 0.1).asDiagonal();
    b.position = {at.x, at.y, 0};
    b.orientation = Eigen::AngleAxisd(at.angle, Vector3::UnitZ()).toRotationMatrix();
    const auto rounded = [](double x) { return std::round(x * 1e6) / 1e6; };  // rates here are of few digits
    b.velocity = {rounded(rate.x), rounded(rate.y), 0}, b.angular_velocity = {0, 0, rounded(rate.angle)};
  }
  return scene;
}

// Crank from the origin and rod, 1 m each, at the angles φ and ψ, and a slider on the x axis.
inline std::vector<Planar> crank_and_rod(double phi, double psi) {
  const double x = std::cos(phi), y = std::sin(phi), u = std::cos(psi), v = std::sin(psi);
  return {{x / 2, y / 2, phi}, {x + u / 2, y + v / 2, psi}, {x + u, 0, 0}};
}

inline Way toggle_way(const std::function<double(double t)>& phi) {
  return [=](double t) { return crank_and_rod(phi(t), -phi(t)); };
}

// J φ̈ + ½ J' φ̇² = Q, where J = 0.7 + 6 sin²φ.
inline double toggle_acceleration(double phi, double w, const Vector3& g) {
  const double s = std::sin(phi), c = std::cos(phi);
  return (g.y() * c - 4 * g.x() * s - 6 * s * c * w * w) / (0.7 + 6 * s * s);
}

// Ground and coupler of 2 m, crank and rocker of 1 m, at the angles φ and ψ.
inline std::vector<Planar> parallelogram(double phi, double psi) {
  const double x = std::cos(phi), y = std::sin(phi), u = 2 + std::cos(psi), v = std::sin(psi);
  return {{x / 2, y / 2, phi}, {(x + u) / 2, (y + v) / 2, std::atan2(v - y, u - x)}, {1 + u / 2, v / 2, psi}};
}

inline Way posts_way(int N, double angle, double w) {
  const double J = (N + 1) * 0.35 + N, m = (N + 1) * 0.5 + N;
  return [=](double t) {
    const double phi = turned(t, angle, w, [=](double at, double) { return -m * 9.81 * std::cos(at) / J; });
    std::vector<Planar> all;
    for (int k = 0; k <= N; ++k) all.push_back({k + 0.5 * std::cos(phi), 0.5 * std::sin(phi), phi});
    for (int k = 0; k < N; ++k) all.push_back({k + 0.5 + std::cos(phi), std::sin(phi), 0});
    return all;
  };
}

}  // namespace poinsot::test
