// Mechanisms that are often reported as wrong or unanswered (models/README.md), each against what is known of it: in
// every formulation, by a method of error control and one of fixed steps.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "bench/stability/truths.h"
#include "integrators/start/reactions.h"
#include "tests/support/signals.h"

namespace poinsot::test {
namespace {

using Eigen::Vector2d;

std::vector<Settings> ways(double end) {
  std::vector<Settings> all;
  for (const FormulationEntry& formulation : formulations()) {
    all.push_back(controlled("dop853", formulation.name, 1e-9, end, end / 4));
    all.push_back(controlled("radau5", formulation.name, 1e-9, end, end / 4));
    Settings rattle = dynamics(formulation.name, end / 4000, end, end / 4);
    rattle.integrator = "rattle";
    all.push_back(rattle);
  }
  return all;
}
double allowed_off(const Settings& settings) {
  return integrators().require(settings.integrator).controls_error ? 1e-7 : 1e-5;
}
std::string named(const Settings& settings) {
  return settings.integrator + " in " + settings.formulation;
}

TEST(Gallery, CrankRockerIsWhereTwoCirclesMeet) {
  const Vector2d far(4, 0);
  for (const Settings& settings : ways(2)) {
    for (const Snapshot& sample : motion(scene_of("crank_rocker"), settings)) {
      const double q = 0.5 + 3 * sample.t;
      const Vector2d pin(std::cos(q), std::sin(q)), way = far - pin;
      const double D = way.norm(), along = (3.5 * 3.5 - 2.5 * 2.5 + D * D) / (2 * D);
      const Vector2d corner =
          pin + along / D * way + std::sqrt(3.5 * 3.5 - along * along) / D * Vector2d(-way.y(), way.x());
      EXPECT_LT((sample.bodies[2].r.head<2>() - (corner + far) / 2).norm(), 1e-8) << named(settings) << sample.t;
      EXPECT_LT(std::abs(sample.bodies[1].r.z()), 1e-10) << named(settings);
    }
  }
}

// To the left of the way from A to B for side 1, to its right for −1.
Vector2d meeting(const Vector2d& A, double a, const Vector2d& B, double b, double side) {
  const Vector2d way = B - A;
  const double D = way.norm(), along = (a * a - b * b + D * D) / (2 * D);
  return A + along / D * way + side * std::sqrt(a * a - along * along) / D * Vector2d(-way.y(), way.x());
}

TEST(Gallery, JansensLegWalksByCircles) {
  const Vector2d frame(-0.38, -0.078);
  for (Settings settings : ways(1)) {
    settings.every = 0.05;
    double lowest = 0;
    for (const Snapshot& sample : motion(scene_of("jansen"), settings)) {
      const double q = 2 * std::numbers::pi * sample.t;
      const Vector2d pin = 0.15 * Vector2d(std::cos(q), std::sin(q));
      const Vector2d upper = meeting(frame, 0.415, pin, 0.5, 1), lower = meeting(frame, 0.393, pin, 0.619, -1);
      const Vector2d heel = meeting(frame, 0.401, upper, 0.558, 1), shin = meeting(heel, 0.394, lower, 0.367, -1);
      const Vector2d foot = meeting(shin, 0.657, lower, 0.49, -1);
      const BodyState& plate = sample.bodies[6];
      const Vector3 centre((lower + shin + foot).x() / 3, (lower + shin + foot).y() / 3, 0);
      EXPECT_LT((plate.r - centre).norm(), 1e-8) << named(settings) << " at " << sample.t;
      // Of the plate's frame, which lay along the axes at the start.
      const Vector3 foot_in_plate(-0.00045533018407173387, -0.36648588483805833, 0);
      EXPECT_LT((plate.r + plate.A * foot_in_plate - Vector3(foot.x(), foot.y(), 0)).norm(), 1e-8)
          << named(settings) << " at " << sample.t;
      lowest = std::min(lowest, foot.y());
    }
    EXPECT_NEAR(lowest, -0.918, 1e-3);
  }
}

// Which hinge carries what is not determined; what they carry together is.
TEST(Gallery, HingesOfADoorCarryItTogether) {
  const Scene scene = scene_of("door");
  for (const Settings& settings : ways(1)) {
    std::optional<Reactions> reactions;
    std::vector<BodyState> bodies(1);
    const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
      if (!reactions) reactions.emplace(sample.problem);
      reactions->update(sample);
      sample.problem.to_bodies(sample.a, bodies);
      Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
      for (int hinge = 0; hinge < 3; ++hinge) {
        Vector3 f, n;
        reactions->of_group(hinge, f, n);
        sum += f;
        moment += n + scene.joints[static_cast<std::size_t>(hinge)].point.cross(f);
      }
      const double angle = 0.5 * sample.t;
      const Vector3 middle(0.45 * std::cos(angle), 0.45 * std::sin(angle), 1);
      const Vector3 load = 30 * (Vector3(-0.25 * middle.x(), -0.25 * middle.y(), 0) - scene.gravity);
      EXPECT_LT((bodies[0].r - middle).norm(), 1e-7) << named(settings);
      EXPECT_LT((sum - load).norm(), 1e-3) << named(settings) << " at " << sample.t;
      EXPECT_LT((moment - middle.cross(load)).norm(), 1e-3) << named(settings) << " at " << sample.t;
    });
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
    EXPECT_EQ(outcome.undetermined_reactions, (std::vector<std::string>{"lower", "middle", "upper"}));
  }
}

