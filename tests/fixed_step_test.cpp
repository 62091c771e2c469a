// Integrators of fixed step over a run: constraints, symmetry, cost, failures, refusals.
#include <gmock/gmock.h>

#include "core/input_error.h"
#include "integrators/start/first_state.h"
#include "integrators/start/initial_state.h"
#include "integrators/stepping/fixed_steps.h"
#include "tests/support/fixed_step_cases.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

class FixedStep : public ::testing::TestWithParam<std::string> {};  // by formulation

INSTANTIATE_TEST_SUITE_P(Formulations, FixedStep, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(FixedStep, ConstraintsAreKept) {
  for (const Case& c : cases(GetParam())) {
    for (const Method& method : kSecondOrder) {
      const Recorded r = run(c.scene, settings_of(method.name, GetParam(), c.step, c.end, 0));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      const auto& worst = r.outcome.statistics.violation;
      EXPECT_LT(worst.position, 1e-11) << c.name << ", " << method.name;
      if (method.name == "generalized_alpha") {
        EXPECT_GT(worst.velocity, 1e-9) << c.name << ": index 3 leaves the velocities to the order of the method";
      } else {
        EXPECT_LT(worst.velocity, 1e-10) << c.name << ", " << method.name;
      }
    }
  }
}

// There and back: the final state with its velocities turned round leads to the initial one.
double way_back(const Scene& scene, const std::string& integrator, const std::string& formulation, double step,
                double end) {
  const Settings settings = settings_of(integrator, formulation, step, end, end);
  const std::vector<Snapshot> forth = motion(scene, settings);
  Scene turned = scene;
  for (std::size_t b = 0; b < turned.bodies.size(); ++b) {
    const BodyState& state = forth.back().bodies[b];
    turned.bodies[b].position = state.r;
    turned.bodies[b].orientation = state.A;
    turned.bodies[b].velocity = -state.rd;
    turned.bodies[b].angular_velocity = -state.w;
  }
  std::vector<Snapshot> back = motion(turned, settings);
  for (BodyState& state : back.back().bodies) state.rd *= -1, state.w *= -1;
  const Distance d = distance({{0, back.back().bodies, {}}}, {{0, forth.front().bodies, {}}});
  return std::max({d.r, d.A, d.rd, d.w});
}

TEST_P(FixedStep, RattleIsSymmetric) {
  const Scene pendulum = turning("double_pendulum", {0, 0, 1}), top = scene_of("heavy_top");
  EXPECT_LT(way_back(pendulum, "rattle", GetParam(), 0.01, 1), 1e-11);
  if (GetParam() != "reps") {  // the way back starts in another chart
    EXPECT_LT(way_back(top, "rattle", GetParam(), 2e-4, 0.05), 1e-11);
  }
  EXPECT_GT(way_back(pendulum, "generalized_alpha_i2", GetParam(), 0.01, 1), 1e-6);  // the measure sees what is not
}

TEST_P(FixedStep, StepsCostOneFactorization) {
  const Scene scene = scene_of("double_pendulum");
  for (const auto& [integrator, more] : {std::pair{"rattle", 1}, std::pair{"half_implicit", 0}}) {
    const Recorded r = run(scene, settings_of(integrator, GetParam(), 0.01, 1, 1));
    EXPECT_EQ(r.outcome.statistics.steps, 100);
    EXPECT_EQ(r.outcome.statistics.factorizations, 100 + more) << integrator;
  }
}

TEST_P(FixedStep, FailureNamesTimeAndPlaceAndKeepsWhatWasComputed) {
  Scene scene = scene_of("double_pendulum");
  for (const std::string integrator : {"generalized_alpha", "generalized_alpha_i2", "rattle", "half_implicit"}) {
    Settings settings = settings_of(integrator, GetParam(), 0.01, 1, 0);
    settings.max_iterations = 1;
    settings.retry = false;
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::not_converged) << integrator;
    EXPECT_THAT(r.outcome.status.message, HasSubstr("at t = 0.01 s Newton's method did not converge"));
    EXPECT_THAT(r.outcome.status.message, HasSubstr("the largest correction is that of "));
    EXPECT_EQ(static_cast<std::int64_t>(r.samples.size()), r.outcome.statistics.steps + 1) << integrator;
  }
}

