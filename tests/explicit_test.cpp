// The explicit Runge–Kutta pairs: digits of public benchmark problems, orders of every quantity, dense output, times,
// singular positions, failures.
#include <gmock/gmock.h>

#include <array>
#include <memory>
#include <numbers>

#include "core/so3.h"
#include "integrators/consistent.h"
#include "integrators/dop853.h"
#include "integrators/dopri5.h"
#include "integrators/explicit_stepper.h"
#include "integrators/initial_state.h"
#include "integrators/sample_times.h"
#include "integrators/vectors.h"
#include "tests/support/allocations.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

Settings controlled(std::string_view integrator, std::string_view formulation, double rtol, double end,
                    double every = 0) {
  Settings s;
  s.integrator = integrator;
  s.formulation = formulation;
  s.rtol = rtol;
  s.atol = 1e-2 * rtol;
  s.end = end;
  s.every = every;
  return s;
}

class Explicit : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  std::string integrator() const { return std::get<0>(GetParam()); }
  std::string formulation() const { return std::get<1>(GetParam()); }
  bool eighth() const { return integrator() == "dop853"; }
  const RungeKuttaPair& pair() const { return eighth() ? dop853_pair() : dopri5_pair(); }
  Settings settings(double rtol, double end, double every = 0) const {
    return controlled(integrator(), formulation(), rtol, end, every);
  }
  // The bodies at the end of a run that has to reach it; dop853 is asked for 1e-9 and more, dopri5 for 1e-8.
  std::vector<BodyState> final_bodies(std::string_view model, double end) const {
    return motion(scene_of(model), settings(eighth() ? 1e-12 : 1e-11, end, end)).back().bodies;
  }
  double bound() const { return eighth() ? 2e-10 : 4e-9; }
};

INSTANTIATE_TEST_SUITE_P(All, Explicit,
                         ::testing::Combine(::testing::Values("dopri5", "dop853"),
                                            ::testing::ValuesIn(formulation_names())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

Matrix3 turn(const Vec4<double>& p) {
  return rotation_from_parameters<double>(p);
}

// Digits: IFToMM benchmark library, IVP test set, and extrapolation in extended precision; all of them are given.
TEST_P(Explicit, SimplePendulum) {
  const BodyState body = final_bodies("simple_pendulum", 10)[0];
  EXPECT_LT((body.r - Vector3(-0.27508746257612, -0.96141920509913, 0)).norm(), bound());
  EXPECT_LT((body.rd - Vector3(4.17559810095173, -1.19474905456048, 0)).norm(), 10 * bound());
}

TEST_P(Explicit, HeavyTop) {
  const BodyState body = final_bodies("heavy_top", 1)[0];
  EXPECT_LT((body.r - Vector3(0.17334396409839, 0.64008859207057, -0.74849079113358)).norm(), bound());
  EXPECT_LT((body.A - turn({0.73294398067966, -0.27828571933761, 0.53182461133416, -0.32017614273625})).norm(),
            10 * bound());  // a turn of 150 rad
}

TEST_P(Explicit, FreeBody) {
  const BodyState body = final_bodies("free_body", 20)[0];
  EXPECT_LT((body.w - Vector3(-0.10532100800937, -0.99443877904670, 0.06081259389334)).norm(), 30 * bound());
}

TEST_P(Explicit, Andrews) {
  const std::vector<BodyState> bodies = final_bodies("andrews", 0.03);
  const double angles[] = {15.81077119515371, 15.81077119515371 - 15.75637105841184, 0.0408222401196456};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT((bodies[k].A.col(0) - Vector3(std::cos(angles[k]), std::sin(angles[k]), 0)).norm(), bound()) << k;
  }
  EXPECT_NEAR(bodies[0].w.norm(), std::abs(bodies[0].w.y()), 1e-9);
}

TEST_P(Explicit, DoublePendulum) {
  const auto samples = motion(scene_of("double_pendulum"), settings(eighth() ? 1e-12 : 1e-11, 5, 0.1));
  const auto reference = reference_motion("ode_double_pendulum");
  ASSERT_EQ(samples.size(), reference.size());
  const Distance apart = distance(samples, reference);
  EXPECT_LT(std::max(apart.r, apart.A), bound());
  EXPECT_LT(std::max({apart.rd, apart.w, apart.rdd, apart.wd}), 10 * bound());
}

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

// Forces of every kind, dissipative ones and such as depend on time, on a spatial double pendulum.
Scene forced() {
  return parse_scene(R"json({
    "scene": 1, "name": "forced", "gravity": [0, 0, -9.81],
    "bodies": [
      {"name": "upper", "mass": 2, "inertia": [0.1, 0.2, 0.25], "position": [0, 0.5, 0], "angular_velocity": [1, 0.5, -1]},
      {"name": "lower", "mass": 1, "inertia": [0.05, 0.02, 0.06], "position": [0.4, 1, 0], "angular_velocity": [0, 1, 2],
       "orientation": {"axis": [1, 0, 0], "angle": 0.4}}],
    "joints": [
      {"type": "spherical", "bodies": ["ground", "upper"], "point": [0, 0, 0]},
      {"type": "revolute", "bodies": ["upper", "lower"], "point": [0, 1, 0], "axis": [0, 1, 1]}],
    "forces": [
      {"type": "force", "body": "lower", "point": [0.1, 0, 0.2], "force": ["2*sin(3*t)", 0, "cos(2*t)"], "frame": "body"},
      {"type": "torque", "body": "upper", "torque": [0, 0, "0.5*cos(t)"]},
      {"type": "spring", "bodies": ["ground", "lower"], "s_i": [1, 1, 1], "s_j": [0, 0, 0.1], "stiffness": 40, "damping": 3, "length": 0.5},
      {"type": "torsion_spring", "bodies": ["upper", "lower"], "axis": [0, 1, 1], "stiffness": 5, "damping": 0.3, "angle": 0.1},
      {"type": "linear_drag", "body": "upper", "translational": 0.4, "rotational": 0.2}]})json",
                     "forced");
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