TEST(Gallery, APendulumSwingsThroughGimbalLock) {
  const double w = std::sqrt(9.81 * 0.5 / (0.25 + 1.0 / 12));
  for (const Settings& settings : ways(2)) {
    for (const Snapshot& sample : motion(scene_of("gimbal_pendulum"), settings)) {
      const double angle = stability::swing(w, 1, sample.t).angle;
      EXPECT_LT((sample.bodies[0].r - Vector3(0, std::sin(angle) / 2, -std::cos(angle) / 2)).norm(),
                allowed_off(settings))
          << named(settings) << " at " << sample.t;
    }
  }
}

TEST(Gallery, ASliderOfProductsFallsAlongItsRail) {
  for (const Settings& settings : ways(1)) {
    for (const Snapshot& sample : motion(scene_of("product_slider"), settings)) {
      const double t = sample.t;
      EXPECT_LT((sample.bodies[0].r - Vector3(0, 0, -9.81 / 2 * t * t)).norm(), 1e-9) << named(settings);
      EXPECT_LT((sample.bodies[0].A - Matrix3::Identity()).norm(), 1e-10) << named(settings);
    }
  }
}

// A body on which no force acts: its centre stays where it is however it tumbles.
TEST(Gallery, ATumblingBodyDoesNotDriftSideways) {
  for (const Settings& settings : ways(20))
    for (const Snapshot& sample : motion(scene_of("free_body"), settings))
      EXPECT_LT(sample.bodies[0].r.norm(), 1e-12) << named(settings);
}

// IFToMM A01 asks for the energy to be kept to 5e-5 J over 10 s, A03 for the digits of benchmark_problems_test.
TEST(Gallery, A01KeepsItsEnergy) {
  for (const FormulationEntry& formulation : formulations()) {
    Settings settings = controlled("dop853", formulation.name, 1e-8, 10, 0.5);
    settings.signals = true;
    const Columns c = signals_of(scene_of("simple_pendulum"), settings);
    for (const double energy : c.at("energy")) EXPECT_NEAR(energy, c.at("energy").front(), 5e-5) << formulation.name;
  }
}