// Steps for which the iterations allowed do not suffice: their halves need fewer. Whether the last of them still do is
// up to rounding, one run in thirty or so.
TEST_P(FixedStep, DoesAStepThatFailsInParts) {
  const Scene scene = turning("double_pendulum", {0, 0, 1});
  int divided = 0;
  for (const double h : {0.02, 0.019, 0.018, 0.017}) {
    const double end = 100 * h;
    const std::vector<Snapshot> exact = reference(scene, h, end, end);
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || integrator.controls_error) continue;
      SCOPED_TRACE(integrator.name);
      Settings settings = settings_of(integrator.name, GetParam(), h, end, end);
      settings.tolerance = 1e-7;
      const Recorded whole = run(scene, settings);
      ASSERT_TRUE(whole.outcome.status.ok()) << whole.outcome.status.message;
      EXPECT_EQ(whole.outcome.statistics.divided_steps, 0);

      for (settings.max_iterations = 2; settings.max_iterations < 20; ++settings.max_iterations) {
        settings.retry = false;
        if (run(scene, settings).outcome.status.ok()) break;
        settings.retry = true;
        const Recorded parts = run(scene, settings);
        const Statistics& statistics = parts.outcome.statistics;
        if (!parts.outcome.status.ok()) continue;  // with so few iterations no step succeeds
        ++divided;
        EXPECT_GT(statistics.divided_steps, 0);
        EXPECT_GT(statistics.steps, whole.outcome.statistics.steps + statistics.divided_steps - 1);
        EXPECT_THAT(parts.outcome.notices, ::testing::Contains(HasSubstr("were done in parts")));
        // Of symplectic methods equal steps leave errors that cancel in part.
        EXPECT_LT(errors(parts.samples, exact)[0], 3 * errors(whole.samples, exact)[0]);
      }
    }
  }
  EXPECT_GE(divided, 8);
}

// A step that fails is done in parts where the method allows it; where it does not a smaller step is what to try.
TEST_P(FixedStep, OffersASmallerStepWhereStepsAreNotDivided) {
  const Scene scene = scene_of("double_pendulum");
  for (const std::string integrator : {"generalized_alpha", "generalized_alpha_i2"}) {
    Settings settings = settings_of(integrator, GetParam(), 0.01, 1, 0);
    settings.max_iterations = 1;
    const Recorded r = run(scene, settings);
    ASSERT_EQ(r.outcome.status.failure, Failure::not_converged) << integrator;
    const bool divides = integrator == "generalized_alpha";
    EXPECT_THAT(r.outcome.status.message,
                HasSubstr(divides ? "try an integrator with error control" : "try a smaller step"));
    settings.max_iterations = 20;
    EXPECT_TRUE(run(scene, settings).outcome.status.ok());
  }
}

// At rest without any load nothing has a size that corrections could be relative to.
TEST_P(FixedStep, RestsWithoutALoad) {
  Scene scene = scene_of("double_pendulum");
  scene.gravity.setZero();
  scene.forces.clear();
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || integrator.controls_error) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings = settings_of(integrator.name, GetParam(), 0.01, 0.1, 0.1);
    settings.stopping = Settings{}.stopping;
    for (const bool free : {false, true}) {
      if (free) {
        scene.constraints.clear();
        scene.joints.clear();
      }
      const Recorded r = run(scene, settings);
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        EXPECT_LT((r.samples.back().bodies[b].r - scene.bodies[b].position).norm(), 1e-14);
        EXPECT_LT(r.samples.back().bodies[b].rdd.norm(), 1e-9);
      }
    }
  }
}

// A step that fails as a whole, and whose halves change the velocity by a factor each.
class Creeps final : public FixedSteps {
 public:
  Creeps(const Run& run, double factor) : FixedSteps(run), factor_(factor) {}

  Status prepare() override { return {}; }
  Status step(double t) override {
    if (h_ > 0.6 * grid_.step()) return {Failure::not_converged, t, "as a whole"};
    x_.v = factor_ * v_n_;
    const Vector way = h_ * x_.v;
    problem_.retract(span(q_n_), span(way), span(x_.q));
    return {};
  }

 private:
  double factor_;
};

