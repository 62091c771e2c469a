// Public problems with published digits: initial accelerations, order of convergence towards the digits, dependent rows
// and singular positions. (Digits: IFToMM benchmark library, IVP test set, and extrapolation in extended precision.)
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "core/so3.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"
#include "tests/support/benchmark_references.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using Errors = std::vector<double>;

class BenchmarkProblems : public ::testing::TestWithParam<std::string> {
 protected:
  // The errors of the state at `end` fall with order one.
  void expect_order_one(const std::string& model, double end, std::initializer_list<int> step_counts,
                        const std::function<Errors(const std::vector<BodyState>&)>& errors_of) {
    const Scene scene = scene_of(model);
    std::vector<double> steps;
    std::vector<Errors> errors;
    for (int count : step_counts) {
      steps.push_back(end / count);
      const auto found = errors_of(motion(scene, dynamics(GetParam(), steps.back(), end, end)).back().bodies);
      errors.resize(found.size());
      for (std::size_t k = 0; k < found.size(); ++k) errors[k].push_back(found[k]);
    }
    for (std::size_t k = 0; k < errors.size(); ++k) {
      EXPECT_TRUE(converges(steps, errors[k])) << model << ", error " << k + 1;
    }
  }

  BodyState start(const std::string& model) {
    return motion(scene_of(model), dynamics(GetParam(), 1e-6, 1e-6)).front().bodies[0];
  }
};

