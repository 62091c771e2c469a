// The explicit Runge–Kutta pairs: orders of every quantity, first steps, singular positions.
#include <gmock/gmock.h>

#include <array>
#include <memory>

#include "integrators/consistent.h"
#include "integrators/dop853.h"
#include "integrators/dopri5.h"
#include "integrators/explicit_stepper.h"
#include "integrators/initial_state.h"
#include "integrators/vectors.h"
#include "tests/support/forced_scene.h"
#include "tests/support/simulation.h"

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

TEST_P(Explicit, StopsWhereItWouldCreep) {
  const Recorded r = run(scene_of("double_four_bar"), settings(1e-13, 10));
  EXPECT_EQ(r.outcome.status.failure, Failure::step_size_too_small);
  EXPECT_THAT(r.outcome.status.message, HasSubstr("singular position"));
  EXPECT_LT(r.outcome.statistics.rejected_steps, 1000);
}

// A stepper at the start of a scene, and what it needs to live.
struct Bench {
  Bench(const Scene& scene, const Settings& settings, const RungeKuttaPair& pair)
      : model(std::make_shared<const Model>(compile(scene))), start(find_initial_state(model, settings)) {
    problem = find_formulation(settings.formulation)->make(model, start.dropped);
    solver = find_linear_solver("dense")->make();  // fresh pivots: orders are measured down to 1e-13
    stepper =
        std::make_unique<ExplicitStepper>(pair, *problem, *solver, settings.rtol, settings.atol, statistics, clock);
    State state;
    state.q.resize(static_cast<std::size_t>(problem->nq()));
    state.v.resize(static_cast<std::size_t>(problem->nv()));
    state.a.resize(state.v.size());
    state.lambda.resize(static_cast<std::size_t>(problem->nc()));
    check(problem->from_bodies(start.bodies, state.q, state.v).ok(), "the formulation represents the start");
    problem->set_position(0, state.q);
    problem->set_velocity(state.v);
    check(Consistent(*problem, "dense").accelerations(*problem, 0, state.a, state.lambda).ok(), "the start is regular");
    check(stepper->prepare().ok(), "the pattern can be analysed");
    stepper->start(0, state);
  }

  // `steps` steps of equal length, a multiple of four, whatever their error; the motion after every quarter.
  std::vector<Snapshot> march(double end, int steps) {
    std::vector<Snapshot> quarters;
    double error = 0;
    for (int n = 1; n <= steps; ++n) {
      check(stepper->attempt(end * n / steps, ExplicitStepper::Stages::as_they_come, error).ok(), "the stages exist");
      check(stepper->complete().ok(), "the step can be projected");
      stepper->settle();
      if (4 * n % steps != 0) continue;
      const poinsot::Point& at = stepper->state();
      problem->set_position(at.t, span(at.q));
      problem->set_velocity(span(at.v));
      quarters.push_back(
          snapshot({at.t, *problem, span(at.q), span(at.v), stepper->points().a(at), stepper->points().lambda(at)}));
    }
    return quarters;
  }

  std::shared_ptr<const Model> model;
  InitialState start;
  std::unique_ptr<Problem> problem;
  std::unique_ptr<LinearSolver> solver;
  Statistics statistics;
  PhaseClock clock;
  std::unique_ptr<ExplicitStepper> stepper;
};

// Positions, velocities, accelerations of the centres of mass (some motions have no angular ones), multipliers.
std::array<double, 4> errors(const std::vector<Snapshot>& x, const std::vector<Snapshot>& exact) {
  const Distance d = distance(x, exact);
  double lambda = 0, size = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (std::size_t k = 0; k < exact[n].lambda.size(); ++k) {
      lambda = std::max(lambda, std::abs(x[n].lambda[k] - exact[n].lambda[k]));
      size = std::max(size, std::abs(exact[n].lambda[k]));
    }
  }
  return {std::max(d.r, d.A), std::max(d.rd, d.w), d.rdd, lambda / size};
}

// A high order shows between steps so long that the next term of the error disturbs it and steps so short that the
// error drowns in rounding: a factor of two in the step, and only where the motion is even enough.
struct OrderCase {
  std::string model;
  double end, within;
  std::vector<int> counts;  // of steps
};
const std::vector<OrderCase> kEighth{{"knife_edge", 8, 0.15, {52, 60, 68, 76, 84, 92}},
                                     {"heavy_top", 1, 0.35, {16, 20, 24, 28, 32}}};
const std::vector<OrderCase> kFifth{{"heavy_top", 1, 0.2, {220, 260, 300, 340, 400}},
                                    {"single_pendulum_free", 6, 0.25, {560, 640, 740, 840, 960}}};

TEST_P(Explicit, OrderIsTheTheoreticalOneInEveryQuantity) {
  for (const OrderCase& c : eighth() ? kEighth : kFifth) {
    Scene scene = scene_of(c.model);
    if (c.model == "heavy_top") scene.bodies[0].angular_velocity = {2.6, -4.2, 1.4};  // slow
    const Settings s = settings(1e-8, c.end);
    const auto exact = Bench(scene, s, dop853_pair()).march(c.end, eighth() ? 2 * c.counts.back() : c.counts.front());
    std::vector<double> steps;
    std::array<std::vector<double>, 4> found;
    for (const int count : c.counts) {
      steps.push_back(c.end / count);
      const auto e = errors(Bench(scene, s, pair()).march(c.end, count), exact);
      for (std::size_t k = 0; k < e.size(); ++k) found[k].push_back(e[k]);
    }
    const char* quantity[] = {"positions", "velocities", "accelerations", "multipliers"};
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_TRUE(converges(steps, found[k], pair().order, c.within)) << c.model << ", " << quantity[k];
    }
  }
}

TEST_P(Explicit, FirstStepSuitsTheTolerance) {
  for (const Scene& scene : {forced(), scene_of("double_pendulum"), scene_of("heavy_top")}) {
    for (const double rtol : {1e-4, 1e-8, 1e-11}) {
      Bench bench(scene, settings(rtol, 1), pair());
      double h = 0;
      ASSERT_TRUE(bench.stepper->first_step(1, h).ok());
      const auto is_good = [&](double step) {
        double error = 0;
        return bench.stepper->attempt(std::min(step, 1.0), ExplicitStepper::Stages::as_they_come, error).ok() &&
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
