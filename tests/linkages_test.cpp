// Mechanisms with closed forms or few coordinates against calculations in those: models/peaucellier (over-constrained,
// started from a rough pose), models/gyroscope and models/double_wishbone.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "tests/support/signals.h"
#include "tests/support/time_rate.h"

namespace poinsot::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// ẏ = f(y) by the classical Runge–Kutta method.
template <class F>
Eigen::VectorXd integrated(const F& f, Eigen::VectorXd y, double end, int steps) {
  const double h = end / steps;
  for (int n = 0; n < steps; ++n) {
    const Eigen::VectorXd k1 = f(y), k2 = f(y + h / 2 * k1), k3 = f(y + h / 2 * k2), k4 = f(y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return y;
}

// ---- Peaucellier

constexpr double kLong = 1, kShort = 0.4, kC = 0.35;

double crank(double t) {
  return 0.8 * std::sin(t);
}
Vector2d inner_corner(double t) {
  return kC * Vector2d(1 + std::cos(crank(t)), std::sin(crank(t)));
}
Vector2d outer_corner(double t) {  // the inverse of the inner one with respect to a circle
  const Vector2d p = inner_corner(t);
  return (kLong * kLong - kShort * kShort) / p.squaredNorm() * p;
}
Vector2d side_corner(double t, double side) {
  const Vector2d middle = (inner_corner(t) + outer_corner(t)) / 2;
  const double height = std::sqrt(kLong * kLong - middle.squaredNorm());
  return middle + side * height * Vector2d(-middle.y(), middle.x()).normalized();
}

TEST(Peaucellier, DrawsAStraightLine) {
  const Scene scene = scene_of("peaucellier");
  for (const FormulationEntry& formulation : formulations()) {
    for (const Settings& settings :
         {kinematics(formulation.name, 0.05, 3, 0.25), controlled("dop853", formulation.name, 1e-9, 3, 0.25)}) {
      for (const Snapshot& sample : motion(scene, settings)) {
        const BodyState& outer = sample.bodies[5];
        const Vector3d corner = outer.r + outer.A * Vector3d(kShort / 2, 0, 0);
        EXPECT_NEAR(corner.x(), (kLong * kLong - kShort * kShort) / (2 * kC), 1e-9) << formulation.name;
        EXPECT_NEAR(corner.y(), outer_corner(sample.t).y(), 1e-8) << formulation.name << " at " << sample.t;
        EXPECT_NEAR(corner.z(), 0, 1e-12) << formulation.name << " at " << sample.t;
        const Vector2d a = side_corner(sample.t, 1);
        EXPECT_LT((sample.bodies[1].r.head<2>() - a / 2).norm(), 1e-8) << formulation.name << " at " << sample.t;
      }
    }
  }
}

TEST(Peaucellier, TheMotorGivesTheEnergyThatTheMotionTakes) {
  const auto energy = [](double t) {
    double E = 0;
    const auto bar = [&](double mass, double length, const auto& from, const auto& to) {
      const auto middle = [&](double s) { return Vector2d((from(s) + to(s)) / 2); };
      const auto along = [&](double s) { return Vector2d((to(s) - from(s)) / length); };
      E += 0.5 * mass * time_rate(middle, t).squaredNorm() + mass * 9.81 * middle(t).y() +
           0.5 * mass * length * length / 12 * time_rate(along, t).squaredNorm();
    };
    const auto O = [](double) { return Vector2d(0, 0); };
    const auto C = [](double) { return Vector2d(kC, 0); };
    bar(1, kC, C, inner_corner);
    for (const double side : {1., -1.}) {
      const auto corner = [side](double s) { return side_corner(s, side); };
      bar(2, kLong, O, corner);
      bar(1, kShort, corner, inner_corner);
      bar(1, kShort, corner, outer_corner);
    }
    return E;
  };
  for (const Settings& settings : {kinematics("rA", 0.05, 3, 0.25), controlled("dop853", "rp", 1e-10, 3, 0.25)}) {
    const Columns c = signals_of(scene_of("peaucellier"), settings);
    for (std::size_t n = 0; n < c.at("t").size(); ++n)
      EXPECT_NEAR(c.at("motor.power")[n], time_rate(energy, c.at("t")[n]), 1e-6) << c.at("t")[n];
  }
}

// ---- Gyroscope: with φ, θ, ψ about the three axes, p_ψ and p_φ are constant and θ̈ follows from Lagrange's equation.

TEST(Gyroscope, PrecessesAndNutatesAsInThreeCoordinates) {
  constexpr double outer = 0.0025, d = 0.02, weight = 9.81 * d, spin = 60, tilt = 1;
  const Vector3d inner(0.001, 0.0012, 0.0014), rotor(0.0008 + d * d, 0.0008 + d * d, 0.0012);
  // ω = θ̇ e₁ + φ̇ (sin θ e₂ + cos θ e₃), of the rotor with ψ̇ e₃ beside; ψ̇ + φ̇ cos θ = spin for ever.
  const double p_psi = rotor[2] * spin, p_phi = p_psi * std::cos(tilt);
  const auto inertia = [&](double th) {
    return outer + (inner[1] + rotor[1]) * std::pow(std::sin(th), 2) + inner[2] * std::pow(std::cos(th), 2);
  };
  const auto f = [&](const Eigen::VectorXd& y) {  // φ, θ, θ̇
    const double th = y[1], phi_rate = (p_phi - p_psi * std::cos(th)) / inertia(th);
    const double slope = (inner[1] + rotor[1] - inner[2]) * std::sin(2 * th);
    const double moment = 0.5 * slope * phi_rate * phi_rate - p_psi * phi_rate * std::sin(th) + weight * std::sin(th);
    return Eigen::VectorXd{{phi_rate, y[2], moment / (inner[0] + rotor[0])}};
  };
  const Eigen::VectorXd y = integrated(f, Eigen::VectorXd{{0, tilt, 0}}, 2, 20000);
  const Matrix3d axes = Eigen::AngleAxisd(y[0], Vector3d::UnitZ()).toRotationMatrix() *
                        Eigen::AngleAxisd(y[1], Vector3d::UnitX()).toRotationMatrix();
  for (const FormulationEntry& formulation : formulations()) {
    const Snapshot last = motion(scene_of("gyroscope"), controlled("dop853", formulation.name, 1e-11, 2, 2)).back();
    EXPECT_LT((last.bodies[1].A - axes).norm(), 1e-7) << formulation.name;
    EXPECT_LT((last.bodies[2].r - d * axes.col(2)).norm(), 1e-8) << formulation.name;
    EXPECT_NEAR(last.bodies[2].w.z(), spin, 1e-7) << formulation.name;
  }
}

// ---- Double wishbone: one coordinate, the angle of the lower arm; every place follows from circles and spheres.

struct Arm {
  Vector3d pivot, axis, ball;  // a point of the axis, and what turns about it, at angle 0
  Vector3d turned(const Vector3d& point, double angle) const {
    return pivot + Eigen::AngleAxisd(angle, axis.normalized()) * (point - pivot);
  }
};

// The angle next to `near` at which `arm` has its ball at `distance` from `from`: a root of a cos β + b sin β = c.
double meets(const Arm& arm, const Vector3d& from, double distance, double near) {
  const Vector3d axis = arm.axis.normalized(), lever = arm.ball - arm.pivot;
  const Vector3d along = axis.dot(lever) * axis, across = lever - along, third = axis.cross(across);
  const Vector3d to = from - arm.pivot - along;
  const double a = to.dot(across), b = to.dot(third);
  const double c = (to.squaredNorm() + across.squaredNorm() - distance * distance) / 2;
  const double middle = std::atan2(b, a), half = std::acos(c / std::hypot(a, b));
  return std::abs(middle + half - near) < std::abs(middle - half - near) ? middle + half : middle - half;
}

struct Suspension {
  Arm lower{{0, 0.35, 0.3}, {1, 0.05, 0.02}, {0, 0.7, 0.28}};
  Arm upper{{-0.02, 0.42, 0.55}, {1, -0.04, 0.1}, {-0.03, 0.66, 0.56}};
  Vector3d rack{-0.1, 0.38, 0.33}, tie{-0.12, 0.68, 0.35}, carrier{0, 0.76, 0.41};

  struct Place {
    std::array<Vector3d, 3> r;
    std::array<Matrix3d, 3> A;
  };

  Place at(double angle) const {
    const Vector3d low = lower.turned(lower.ball, angle);
    const double turn = meets(upper, low, (upper.ball - lower.ball).norm(), 0);
    const Vector3d high = upper.turned(upper.ball, turn);
    // The carrier turns about the line through both balls until the tie rod fits.
    const Matrix3d swung = frame(low, high, low + Vector3d::UnitY()) *
                           frame(lower.ball, upper.ball, lower.ball + Vector3d::UnitY()).transpose();
    const Arm steered{low, high - low, low + swung * (tie - lower.ball)};
    const double steer = meets(steered, rack, (tie - rack).norm(), 0);
    const Matrix3d A = Eigen::AngleAxisd(steer, (high - low).normalized()).toRotationMatrix() * swung;
    return {{lower.turned({0, 0.53, 0.29}, angle), upper.turned({-0.02, 0.54, 0.56}, turn),
             low + A * (carrier - lower.ball)},
            {Eigen::AngleAxisd(angle, lower.axis.normalized()).toRotationMatrix(),
             Eigen::AngleAxisd(turn, upper.axis.normalized()).toRotationMatrix(), A}};
  }

  static Matrix3d frame(const Vector3d& from, const Vector3d& to, const Vector3d& third) {
    Matrix3d F;
    F.col(0) = (to - from).normalized();
    F.col(2) = F.col(0).cross(third - from).normalized();
    F.col(1) = F.col(2).cross(F.col(0));
    return F;
  }

  double strut(double angle) const { return (lower.turned({0, 0.6, 0.3}, angle) - Vector3d(0, 0.5, 0.75)).norm(); }

  // T = M(α) α̇²/2 and V(α).
  double inertia(double angle) const {
    constexpr std::array masses{4., 2.5, 25.};
    const std::array<Vector3d, 3> J{Vector3d(0.05, 0.04, 0.09), Vector3d(0.02, 0.015, 0.03), Vector3d(0.7, 1.1, 0.7)};
    double M = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto r = [&](double a) { return at(a).r[k]; };
      const auto A = [&](double a) { return at(a).A[k]; };
      const Matrix3d skew = A(angle).transpose() * time_rate(A, angle);
      const Vector3d w(skew(2, 1), skew(0, 2), skew(1, 0));
      M += masses[k] * time_rate(r, angle).squaredNorm() + w.dot(J[k].cwiseProduct(w));
    }
    return M;
  }
  double potential(double angle) const {
    const Place p = at(angle);
    return 9.81 * (4 * p.r[0].z() + 2.5 * p.r[1].z() + 25 * p.r[2].z()) +
           0.5 * 30000 * std::pow(strut(angle) - 0.47, 2);
  }
};

TEST(DoubleWishbone, SettlesAsInOneCoordinate) {
  const Suspension s;
  const auto f = [&](const Eigen::VectorXd& y) {  // α, α̇
    const auto M = [&](double a) { return s.inertia(a); };
    const auto V = [&](double a) { return s.potential(a); };
    const auto L = [&](double a) { return s.strut(a); };
    const double lever = time_rate(L, y[0]);
    const double load = -time_rate(V, y[0]) - 1500 * lever * lever * y[1] - 0.5 * time_rate(M, y[0]) * y[1] * y[1];
    return Eigen::VectorXd{{y[1], load / M(y[0])}};
  };
  const Eigen::VectorXd y = integrated(f, Eigen::VectorXd{{0, 0}}, 0.3, 600);
  ASSERT_GT(std::abs(y[0]), 0.01);  // it does move
  const Suspension::Place place = s.at(y[0]);
  for (const FormulationEntry& formulation : formulations()) {
    const Scene scene = scene_of("double_wishbone");
    const Snapshot last = motion(scene, controlled("dop853", formulation.name, 1e-10, 0.3, 0.3)).back();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT((last.bodies[k].r - place.r[k]).norm(), 1e-7) << formulation.name << ' ' << k;
      EXPECT_LT((last.bodies[k].A - place.A[k]).norm(), 1e-7) << formulation.name << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
