// Where Newton's method starts in a step, and what that saves.
#include "integrators/stepping/extrapolation.h"

#include <gtest/gtest.h>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using Vector = Eigen::VectorXd;

// What the last of steps at t = 0, h, … leads to, where they find z(t).
template <class Motion>
Vector led_to(Extrapolation& of, Motion&& z, int steps, double h) {
  Vector x = z(0.0);
  for (int n = 0; n < steps; ++n) {
    x = z(n * h);
    of.lead(x);
  }
  return x;
}

Vector cubic(double t) {
  return Vector{{1 + 2 * t - 3 * t * t + t * t * t, 5 - t + 0.5 * t * t}};
}

TEST(Extrapolation, OfParabolasIsExact) {
  const auto z = [](double t) { return Vector{{1 + 2 * t - 3 * t * t, -4 * t, 7}}; };
  Extrapolation of(z(0));
  EXPECT_LT((led_to(of, z, 6, 0.1) - z(0.6)).norm(), 1e-14);
}

TEST(Extrapolation, MissesByTheThirdDifference) {
  for (double h : {0.1, 0.05, 0.025}) {
    Extrapolation of(cubic(0));
    EXPECT_NEAR((led_to(of, cubic, 8, h) - cubic(8 * h)).norm(), 6 * h * h * h, 1e-13) << h;
  }
}

TEST(Extrapolation, TakesTheLeastDegreeWhereStepsResolveNothing) {
  int sign = 1;
  Extrapolation of(Vector{{1.0}});
  Vector x{{1.0}};
  for (int n = 0; n < 6; ++n) {
    x = Vector{{1.0 + 0.1 * (sign = -sign)}};
    const Vector found = x;
    of.lead(x);
    EXPECT_EQ(of.before(), found);
    if (n > 2) {
      EXPECT_EQ(x, found) << n;
    }
  }
}

TEST(Extrapolation, BeginsAnewAndGoesOnInStepsOfAnotherLength) {
  const auto z = [](double t) { return Vector{{3 + 2 * t}}; };
  Extrapolation of(z(0));
  Vector x = led_to(of, z, 5, 0.1);
  of.restart(z(0.5));
  x = z(0.5);
  of.lead(x);
  EXPECT_EQ(x, z(0.5));

  Extrapolation line(z(0));
  led_to(line, z, 5, 0.1);
  line.resize(z(0.5), 0.5);
  x = z(0.5);
  line.lead(x);
  EXPECT_LT((x - z(0.55)).norm(), 1e-14);
}

TEST(Extrapolation, SparesIterations) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || integrator.controls_error) continue;
    for (const FormulationEntry& formulation : formulations()) {
      if (refusal_of(integrator, formulation.name)) continue;
      Settings settings;
      settings.integrator = integrator.name, settings.formulation = formulation.name;
      settings.step = 1e-3, settings.end = settings.every = 0.5;
      const Statistics s = run(scene_of("double_pendulum"), settings).outcome.statistics;
      EXPECT_LT(s.newton_iterations, 1.05 * static_cast<double>(s.steps)) << integrator.name << ' ' << formulation.name;
      EXPECT_GE(s.newton_iterations, s.steps);
    }
  }
}

TEST(Extrapolation, SparesIterationsOfKinematics) {
  for (const char* model : {"single_pendulum", "four_link", "slider_crank"})
    for (const FormulationEntry& formulation : formulations())
      for (const char* jacobian : {"exact", "kept"}) {
        Settings settings;
        settings.analysis = Analysis::kinematics;
        settings.formulation = formulation.name, settings.jacobian = jacobian;
        settings.step = 1e-3, settings.end = settings.every = 0.5, settings.tolerance = 1e-10;
        const Statistics s = run(scene_of(model), settings).outcome.statistics;
        EXPECT_LT(s.newton_iterations, 1.05 * static_cast<double>(s.steps)) << model << ' ' << formulation.name;
        EXPECT_GE(s.newton_iterations, s.steps);
      }
}

}  // namespace
}  // namespace poinsot::test