// IFToMM A04 asks for the energy over 10 s. With one degree of freedom and rods that stay together it determines the
// motion.
TEST(Gallery, A04MovesWhereCountingLeavesNoFreedom) {
  const Scene scene = scene_of("bricard");
  for (Settings settings : ways(10)) {
    SCOPED_TRACE(named(settings));
    settings.signals = true;
    settings.every = 0.1;
    const Columns c = signals_of(scene, settings);
    for (const double energy : c.at("energy")) EXPECT_NEAR(energy, c.at("energy").front(), 10 * allowed_off(settings));
    double lowest = 0, highest = -2;
    for (const Snapshot& sample : motion(scene, settings)) {
      const BodyState &second = sample.bodies[1], &third = sample.bodies[2], &last = sample.bodies[4];
      const Vector3 P2 = third.r - third.A * Vector3(0, 0, 0.5), P3 = third.r + third.A * Vector3(0, 0, 0.5);
      EXPECT_LT((P2 - second.r + second.A * Vector3(0, 0.5, 0)).norm(), 1e-9);
      EXPECT_LT((last.r + last.A * Vector3(0, 0.5, 0) - Vector3(0, 0, 1)).norm(), 1e-9);
      EXPECT_LT((third.A.col(0) - second.A.col(0)).norm(), 1e-9);  // the hinge between them
      lowest = std::min(lowest, P3.y()), highest = std::max(highest, P3.y());
    }
    EXPECT_LT(lowest, -1.5);
    EXPECT_NEAR(highest, -1, 1e-3);
  }
}

// IFToMM A05 asks for the height of the slider. In the angle of the rods, its height and the spin, whose momentum is
// kept:
//
//   2 I_h β̈ = ½ ω² dJ/dβ − 2 m g c sin β − 2 F ∂L/∂β,   m_s s̈ = −m_s g − 2 F ∂L/∂s,   F = k (L − L₀) + d L̇
//
// by the classical Runge-Kutta method at steps that the damper leaves it.
struct Governor {
  double rod = 0.3, ball = 5, slider = 3, m = rod + ball, c = (rod / 2 + ball) / m;
  double across = rod * 1.0001 / 12 + rod * (0.5 - c) * (0.5 - c) + ball * (1 - c) * (1 - c), along = rod * 0.0002 / 12;
  double momentum = J(std::numbers::pi / 3) * 2 * std::numbers::pi;

  double J(double beta) const {
    const double x = 0.05 + c * std::sin(beta);
    return along + slider * 0.02 / 12 +
           2 * (m * x * x + across * std::sin(beta) * std::sin(beta) + along * std::cos(beta) * std::cos(beta));
  }
  // Of (β, s, β̇, ṡ).
  Eigen::Vector4d rate(const Eigen::Vector4d& y) const {
    const double sine = std::sin(y[0]), cosine = std::cos(y[0]), over = 1 - 0.5 * cosine - y[1];
    const double L = std::sqrt(0.25 * sine * sine + over * over);
    const double L_beta = (0.25 * sine * cosine + 0.5 * over * sine) / L, L_s = -over / L;
    const double F = 8e5 * (L - 0.5) + 4e4 * (L_beta * y[2] + L_s * y[3]);
    const double spin = momentum / J(y[0]);
    const double J_beta = 2 * (2 * m * (0.05 + c * sine) * c * cosine + 2 * (across - along) * sine * cosine);
    const double turning = spin * spin * J_beta / 2 - 2 * m * 9.81 * c * sine - 2 * F * L_beta;
    return {y[2], y[3], turning / (2 * (across + m * c * c)), -9.81 - 2 * F * L_s / slider};
  }
};

TEST(Gallery, A05HoldsItsSliderByStiffSprings) {
  const Governor governor;
  Settings settings = controlled("auto", "rA", 1e-8, 10, 0.5);
  for (const FormulationEntry& formulation : formulations()) {
    settings.formulation = formulation.name;
    constexpr double h = 2e-5;
    Eigen::Vector4d y(std::numbers::pi / 3, 0.5, 0, 0);
    double t = 0;
    for (const Snapshot& sample : motion(scene_of("flyball_governor"), settings)) {
      for (; t < sample.t - h / 2; t += h) {
        const Eigen::Vector4d k1 = governor.rate(y), k2 = governor.rate(y + h / 2 * k1),
                              k3 = governor.rate(y + h / 2 * k2), k4 = governor.rate(y + h * k3);
        y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      EXPECT_NEAR(sample.bodies[1].r.z(), y[1], 1e-6) << formulation.name << " at " << sample.t;
      EXPECT_NEAR(sample.bodies[0].w.z(), governor.momentum / governor.J(y[0]), 1e-5) << formulation.name;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
