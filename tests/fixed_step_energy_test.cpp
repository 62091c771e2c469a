// Integrators of fixed step over long runs: energy and angular momentum, kept by RATTLE and damped by others.
#include <gtest/gtest.h>

#include <numeric>

#include "core/input_error.h"
#include "tests/support/fixed_step_cases.h"

namespace poinsot::test {
namespace {

// Energy over a run, E(t) − E(0) at even times.
std::vector<double> energies(const Scene& scene, const Settings& settings) {
  std::vector<double> e;
  EXPECT_TRUE(simulate(scene, settings, [&](const Sample& s) { e.push_back(s.problem.energy()); }).status.ok());
  for (std::size_t k = e.size(); k-- > 0;) e[k] -= e[0];
  return e;
}
double largest(const std::vector<double>& e) {
  return std::abs(*std::max_element(e.begin(), e.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}
// Change over the whole run of the straight line fitted to it.
double trend(const std::vector<double>& e) {
  const auto n = static_cast<double>(e.size());
  const double middle = (n - 1) / 2, mean = std::accumulate(e.begin(), e.end(), 0.0) / n;
  double sxy = 0, sxx = 0;
  for (std::size_t k = 0; k < e.size(); ++k) {
    const double x = static_cast<double>(k) - middle;
    sxy += x * (e[k] - mean);
    sxx += x * x;
  }
  return sxy / sxx * (n - 1);
}

TEST(FixedStepEnergy, RattleIsBoundedWithoutTrend) {
  const Scene scene = scene_of("double_pendulum");
  for (const char* formulation : {"rA", "rp"}) {
    const std::vector<double> coarse = energies(scene, settings_of("rattle", formulation, 0.01, 1000, 0.05));
    const std::vector<double> fine = energies(scene, settings_of("rattle", formulation, 0.005, 200, 0.05));
    const double amplitude = largest(coarse);
    EXPECT_LT(amplitude, 0.03 * 382.6) << formulation;  // of the energy, −382.6 J; kinetic energy comes up to 1200 J
    EXPECT_LT(std::abs(trend(coarse)), 0.1 * amplitude) << formulation;
    EXPECT_LT(largest(fine), 0.35 * amplitude) << formulation;  // order two
    const std::vector<double> euler = energies(scene, settings_of("implicit_euler", formulation, 0.01, 20, 0.05));
    EXPECT_LT(euler.back(), -30 * amplitude) << formulation;  // in a fiftieth of the time
    EXPECT_LT(trend(euler), -0.5 * largest(euler)) << formulation;
  }
}

// A body without forces: the angular momentum in space and, with the error of the method, the energy.
TEST(FixedStepEnergy, RattleKeepsAngularMomentum) {
  const Scene scene = scene_of("free_body");
  const auto drift = [&](const std::string& integrator, const std::string& formulation) {
    std::vector<Vector3> momentum;
    Settings settings = settings_of(integrator, formulation, 0.1, 200, 0);
    settings.tolerance = 1e-14;
    for (const Snapshot& s : motion(scene, settings)) {
      momentum.push_back(s.bodies[0].A * (scene.bodies[0].inertia * s.bodies[0].w));
    }
    double worst = 0;
    for (const Vector3& m : momentum) worst = std::max(worst, (m - momentum[0]).norm() / momentum[0].norm());
    return worst;
  };
  EXPECT_LT(drift("rattle", "rA"), 1e-11);
  EXPECT_LT(drift("rattle", "rp"), 1e-11);
  EXPECT_GT(drift("generalized_alpha", "rA"), 1e-6);  // the measure sees what is not kept
  const std::vector<double> energy = energies(scene, settings_of("rattle", "rA", 0.1, 1000, 0));
  EXPECT_LT(largest(energy), 3e-4);  // 1 J
  EXPECT_LT(std::abs(trend(energy)), 0.05 * largest(energy));
}

TEST(FixedStepSettings, SpectralRadiusDamps) {
  const Scene scene = scene_of("double_pendulum");
  const auto lost = [&](double radius) {
    Settings s = settings_of("generalized_alpha_i2", "rA", 0.01, 20, 0.05);
    s.parameters["spectral_radius"] = radius;
    return -trend(energies(scene, s));
  };
  EXPECT_GT(lost(0), 5 * lost(0.8));
  for (double radius : {-0.1, 1.1, std::nan("")}) {
    Settings s;
    s.integrator = "generalized_alpha";
    s.parameters["spectral_radius"] = radius;
    EXPECT_THROW((void)simulate(scene, s, {}), InputError) << radius;
  }
}

}  // namespace
}  // namespace poinsot::test