TEST_P(Explicit, ErrorsFollowTheTolerance) {
  const Scene scene = forced();
  const double end = 2;
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, end, end));
  std::int64_t before = 0;
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Recorded r = run(scene, settings(rtol, end, end));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_LT(distance(r.samples, exact).largest(), 50 * rtol) << rtol;
    EXPECT_GT(r.outcome.statistics.steps, before);
    EXPECT_LT(r.outcome.statistics.rejected_steps, r.outcome.statistics.steps / 4 + 4);
    before = r.outcome.statistics.steps;
  }
}

// Between the steps as good as at them; and on the constraints.
TEST_P(Explicit, SamplesByDenseOutput) {
  const Scene scene = forced();
  const double end = 2, every = 0.013;
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, end, every));
  for (const double rtol : {1e-6, 1e-9}) {
    const Recorded r = run(scene, settings(rtol, end, every));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    ASSERT_LT(r.outcome.statistics.steps, eighth() ? 100 : 1000);
    EXPECT_LT(distance(r.samples, exact).largest(), 100 * rtol) << rtol;
    EXPECT_LT(r.outcome.statistics.violation.position, 1e-13) << rtol;
    EXPECT_LT(r.outcome.statistics.violation.velocity, 1e-12) << rtol;

    const Recorded ends = run(scene, settings(rtol, end, end));  // sampling does not change the motion
    EXPECT_EQ(ends.outcome.statistics.steps, r.outcome.statistics.steps);
    EXPECT_LT(distance({ends.samples.back()}, {r.samples.back()}).largest(), 1e-11);
  }
}

