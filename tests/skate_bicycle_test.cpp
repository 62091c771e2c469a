// A bicycle on edges (models/skate_bicycle.json) against the linear equations of a bicycle,
//
//   M q̈ + v C q̇ + (g K₀ + v² K₂) q = 0,   q = (lean, steer),
//
// of J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and
// steer of a bicycle, 2007, appendix A, with wheels of no size and no spin; z points down there.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "core/scene_reader.h"
#include "core/varied_scene.h"
#include "tests/support/signals.h"

namespace poinsot::test {
namespace {

// q̇ = A q of (lean, steer and their rates) at a speed.
Eigen::Matrix4d linear_bicycle(double v) {
  constexpr double g = 9.81, w = 1, c = 0.02, tilt = 5 * std::numbers::pi / 180;  // wheelbase, trail
  constexpr double m_B = 10, x_B = 1.2, z_B = -0.4, J_B = 0.05, m = 1, x = 1.05, z = -0.4, J = 0.002;
  constexpr double m_x = m_B * x_B + m * x, m_z = m_B * z_B + m * z;
  constexpr double T_xx = J_B + J + m_B * z_B * z_B + m * z * z, T_zz = J_B + J + m_B * x_B * x_B + m * x * x,
                   T_xz = -m_B * x_B * z_B - m * x * z;
  const double sine = std::sin(tilt), cosine = std::cos(tilt);
  const double u = (x - w - c) * cosine - z * sine;  // of the fork's centre before the steering axis
  const double ll = m * u * u + J, lx = -m * u * z + J * sine, lz = m * u * x + J * cosine;
  const double mu = c / w * cosine, S = m * u + mu * m_x;
  Eigen::Matrix2d M, C, K0, K2;
  M << T_xx, lx + mu * T_xz, lx + mu * T_xz, ll + 2 * mu * lz + mu * mu * T_zz;
  C << 0, T_xz / w * cosine - mu * m_z, 0, lz / w * cosine + mu * (S + T_zz / w * cosine);
  K0 << m_z, -S, -S, -S * sine;
  K2 << 0, -m_z / w * cosine, 0, S / w * cosine;
  Eigen::Matrix4d A;
  A << Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity(), -M.inverse() * (g * K0 + v * v * K2),
      -v * (M.inverse() * C);
  return A;
}
// Whether every solution decays: by the criterion of Routh and Hurwitz for the characteristic polynomial of A, whose
// coefficients come from traces (Faddeev and Le Verrier). Eigen's eigenvalues would take ten seconds to compile.
bool decays(const Eigen::Matrix4d& A) {
  Eigen::Matrix4d power = A;
  Eigen::Vector4d c;  // λ⁴ + c₀ λ³ + c₁ λ² + c₂ λ + c₃
  for (int k = 0; k < 4; ++k) {
    c[k] = -power.trace() / (k + 1);
    power = (A * (power + c[k] * Eigen::Matrix4d::Identity())).eval();
  }
  return c.minCoeff() > 0 && c[0] * c[1] * c[2] > c[2] * c[2] + c[0] * c[0] * c[3];
}

// Where lean and steering neither grow nor decay.
double threshold() {
  double falls = 5, stands = 8;
  while (stands - falls > 1e-9) {
    const double v = (falls + stands) / 2;
    (decays(linear_bicycle(v)) ? stands : falls) = v;
  }
  return stands;
}

TEST(SkateBicycle, StandsByItselfAboveAThresholdOfEnergy) {
  const double v_c = threshold();
  EXPECT_NEAR(v_c, 6.404, 1e-3);
  constexpr double rate = 1e-4;
  for (const double v : {0.9 * v_c, 1.1 * v_c, 1.3 * v_c}) {
    const Eigen::Matrix4d A = linear_bicycle(v);
    const Scene scene = with_parameters(scene_of("skate_bicycle"), {{"v", v}, {"lean", rate}});
    for (const FormulationEntry& formulation : formulations()) {
      SCOPED_TRACE(::testing::Message() << v << " m/s in " << formulation.name);
      Settings settings = controlled("dop853", formulation.name, 1e-10, 2, 0.1);
      settings.atol = 1e-14;
      Eigen::Vector4d q(0, 0, rate, 0);
      double t = 0, largest = 0;
      for (const Snapshot& sample : motion(scene, settings)) {
        constexpr double h = 1e-4;
        for (; t < sample.t - h / 2; t += h) {
          const Eigen::Vector4d k1 = A * q, k2 = A * (q + h / 2 * k1), k3 = A * (q + h / 2 * k2), k4 = A * (q + h * k3);
          q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        }
        largest = std::max(largest, std::abs(q[0]));
        EXPECT_NEAR(sample.bodies[0].A(2, 1), q[0], 1e-3 * largest + 1e-12) << sample.t;
      }
      EXPECT_GT(largest, 1e-6);
    }
  }
}

TEST(SkateBicycle, KeepsItsEnergyWhileItsLeanDecays) {
  for (const FormulationEntry& formulation : formulations()) {
    Settings settings = controlled("dop853", formulation.name, 1e-10, 4, 0.5);
    settings.signals = true;
    const Scene scene = with_parameters(scene_of("skate_bicycle"), {{"lean", 0.2}});
    const Columns c = signals_of(scene, settings);
    for (const double energy : c.at("energy")) EXPECT_NEAR(energy, c.at("energy").front(), 1e-6) << formulation.name;
    EXPECT_LT(std::abs(motion(scene, settings).back().bodies[0].A(2, 1)), 1e-3) << formulation.name;
  }
}

}  // namespace
}  // namespace poinsot::test