// Where parts of a step creep up to a singular position velocities jump to where rounding leads: such a step is refused
// as it failed, and nothing of it stays.
TEST_P(FixedStep, RefusesADividedStepThatJumps) {
  Scene scene;
  Body body;
  body.name = "body", body.mass = 1, body.inertia = Matrix3::Identity(), body.velocity = {1, 0, 0};
  scene.bodies.push_back(body);
  const auto model = std::make_shared<const Model>(compile(scene));
  for (const double factor : {1.2, 1.3}) {
    Settings settings = settings_of("implicit_euler", GetParam(), 0.1, 0.1, 0);
    const InitialState start = find_initial_state(model, settings);
    const auto problem = formulations().require(GetParam()).make(model, start.rank.aside);
    State state(*problem);
    ASSERT_TRUE(find_first_state(start, settings, *problem, state, [](const std::string&) {}).ok());
    LinearSystems systems(settings.linear());
    Statistics statistics;
    const Tell tell = [](const std::string&) {};
    const Observer observe = [](const Sample&) {};
    const Status status = Creeps({*problem, systems, settings, state, observe, statistics, tell}, factor).march();
    if (factor * factor < 1.5) {
      EXPECT_TRUE(status.ok()) << status.message;
      EXPECT_NEAR(state.v[0], factor * factor, 1e-15);
    } else {
      EXPECT_EQ(status.message, "as a whole");
      EXPECT_EQ(state.t, 0);
      EXPECT_EQ(state.v[0], 1);
      EXPECT_EQ(state.q[0], 0);
    }
  }
}

// What stabilized index 2 is for: rounding of Φ over h² reaches the multipliers of index 3, not its own.
TEST_P(FixedStep, SmallStepsSpareTheMultipliers) {
  const Scene scene = turning("double_pendulum", {0, 0, 1});
  const double h = 5e-6, end = 0.005;
  const std::vector<Snapshot> exact = reference(scene, h, end, end / 10);
  const auto multipliers = [&](std::string_view integrator) {
    return errors(motion(scene, settings_of(integrator, GetParam(), h, end, end / 10)), exact)[3];
  };
  EXPECT_LT(multipliers("generalized_alpha_i2"), 1e-9);
  EXPECT_LT(multipliers("generalized_alpha"), 1e-8);  // given out at index 1
}

TEST_P(FixedStep, TheEndIsGivenOutWhereTheIntervalDoesNotDivideIt) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || integrator.controls_error) continue;
    Settings settings = dynamics(GetParam(), 1e-3, 0.01, 3e-3);
    settings.integrator = integrator.name;
    std::vector<double> times;
    for (const Snapshot& sample : motion(scene_of("double_pendulum"), settings)) times.push_back(sample.t);
    EXPECT_THAT(times, ::testing::Pointwise(::testing::DoubleEq(), {0.0, 0.003, 0.006, 0.009, 0.01}))
        << integrator.name;
  }
}

// A spring far too stiff for the step, out of rest: the start must not take its v̈ for the motion's.
TEST(FixedStepStart, UnresolvedSpringStaysBounded) {
  Scene scene = parse_scene(R"json({"scene": 1, "name": "stiff",
    "bodies": [{"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": ["1 + 1e-7", 0, 0]}],
    "forces": [{"type": "spring", "bodies": ["ground", "ball"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "stiffness": 1e10, "damping": 1, "length": 1}]})json",
                            "stiff");
  for (const std::string integrator : {"generalized_alpha", "generalized_alpha_i2"}) {
    Settings settings = settings_of(integrator, "rA", 0.01, 1, 0);  // h ω = 1000
    settings.tolerance = 1e-6;                                      // accelerations are of order 1e3
    const std::vector<Snapshot> found = motion(scene, settings);
    for (const Snapshot& s : found) ASSERT_LT(std::abs(s.bodies[0].r.x() - 1), 2e-7) << integrator << ' ' << s.t;
    EXPECT_LT(std::abs(found.back().bodies[0].r.x() - 1), 1e-9) << integrator;
  }
}

// Every refusal of every integrator, made to say why.
TEST(IntegratorRegistry, RefusalsAreInputErrors) {
  const Scene scene = scene_of("double_pendulum");
  int refused = 0;
  for (const IntegratorEntry& entry : integrators()) {
    for (const FormulationEntry& formulation : formulations()) {
      const std::optional<Refusal> refusal = refusal_of(entry, formulation.name);
      EXPECT_EQ(refusal.has_value(), entry.needs_vector_space && formulation.space != CoordinateSpace::vector_space);
      if (!refusal) continue;
      ++refused;
      Settings s;
      s.integrator = entry.name;
      s.formulation = formulation.name;
      try {
        (void)simulate(scene, s, {});
        ADD_FAILURE() << entry.name << " takes " << formulation.name;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(refusal->why));
      }
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace poinsot::test
