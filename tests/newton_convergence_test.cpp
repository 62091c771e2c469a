// How Newton's method converges, and what its stopping test holds.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// The equations' scaling takes the step out of the matrix: log κ against log h has slope 0 (Bottasso, Bauchau, Cardona,
// Time-step-size-independent conditioning in constrained systems of differential-algebraic equations, 2007).
TEST(NewtonMatrix, ConditionDoesNotDependOnTheStep) {
  struct Case {
    const char* model;
    double longest;  // step that still resolves the motion
  };
  const Case cases[] = {{"double_pendulum", 1e-2},
                        {"four_link", 1e-2},
                        {"slider_crank_joints", 1e-2},
                        {"andrews", 1e-3},     // 10 ms are a third of its motion
                        {"heavy_top", 1e-4}};  // turns by 1.5 rad in 10 ms
  for (const auto& [model, longest] : cases) {
    const Scene scene = scene_of(model);
    for (const FormulationEntry& formulation : formulations()) {
      for (const char* integrator : {"implicit_euler", "generalized_alpha"}) {
        double n = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (const double h : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
          if (h > longest) continue;
          Settings settings = dynamics(formulation.name, h, 4 * h, 4 * h);
          settings.integrator = integrator;
          settings.tolerance = Settings{}.tolerance;
          settings.stopping = Settings{}.stopping;
          const Outcome outcome = simulate(scene, settings, {});
          ASSERT_TRUE(outcome.status.ok()) << model << ' ' << formulation.name << ": " << outcome.status.message;
          ASSERT_EQ(outcome.statistics.linear.size(), 1);
          const double log_h = std::log(h),
                       log_kappa = -std::log(outcome.statistics.linear.front().reciprocal_condition);
          n += 1, x += log_h, y += log_kappa, xx += log_h * log_h, xy += log_h * log_kappa;
        }
        EXPECT_NEAR((n * xy - x * y) / (n * xx - x * x), 0, 0.1)
            << model << ' ' << formulation.name << ' ' << integrator;
      }
    }
  }
}

// With the exact matrix the number of correct digits doubles, where bodies turn by 0.1 rad in a step, too.
TEST(NewtonMatrix, ExactIsExactWhereBodiesTurnFast) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const char* integrator : {"implicit_euler", "generalized_alpha"}) {
      Settings settings = dynamics(formulation.name, 1e-3, 0.02);
      settings.integrator = integrator;
      settings.stopping = "relative";
      settings.tolerance = 1e-10;
      const Outcome outcome = simulate(scene_of("heavy_top"), settings, {});
      ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_LE(outcome.statistics.newton_iterations, 4 * outcome.statistics.steps)
          << integrator << " in " << formulation.name;
    }
  }
}

// Accelerations that drivers prescribe are right at once; multipliers are not, where the matrix is kept.
TEST(NewtonStopping, HoldsTheMultipliersToTheTolerance) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const char* integrator : {"implicit_euler", "generalized_alpha", "generalized_alpha_i2"}) {
      SCOPED_TRACE(std::string(integrator) + " in " + std::string(formulation.name));
      Settings settings = dynamics(formulation.name, 1e-3, 0.2, 0.01);
      settings.integrator = integrator;
      settings.stopping = "relative";
      settings.jacobian = "kept";
      settings.tolerance = 1e-4;
      const std::vector<Snapshot> loose = motion(scene_of("slider_crank"), settings);
      settings.tolerance = 1e-9;
      const std::vector<Snapshot> tight = motion(scene_of("slider_crank"), settings);
      ASSERT_EQ(loose.size(), tight.size());
      double largest = 0, apart = 0;
      for (std::size_t k = 0; k < loose.size(); ++k) {
        const auto at = [](const Snapshot& s) {
          return Eigen::Map<const Eigen::VectorXd>(s.lambda.data(), static_cast<Eigen::Index>(s.lambda.size()));
        };
        largest = std::max(largest, at(tight[k]).lpNorm<Eigen::Infinity>());
        apart = std::max(apart, (at(loose[k]) - at(tight[k])).lpNorm<Eigen::Infinity>());
      }
      EXPECT_LT(apart, 10 * 1e-4 * largest);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