INSTANTIATE_TEST_SUITE_P(All, BenchmarkProblems, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

double turn_of(const BodyState& state, const Vec4<double>& p) {
  return (state.A - rotation_from_parameters<double>(p.normalized())).norm();
}

// The references of their own, against the published digits.
TEST(BenchmarkReferences, HaveThePublishedDigits) {
  const Eigen::Matrix<double, 7, 1> top = heavy_top(0.2, 40000);
  const Vec4<double> p(-0.70827915297431, 0.43878108812658, 0.54572839614542, 0.08939975282401);
  EXPECT_LT(std::min((top.head<4>() - p).norm(), (top.head<4>() + p).norm()), 1e-8);

  const double theta = double_four_bar(1, 4000);
  EXPECT_NEAR(std::sin(theta), -0.19502030194944, 1e-11);
  EXPECT_NEAR(std::cos(theta), -0.98079920566217, 1e-11);

  const auto [angles, rate] = AndrewsMechanism().at(0.03, 3000);
  const AndrewsMechanism::Angles published = {15.81077119515371,  -15.75637105841184, 0.0408222401196456,
                                              -0.534730116342079, 0.524409965879954,  0.534730116342079,
                                              1.048080741041938};
  EXPECT_LT((angles - published).norm(), 1e-6);
  EXPECT_NEAR(rate, 1139.920302259106, 1e-4);
}

TEST_P(BenchmarkProblems, HeavyTop) {
  const Vector3 wd = start("heavy_top").wd;
  EXPECT_NEAR(wd.x(), 661.3461692308, 1e-8 * 661);
  EXPECT_NEAR(wd.y(), 0, 1e-8 * 661);
  EXPECT_NEAR(wd.z(), 0, 1e-8 * 661);
  const Vec4<double> p = heavy_top(0.02, 10000).head<4>();
  expect_order_one("heavy_top", 0.02, {500, 1000, 2000, 4000, 8000},
                   [&](const auto& bodies) { return Errors{turn_of(bodies[0], p)}; });
}

TEST_P(BenchmarkProblems, Andrews) {
  EXPECT_NEAR(start("andrews").wd.y(), 14222.4439199541, 1e-8 * 14222);
  const auto [q, rate] = AndrewsMechanism().at(0.01, 1000);
  expect_order_one("andrews", 0.01, {400, 800, 1600, 3200, 6400}, [&q = q, &rate = rate](const auto& bodies) {
    double error = 0;
    std::size_t b = 0;
    for (double angle : {q[0], q[0] + q[1], q[2], q[3] + q[4], q[4], q[5] + q[6], q[6]}) {
      const Vector3 x(std::cos(angle), std::sin(angle), 0);  // the body's x axis lies along the angle
      error = std::max(error, (bodies[b++].A.col(0) - x).norm());
    }
    return Errors{error, std::abs(bodies[0].w.y() - rate)};
  });
}

TEST_P(BenchmarkProblems, SimplePendulum) {
  expect_order_one("simple_pendulum", 1, {200, 400, 800, 1600, 3200}, [](const auto& bodies) {
    return Errors{(bodies[0].r - Vector3(0.98629175113188, -0.16501085312554, 0)).norm(),
                  (bodies[0].rd - Vector3(0.29690551591632, 1.77464364111266, 0)).norm()};
  });
}

TEST_P(BenchmarkProblems, FreeBody) {
  expect_order_one("free_body", 10, {1000, 2000, 4000, 8000, 16000}, [](const auto& bodies) {
    return Errors{(bodies[0].w - Vector3(-0.11732638371977, 0.99309391282156, 0.06774333993528)).norm(),
                  turn_of(bodies[0], {0.2831520338891, 0.0137111148475, -0.9572258061688, -0.0579282922125})};
  });
}

TEST_P(BenchmarkProblems, KnifeEdge) {
  const double c = 9.81 * std::sin(std::numbers::pi / 6), w = 2, end = 1;
  const Vector3 r(c * std::pow(std::sin(w * end), 2) / (2 * w * w),
                  c * (w * end - std::sin(2 * w * end) / 2) / (2 * w * w), 0);
  expect_order_one("knife_edge", end, {100, 200, 400, 800, 1600},
                   [&](const auto& bodies) { return Errors{(bodies[0].r - r).norm()}; });
}

TEST(DoubleFourBar, DependentRowsAreFound) {
  const auto model = std::make_shared<const Model>(compile(scene_of("double_four_bar")));
  const RankAnalysis analysis = analyze_rank(model, given_state(*model), RankNames::all);
  EXPECT_EQ(model->rows.size(), 35u);
  EXPECT_EQ(analysis.rank, 29);
  EXPECT_EQ(analysis.degrees_of_freedom(), 1);
  EXPECT_EQ(analysis.dependent.size(), 6u);
  EXPECT_FALSE(analysis.singular_position());
}

TEST_P(BenchmarkProblems, DoubleFourBarBeforeTheSingularPosition) {
  const double end = 0.5, theta = double_four_bar(end, 2000);
  EXPECT_LT(theta, 1);
  expect_order_one("double_four_bar", end, {50, 100, 200, 400, 800}, [&](const auto& bodies) {
    double error = 0;
    for (std::size_t link = 0; link < 3; ++link) {
      error = std::max(error, (bodies[link].A.col(0) - Vector3(std::sin(theta), std::cos(theta), 0)).norm());
    }
    return Errors{error};
  });
}

// Fifteen passages of the flat position in 20 s.
TEST_P(BenchmarkProblems, DoubleFourBarOverTwentySeconds) {
  const auto tip = [](double end) {
    const double theta = double_four_bar(end, 400000);
    return Vector3(std::sin(theta), std::cos(theta), 0);
  };
  EXPECT_LT((tip(10) - Vector3(0.32845811154065, 0.94451853817866, 0)).norm(), 1e-9);
  for (const double end : {10.0, 20.0}) {
    const auto samples = motion(scene_of("double_four_bar"), controlled("dop853", GetParam(), 1e-8, end, end));
    EXPECT_LT((2 * samples.back().bodies[0].r - tip(end)).norm(), 1e-6) << end;
  }
}

// At θ = π/2 all links lie flat and each loop could fold. A run that comes to its end has kept to the regular branch,
// one that does not says where it stopped and has kept what came before.
TEST_P(BenchmarkProblems, DoubleFourBarThroughTheSingularPosition) {
  const Scene scene = scene_of("double_four_bar");
  for (double step : {1e-2, 2e-3, 1e-3}) {
    const Recorded r = run(scene, dynamics(GetParam(), step, 1));
    ASSERT_FALSE(r.samples.empty());
    for (const Snapshot& sample : r.samples) {
      for (int h = 3; h < 5; ++h) {
        EXPECT_NEAR(sample.bodies[static_cast<std::size_t>(h)].A(1, 0), 0, 1e-6) << GetParam() << ' ' << sample.t;
      }
    }
    if (r.outcome.status.ok()) {
      EXPECT_EQ(r.samples.back().t, 1);
    } else {
      EXPECT_NE(r.outcome.status.message, "");
      EXPECT_GT(r.outcome.status.time, 0.5);
      EXPECT_NEAR(r.samples.back().t, r.outcome.status.time - step, 1e-9);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
