// The explicit Runge–Kutta pairs: orders of every quantity, first steps, singular positions.
#include <gmock/gmock.h>

#include <array>
#include <memory>

#include "integrators/methods/dop853.h"
#include "integrators/methods/dopri5.h"
#include "tests/support/equal_steps.h"
#include "tests/support/forced_scene.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

class Explicit : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  std::string integrator() const { return std::get<0>(GetParam()); }
  std::string formulation() const { return std::get<1>(GetParam()); }
  bool eighth() const { return integrator() == "dop853"; }
  const RungeKuttaPair& pair() const { return eighth() ? dop853_pair() : dopri5_pair(); }
  Settings settings(double rtol, double end, double every = 0) const {
    return controlled(integrator(), formulation(), rtol, end, every);
  }
};

INSTANTIATE_TEST_SUITE_P(All, Explicit,
                         ::testing::Combine(::testing::Values("dopri5", "dop853"),
                                            ::testing::ValuesIn(formulation_names())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

// Horizontal, with its links on one line, it may leave on another branch; accelerations beside it are rounding.
TEST_P(Explicit, StepsOverSingularPositions) {
  const Recorded r = run(scene_of("double_four_bar"), settings(1e-8, 10, 1));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  const auto tip = [&](std::size_t k) { return Vector3(2 * r.samples[k].bodies[0].r); };  // of the link at the origin
  EXPECT_LT((tip(1) - Vector3(-0.19502030194944, -0.98079920566217, 0)).norm(), 1e-6);
  EXPECT_LT((tip(4) - Vector3(0.11761610237680, 0.99305913845133, 0)).norm(), 1e-6);
  EXPECT_LT((tip(10) - Vector3(0.32845811154065, 0.94451853817866, 0)).norm(), 1e-6);
  EXPECT_LT(r.outcome.statistics.steps, 500);
}

// At the tightest tolerance, too, or a run ends soon.
TEST_P(Explicit, DoesNotCreepUpToSingularPositions) {
  const Recorded r = run(scene_of("double_four_bar"), settings(1e-13, 10, 10));
  if (r.outcome.status.ok()) {
    EXPECT_LT((2 * r.samples.back().bodies[0].r - Vector3(0.32845811154065, 0.94451853817866, 0)).norm(), 1e-6);
  } else {
    EXPECT_EQ(r.outcome.status.failure, Failure::step_size_too_small);
    EXPECT_THAT(r.outcome.status.message, HasSubstr("singular position"));
  }
  EXPECT_LT(r.outcome.statistics.steps, 10'000);
  EXPECT_LT(r.outcome.statistics.rejected_steps, 1000);
}

EqualSteps<ExplicitStepper> bench(const Scene& scene, Settings settings, const RungeKuttaPair& pair) {
  settings.linear_solver = "dense";  // fresh pivots: orders are measured down to 1e-13
  return {scene, settings, [&](Problem& problem, LinearSystems& systems, Statistics& statistics, PhaseClock& clock) {
            return std::make_unique<ExplicitStepper>(pair, problem, systems, settings.rtol,
                                                     settings.absolute_tolerance(), statistics, clock);
          }};
}

// Of order p, an error shows it between steps so long that the next term of the error disturbs the slope and steps so
// short that rounding does: for order 8 there are some motions only for which that leaves room for five steps.
//
// Rounding is what the reference changes by when it takes other steps. Of 1/c of the least error it moves the slope
// between neighbours, whose counts differ by 9/8 or more, by (1 + (8/9)^5)/(c log 9/8) < 14/c at most.
struct OrderCase {
  std::string model;
  double end;
  int reference;            // steps of dop853
  std::vector<int> counts;  // of steps
  double clear;             // c that is asked for
};
const std::vector<OrderCase> kEighth{{"knife_edge", 8, 400, {52, 60, 68, 80, 92}, 1},
                                     {"heavy_top", 1, 400, {16, 20, 24, 28, 32}, 1}};
const std::vector<OrderCase> kFifth{{"forced", 3, 1200, {272, 308, 348, 392, 444}, 500}};

TEST_P(Explicit, OrderIsTheTheoreticalOneInEveryQuantity) {
  for (const OrderCase& c : eighth() ? kEighth : kFifth) {
    Scene scene = c.model == "forced" ? forced() : scene_of(c.model);
    if (c.model == "heavy_top") scene.bodies[0].angular_velocity = {-6, 5, -4};  // slow
    const Settings s = settings(1e-8, c.end);
    const auto exact = quarters(bench(scene, s, dop853_pair()), c.end, c.reference);
    const auto rounding = mean_errors(quarters(bench(scene, s, dop853_pair()), c.end, 3 * c.reference / 4), exact);
    std::vector<double> steps;
    std::array<std::vector<double>, 4> found;
    for (const int count : c.counts) {
      steps.push_back(c.end / count);
      const auto e = mean_errors(quarters(bench(scene, s, pair()), c.end, count), exact);
      for (std::size_t k = 0; k < e.size(); ++k) found[k].push_back(e[k]);
    }
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_GT(found[k].back(), c.clear * rounding[k]) << c.model << ", " << kQuantities[k] << ": too short steps";
      EXPECT_TRUE(converges(steps, found[k], pair().order)) << c.model << ", " << kQuantities[k];
    }
  }
}

TEST_P(Explicit, FirstStepSuitsTheTolerance) {
  for (const Scene& scene : {forced(), scene_of("double_pendulum"), scene_of("heavy_top")}) {
    for (const double rtol : {1e-4, 1e-8, 1e-11}) {
      EqualSteps<ExplicitStepper> at_start = bench(scene, settings(rtol, 1), pair());
      double h = 0;
      ASSERT_TRUE(at_start.stepper->first_step(1, h).ok());
      const auto is_good = [&](double step) {
        double error = 0;
        return at_start.stepper->attempt(std::min(step, 1.0), ExplicitStepper::Stages::as_they_come, error).ok() &&
               error < 1;
      };
      // The even spin of the top hides what its wobble needs from the second derivative.
      EXPECT_TRUE(is_good(scene.name == "heavy top" ? h / 5 : h)) << scene.name << ' ' << rtol;
      EXPECT_FALSE(is_good(300 * h)) << scene.name << ' ' << rtol;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