TEST_P(Explicit, SamplesAreMultiplesAndTheEnd) {
  const Scene scene = scene_of("double_pendulum");
  const auto times = [&](double end, double every) {
    std::vector<double> t;
    for (const Snapshot& sample : motion(scene, settings(1e-7, end, every))) t.push_back(sample.t);
    return t;
  };
  EXPECT_THAT(times(1, 0.25), ::testing::ElementsAre(0, 0.25, 0.5, 0.75, 1));
  EXPECT_THAT(times(1, 0.3), ::testing::ElementsAre(0, 0.3, 2 * 0.3, 3 * 0.3, 1));
  EXPECT_THAT(times(0.1, 2), ::testing::ElementsAre(0, 0.1));
  const std::vector<double> tenths = times(0.7, 0.1);
  ASSERT_EQ(tenths.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(tenths[k], k == 7 ? 0.7 : 0.7 * (static_cast<double>(k) / 7));

  const Recorded all = run(scene, settings(1e-7, 1));
  EXPECT_EQ(all.samples.size(), static_cast<std::size_t>(all.outcome.statistics.steps) + 1);
  EXPECT_EQ(all.samples.back().t, 1);
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

TEST_P(Explicit, IsDeterministic) {
  const Settings s = settings(1e-8, 2, 0.01);
  const auto once = motion(forced(), s), again = motion(forced(), s);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t n = 0; n < once.size(); ++n) {
    EXPECT_EQ(once[n].lambda, again[n].lambda) << n;
    for (std::size_t b = 0; b < once[n].bodies.size(); ++b) EXPECT_EQ(once[n].bodies[b].A, again[n].bodies[b].A) << n;
  }
}

// Nor do samples between the steps, changes of chart and rejected steps.
TEST_P(Explicit, StepsAllocateNothing) {
  for (const Scene& scene : {forced(), scene_of("heavy_top"), scene_of("double_pendulum")}) {
    for (const double every : {0.0, 0.003}) {
      Settings s = settings(1e-7, 0.3, every);
      s.linear_solver = "dense";  // klu allocates fresh pivots
      long samples = 0, allocated = 0;
      const Outcome outcome = simulate(scene, s, [&](const Sample&) {
        const long now = allocations();
        EXPECT_TRUE(++samples <= 3 || now == allocated) << now - allocated << " before sample " << samples;
        allocated = now;
      });
      EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_GT(samples, 5);
    }
  }
}

TEST_P(Explicit, StopsWhereAForceGrowsWithoutBound) {
  Scene scene = scene_of("double_pendulum");
  Torque torque;
  torque.body = 0;
  torque.torque[2] = Expression::parse("100/(0.5-t)^3");
  scene.forces.emplace_back(torque);
  const Recorded r = run(scene, settings(1e-8, 1));
  EXPECT_EQ(r.outcome.status.failure, Failure::step_size_too_small);
  EXPECT_NEAR(r.outcome.status.time, 0.5, 0.01);
  EXPECT_THAT(r.outcome.status.message, HasSubstr("grows without bound"));
  ASSERT_GT(r.samples.size(), 2u);  // those before are good
  EXPECT_LE(r.samples.back().t, r.outcome.status.time);
  EXPECT_TRUE(r.samples.back().bodies[0].A.allFinite());
}

TEST_P(Explicit, StopsAtASingularStart) {
  Scene scene = scene_of("double_pendulum");
  scene.bodies[1].mass = 0;
  scene.bodies[1].inertia.setZero();
  const Outcome outcome = simulate(scene, settings(1e-8, 1), {});
  EXPECT_EQ(outcome.status.failure, Failure::singular_matrix);
  EXPECT_EQ(outcome.statistics.steps, 0);
}

TEST(SampleTimes, AreThoseOfFixedSteps) {
  SampleTimes times(0.1, 1);
  for (int k = 1; k <= 12; ++k, times.pass()) EXPECT_EQ(times.next(), k >= 10 ? 1 : k / 10.0);
  SampleTimes none(0, 3);
  EXPECT_EQ(none.next(), 3);
}

TEST(StepController, KeepsWithinItsBounds) {
  const StepRule rule{0.9, 0.2, 0.0, 0.2, 5};
  StepController c(rule);
  EXPECT_DOUBLE_EQ(c.accepted(1, 1), 0.9);
  EXPECT_DOUBLE_EQ(c.accepted(1, 0), 5);
  EXPECT_DOUBLE_EQ(c.accepted(1, std::pow(0.9 / 2, 5)), 2);
  EXPECT_DOUBLE_EQ(c.rejected(1, 32), 0.45);
  EXPECT_DOUBLE_EQ(c.accepted(1, 1e-8), 1);  // no growth after a rejection
  EXPECT_DOUBLE_EQ(c.accepted(1, 1e-8), 5);
  EXPECT_DOUBLE_EQ(c.rejected(1, 1e30), 0.2);
  EXPECT_DOUBLE_EQ(c.failed(1), 0.2);
}

}  // namespace
}  // namespace poinsot::test
