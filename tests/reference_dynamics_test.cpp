// Dynamics against references: the discrete trajectories of the scheme, the multipliers of driven mechanisms, which
// alone can show an error in the equations of motion there, and the motion of free ones.
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <tuple>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// z of body 2 of the double pendulum at t = 5 s by implicit Euler itself, computed by other programs.
struct Discrete {
  const char* formulation;
  double step, z;
};
constexpr Discrete kDiscrete[] = {
    {"rA", 1e-2, -2.39781446},   {"rA", 5e-3, -1.83257407},   {"rA", 2e-3, -1.67477663}, {"rA", 1e-3, -1.64784506},
    {"reps", 1e-2, -2.39781446}, {"reps", 5e-3, -1.83257407}, {"rp", 1e-2, -2.49936716}, {"rp", 5e-3, -1.86876125},
};

TEST(ReferenceDynamics, DoublePendulumFollowsTheDiscreteTrajectory) {
  const Scene scene = scene_of("double_pendulum");
  for (const Discrete& expected : kDiscrete) {
    for (const std::string& jacobian : jacobian_names()) {
      Settings settings = dynamics(expected.formulation, expected.step, 5, 5);
      settings.jacobian = jacobian;
      const auto samples = motion(scene, settings);
      ASSERT_EQ(samples.back().t, 5);
      EXPECT_NEAR(samples.back().bodies[1].r.z(), expected.z, 1e-7)
          << expected.formulation << ' ' << jacobian << ' ' << expected.step;
    }
  }
}

TEST(ReferenceDynamics, EveryLinearSolverFollowsTheDiscreteTrajectory) {
  const Scene scene = scene_of("double_pendulum");
  for (const LinearSolverEntry& entry : linear_solvers()) {
    for (const Discrete& expected : kDiscrete) {
      if (expected.step != 1e-2) continue;
      Settings settings = dynamics(expected.formulation, expected.step, 5, 5);
      settings.linear_solver = entry.name;
      const Recorded r = run(scene, settings);
      ASSERT_TRUE(r.outcome.status.ok()) << entry.name << ": " << r.outcome.status.message;
      EXPECT_NEAR(r.samples.back().bodies[1].r.z(), expected.z, 1e-7) << expected.formulation << ' ' << entry.name;
    }
  }
}

// The first step begins with v_1 = v_0 + h a_1 from the true v_0 and not from the scheme's, so its acceleration and
// multipliers are wrong by O(1): instants begin at 0.1 s.
constexpr double kStepSizes[] = {1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4};
constexpr double kReferenceEnd = 1, kEvery = 0.1;

struct Driven {
  const char* model;
  const char* reference;
  double (*f)(double);  // of the driver
};
const Driven kDriven[] = {
    {"single_pendulum", "lambda_single_pendulum",
     [](double t) { return std::cos(std::numbers::pi / 2 + std::numbers::pi / 4 * std::cos(2 * t)); }},
    {"four_link", "lambda_four_link", [](double t) { return std::cos(std::numbers::pi * (t + 0.5)); }},
    {"slider_crank", "lambda_slider_crank", [](double t) { return std::cos(std::numbers::pi * (0.5 - 2 * t)); }},
};

class DrivenMultipliers : public ::testing::TestWithParam<std::tuple<Driven, std::string>> {};

// Row by row; the driver's only where the reference has the same one of the driver and its alternate.
TEST_P(DrivenMultipliers, ConvergeWithOrderOne) {
  const auto& [mechanism, formulation] = GetParam();
  const Scene scene = scene_of(mechanism.model);
  const Table table = reference_table(mechanism.reference);
  const std::size_t rows = table.header.size() - 2;
  ASSERT_EQ(rows, scene.constraints.size());
  for (std::size_t k = 0; k < rows; ++k) ASSERT_EQ(table.header[k + 2], "lam_" + scene.constraints[k].name);

  std::vector<std::vector<double>> errors(rows);
  std::vector<double> size(rows);
  for (double step : kStepSizes) {
    for (auto& row : errors) row.push_back(0);
    for (const Snapshot& sample : motion(scene, dynamics(formulation, step, kReferenceEnd, kEvery))) {
      if (sample.t == 0) continue;
      const auto& reference = table.rows[static_cast<std::size_t>(std::lround(sample.t / kEvery))];
      ASSERT_NEAR(std::stod(reference[0]), sample.t, 1e-12);
      const bool alternate = std::abs(mechanism.f(sample.t)) > 0.9;
      for (std::size_t k = 0; k < rows; ++k) {
        if (scene.constraints[k].alternate && alternate != (reference[1] == "alt")) continue;
        const double lambda = std::stod(reference[k + 2]);
        errors[k].back() = std::max(errors[k].back(), std::abs(sample.lambda[k] - lambda));
        size[k] = std::max(size[k], std::abs(lambda));
      }
    }
  }
  const double largest = *std::max_element(size.begin(), size.end());
  int judged = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    if (size[k] < 1e-9 * largest) {  // nothing acts on this row
      EXPECT_LT(*std::max_element(errors[k].begin(), errors[k].end()), 1e-6 * largest) << scene.constraints[k].name;
      continue;
    }
    ++judged;
    EXPECT_TRUE(converges({std::begin(kStepSizes), std::end(kStepSizes)}, errors[k])) << scene.constraints[k].name;
  }
  EXPECT_GE(judged, 3);
}

INSTANTIATE_TEST_SUITE_P(All, DrivenMultipliers,
                         ::testing::Combine(::testing::ValuesIn(kDriven), ::testing::ValuesIn(formulation_names())),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).model) + "_" + std::get<1>(test.param);
                         });

class FreeMotion : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(FreeMotion, ConvergesWithOrderOne) {
  const auto& [model, formulation] = GetParam();
  const Scene scene = scene_of(model);
  std::vector<Snapshot> reference = reference_motion("ode_" + model);
  reference.resize(11);
  reference.erase(reference.begin());
  std::map<std::string, std::vector<double>> errors;
  for (double step : kStepSizes) {
    std::vector<Snapshot> samples = motion(scene, dynamics(formulation, step, kReferenceEnd, kEvery));
    samples.erase(samples.begin());
    const Distance d = distance(samples, reference);
    errors["r"].push_back(d.r);
    errors["A"].push_back(d.A);
    errors["rd"].push_back(d.rd);
    errors["w"].push_back(d.w);
    errors["rdd"].push_back(d.rdd);
    errors["wd"].push_back(d.wd);
  }
  for (const auto& [quantity, of] : errors) {
    EXPECT_TRUE(converges({std::begin(kStepSizes), std::end(kStepSizes)}, of)) << quantity;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FreeMotion,
                         ::testing::Combine(::testing::Values("single_pendulum_free", "double_pendulum"),
                                            ::testing::ValuesIn(formulation_names())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

}  // namespace
}  // namespace poinsot::test
