// What a run does where it cannot go on: which status, at which time, saying what, and keeping what came before; and
// that a step which does go on allocates nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "core/scene_generator.h"
#include "integrators/start/first_state.h"
#include "tests/support/allocations.h"
#include "tests/support/momentary_spin.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class Newton : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  Settings dynamics_with(double step, double end) const {
    Settings settings = dynamics(formulation(), step, end);
    settings.jacobian = std::get<1>(GetParam());
    settings.retry = false;
    return settings;
  }
  Settings kinematics_with(double step, double end) const {
    Settings settings = kinematics(formulation(), step, end);
    settings.jacobian = std::get<1>(GetParam());
    return settings;
  }
  const std::string& formulation() const { return std::get<0>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, Newton,
                         ::testing::Combine(::testing::ValuesIn(formulation_names()),
                                            ::testing::ValuesIn(jacobian_names())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

// What was given out ends one step before the failure, and satisfies the constraints.
void expect_kept(const Recorded& run, double failed, double step) {
  EXPECT_NEAR(run.outcome.status.time, failed, 1e-9);
  ASSERT_FALSE(run.samples.empty());
  EXPECT_NEAR(run.samples.back().t, failed - step, 1e-9);
  EXPECT_EQ(static_cast<double>(run.outcome.statistics.steps), std::round(failed / step) - 1);
  EXPECT_LT(run.outcome.statistics.violation.position, 1e-8);
  for (const Snapshot& sample : run.samples) {
    for (const BodyState& body : sample.bodies) {
      EXPECT_TRUE(body.r.allFinite() && body.A.allFinite() && body.rd.allFinite() && body.w.allFinite());
    }
  }
}

TEST_P(Newton, SpendsItsIterations) {
  Settings settings = dynamics_with(1e-2, 1);
  settings.tolerance = 1e-12;
  settings.max_iterations = 1;
  const Recorded r = run(scene_of("double_pendulum_joints"), settings);
  EXPECT_EQ(r.outcome.status.failure, Failure::not_converged);
  EXPECT_THAT(r.outcome.status.message,
              MatchesRegex("at t = 0.01 s Newton's method did not converge: after 1 iteration the correction is .*, "
                           "the tolerance 1e-12; the largest correction is that of (body 'body_.' "
                           "\\(/bodies/.\\)|joint 'revolute.' \\(/joints/.; its row . of 5\\)|body 'body_.' "
                           "\\(/bodies/.; its normalization\\)); try a smaller step, (the exact jacobian, )?more "
                           "iterations or a larger tolerance"));
  expect_kept(r, 1e-2, 1e-2);
}

// Rounding adds up along a chain, in rp most: to corrections that stay above any tolerance, and to matrices whose
// condition is near that of a singular one.
TEST(NewtonOnLongChains, GoesAsFarAsRoundingLetsItGo) {
  for (const auto& [bodies, end] : {std::pair(1000, 5e-3), std::pair(3000, 1e-3)}) {
    for (const char* solver : {"block", "klu"}) {
      Settings settings = dynamics("rp", 1e-3, end);
      settings.linear_solver = solver;
      const Outcome outcome = simulate(find_scene_generator("chain")->make(bodies), settings, {});
      EXPECT_TRUE(outcome.status.ok()) << bodies << ' ' << solver << ": " << outcome.status.message;
    }
  }
}

// Estimated at 1e12 and more, which is an upper bound; what solutions attain says that the matrix is regular, in rp
// once it is scaled by the sizes that the estimate has found.
TEST(NewtonOnLongChains, SkewHingesOfAStraightChainAreNoSingularMatrix) {
  Scene scene = find_scene_generator("chain")->make(6000);
  for (Joint& joint : scene.joints) joint.axis = {0.2, 0.3, 1};
  struct Way {
    const char *formulation, *solver;
    double within;  // of the velocity, relative: in rp rounding is larger
  };
  std::vector<Recorded> runs;
  for (const auto& [formulation, solver, within] :
       {Way{"rA", "block", 1e-5}, {"rA", "klu", 1e-5}, {"rp", "klu", Settings{}.tolerance}}) {
    Settings settings = dynamics(formulation, 1e-3, 1e-3, 1e-3);
    settings.stopping = Settings{}.stopping;
    settings.tolerance = Settings{}.tolerance;
    settings.linear_solver = solver;
    runs.push_back(run(scene, settings));
    SCOPED_TRACE(std::string(formulation) + " with " + solver);
    ASSERT_TRUE(runs.back().outcome.status.ok()) << runs.back().outcome.status.message;
    const Distance apart = distance(runs.front().samples, runs.back().samples);
    EXPECT_LT(apart.r, 1e-8);
    EXPECT_LT(apart.rd, within);
  }
}

// The test of the original study measures all unknowns together: it grows with their number.
TEST(NewtonOnLongChains, NeedsNoMoreIterationsThanOnShortOnes) {
  const auto move = [](int bodies, std::string_view stopping, double tolerance) {
    Settings settings = dynamics("rA", 1e-3, 4e-3, 4e-3);
    settings.stopping = stopping;
    settings.tolerance = tolerance;
    return run(find_scene_generator("chain")->make(bodies), settings);
  };
  for (const int bodies : {10, 2000}) {
    const Recorded found = move(bodies, "relative", 1e-3), converged = move(bodies, "relative", 1e-9);
    ASSERT_TRUE(found.outcome.status.ok()) << found.outcome.status.message;
    EXPECT_LE(found.outcome.statistics.newton_iterations, 2 * found.outcome.statistics.steps) << bodies;
    for (std::size_t b = 0; b < found.samples.back().bodies.size(); ++b) {
      const BodyState &x = found.samples.back().bodies[b], &y = converged.samples.back().bodies[b];
      EXPECT_LT((x.r - y.r).norm(), 1e-9) << bodies << ' ' << b;
      EXPECT_LT((x.rd - y.rd).norm(), 1e-7) << bodies << ' ' << b;
    }
  }
  const Statistics study = move(2000, "correction", 1e-3).outcome.statistics;
  EXPECT_GT(study.newton_iterations, 2 * study.steps);
}

TEST_P(Newton, SpendsItsIterationsInKinematics) {
  Settings settings = kinematics_with(1e-2, 1);
  settings.max_iterations = 1;
  settings.assembly = Assembly::always;
  const Recorded r = run(scene_of("four_link_joints"), settings);
  EXPECT_EQ(r.outcome.status.failure, Failure::not_converged);
  EXPECT_THAT(
      r.outcome.status.message,
      MatchesRegex(
          "at t = 0.01 s the position did not converge: after 1 iteration the correction is .*, the "
          "tolerance 1e-12; body '.*' \\(/bodies/.\\) moves most; the mechanism may be locked here or the driver ask "
          "for more than it can reach; try more iterations or a larger tolerance"));
  expect_kept(r, 1e-2, 1e-2);
}

// A pendulum of 2 m drawn away from a point 3 m above its pivot: at 5 m it can follow no longer.
Scene drawn_too_far() {
  Scene scene = scene_of("single_pendulum_joints");
  Driver pull;
  pull.name = "pull";
  pull.type = DriverType::distance;
  pull.j = 0;
  pull.s_i = {0, 0, 3};
  const double start = (scene.bodies[0].position - pull.s_i).norm();
  pull.value = Expression::parse(fmt::format("{:.17g} + (5 - {:.17g})*t/0.5", start, start));
  scene.drivers = {pull};
  return scene;
}

TEST_P(Newton, StopsWhereTheMechanismLocks) {
  for (const Settings& settings : {kinematics_with(4e-3, 1), dynamics_with(4e-3, 1)}) {
    const Recorded r = run(drawn_too_far(), settings);
    EXPECT_THAT(r.outcome.status.failure,
                AnyOf(Failure::not_converged, Failure::singular_matrix, Failure::singular_position));
    EXPECT_THAT(r.outcome.status.message, AnyOf(HasSubstr("the driver ask for more than it can reach"),
                                                HasSubstr("did not converge"), HasSubstr("singular position")));
    EXPECT_GT(r.outcome.status.time, 0.47);  // the pendulum speeds up without bound, so steps fail a little before
    EXPECT_LT(r.outcome.status.time, 0.505);
    expect_kept(r, r.outcome.status.time, 4e-3);
  }
}

// A parallelogram driven so that a step ends exactly where its links lie flat and the rocker may go either way. The
// position there can still be found; from it nothing tells where to go on.
Scene flattened() {
  Scene scene;
  const Vector3 link(std::cos(1.0), std::sin(1.0), 0), along(2, 0, 0);
  const std::pair<const char*, Vector3> bars[] = {
      {"crank", link / 2}, {"rocker", along + link / 2}, {"coupler", link + along / 2}};
  for (const auto& [name, position] : bars) {
    Body& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    body.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
    body.position = position;
    body.orientation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  }
  const auto hinge = [&](const char* name, int i, int j, const Vector3& point) {
    Joint& joint = scene.joints.emplace_back();
    joint.name = name;
    joint.i = i, joint.j = j;
    joint.point = point;
    joint.axis = Vector3::UnitZ();
  };
  hinge("A", kGround, 0, {0, 0, 0});
  hinge("B", kGround, 1, along);
  hinge("C", 0, 2, link);
  hinge("D", 1, 2, link + along);
  Driver& motor = scene.drivers.emplace_back();
  motor.name = "motor";
  motor.j = 0;
  motor.axis = Vector3::UnitZ();
  motor.value = Expression::parse("-t");
  return scene;
}

TEST_P(Newton, StopsAtABifurcation) {
  const Recorded r = run(flattened(), kinematics_with(0.05, 2));
  EXPECT_THAT(r.outcome.status.failure,
              AnyOf(Failure::not_converged, Failure::singular_matrix, Failure::singular_position));
  EXPECT_GT(r.outcome.status.time, 0.999);
  EXPECT_LT(r.outcome.status.time, 1.051);
  ASSERT_FALSE(r.samples.empty());
  EXPECT_THAT(r.samples.back().t, AnyOf(testing::DoubleNear(0.95, 1e-9), testing::DoubleNear(1, 1e-9)));
  for (const Snapshot& sample : r.samples)
    for (const std::size_t link : {0u, 1u}) EXPECT_NEAR(sample.bodies[link].w.norm(), 1, sample.t < 0.99 ? 1e-6 : 0.02);
}

// A bob on a spring, by steps of h w = 1: symplectic Euler has it where nothing pulls in every third step, and without
// gravity there is nothing that a correction could be compared with.
TEST(NewtonsMethod, TakesAStepWithoutAnyAcceleration) {
  Scene scene;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = Matrix3::Identity(), bob.position = {1, 0, 0};
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0, spring.stiffness = 1e6, spring.length = 0.75;
  scene.forces.emplace_back(spring);
  Joint& guide = scene.joints.emplace_back();
  guide.name = "guide", guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {1, 0, 0};
  Settings settings;
  settings.integrator = "half_implicit";
  settings.step = 1e-3, settings.end = 0.03;
  for (const FormulationEntry& formulation : formulations()) {
    settings.formulation = formulation.name;
    const std::vector<Snapshot> samples = motion(scene, settings);
    ASSERT_EQ(samples.size(), 31u) << formulation.name;
    for (std::size_t n = 0; n < samples.size(); ++n) {  // 1, 0, -1, -1, 0, 1, ...
      const double expected[] = {0.25, 0, -0.25, -0.25, 0, 0.25};
      EXPECT_NEAR(samples[n].bodies[0].r.x() - 0.75, expected[n % 6], 1e-9) << formulation.name << ' ' << n;
    }
  }
}

// Masses on springs that explicit forces of such steps drive apart without bound: corrections become rounding of what
// has grown, and are small beside it.
TEST(NewtonsMethod, SaysWhatItStillMovesWhereCorrectionsAreSmallBesideWhatHasGrown) {
  int moved = 0;
  for (int masses = 2; masses < 8; ++masses) {
    Scene scene;
    scene.gravity = {0, 0, -9.81};
    for (int k = 0; k < masses; ++k) {
      Body& mass = scene.bodies.emplace_back();
      mass.name = fmt::format("m{}", k), mass.mass = 0.05, mass.inertia = 1e-5 * Matrix3::Identity();
      mass.position = {0.1 + 0.1 * k, 0, 0.001 * k * (k + 1)};
      Spring spring;
      spring.name = fmt::format("s{}", k), spring.i = k - 1, spring.j = k, spring.stiffness = 5000, spring.damping = 1;
      spring.length = 0.1;
      scene.forces.emplace_back(spring);
    }
    for (const double step : {1e-2, 2e-2}) {
      Settings settings;
      settings.integrator = "rattle", settings.step = step, settings.end = 3;
      const std::string message = run(scene, settings).outcome.status.message;
      EXPECT_THAT(message, Not(ContainsRegex("the correction is [^ ]*e-[0-9]+, the tolerance")));
      moved += message.find("after 20 iterations it still moves a body by ") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 0);
}

TEST_P(Newton, NamesABodyWithoutInertia) {
  Scene scene = scene_of("free_body");
  spin_at_the_start(scene, 0);
  const Recorded r = run(scene, dynamics_with(1e-2, 1));
  EXPECT_EQ(r.outcome.status.failure, Failure::singular_matrix);
  EXPECT_THAT(r.outcome.status.message, HasSubstr("at t = 0 s the linear system is singular"));
  EXPECT_THAT(r.outcome.status.message, HasSubstr("has no moment of inertia about the axis (1, 0, 0)"));
  EXPECT_TRUE(r.samples.empty());
}

TEST_P(Newton, StopsWhereAForceIsNotFinite) {
  Scene scene = scene_of("double_pendulum_joints");
  PointForce force;
  force.name = "wild";
  force.body = 1;
  force.force[1] = Expression::parse("1/(t - 0.5)");
  scene.forces = {force};
  const Recorded r = run(scene, dynamics_with(0.01, 1));
  EXPECT_EQ(r.outcome.status.failure, Failure::not_finite);
  EXPECT_THAT(r.outcome.status.message, MatchesRegex("at t = 0.5 s force .wild.*1/\\(t - 0.5\\).* is not finite; .*"));
  expect_kept(r, 0.5, 0.01);
}

TEST_P(Newton, StopsWhereADriverIsNotFinite) {
  Scene scene = scene_of("single_pendulum_joints");
  scene.drivers[0].value = Expression::parse("sqrt(0.505 - t) - sqrt(0.505)");
  for (const Settings& settings : {kinematics_with(0.01, 1), dynamics_with(0.01, 1)}) {
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::not_finite) << r.outcome.status.message;
    EXPECT_THAT(r.outcome.status.message,
                MatchesRegex("at t = 0.5[01].* s driver .*sqrt\\(0.505 - t\\).* is not finite.*"));
    EXPECT_NEAR(r.samples.back().t, 0.5, 1e-9);
  }
}

// A step allocates nothing, but for fresh pivots where the old ones have turned bad, which is seldom.
TEST_P(Newton, StepsAllocateNothing) {
  for (const char* name : {"auto", "klu", "dense"}) {
    for (const char* model : {"four_link", "slider_crank", "slider_crank_joints", "double_pendulum", "andrews"}) {
      for (Settings settings : {dynamics_with(1e-2, 0.4), kinematics_with(1e-2, 0.4)}) {
        const Scene scene = scene_of(model);
        const auto compiled = std::make_shared<const Model>(compile(scene));
        settings.linear_solver = name;
        if (compiled->name.find("Andrews") == 0) settings.step = 1e-5, settings.end = 4e-4, settings.tolerance = 0.1;
        const InitialState start = find_initial_state(compiled, settings);
        const auto problem = formulations().require(formulation()).make(compiled, start.rank.aside);
        if (settings.analysis == Analysis::kinematics && problem->nv() != problem->nc()) continue;
        State state(*problem);
        ASSERT_TRUE(find_first_state(start, settings, *problem, state, [](const std::string&) {}).ok());
        LinearSystems systems({name, "auto"});
        const auto fresh_pivots = [&] {
          std::int64_t sum = 0;
          for (const LinearWork& work : systems.work()) sum += work.factorizations;
          return sum;
        };
        std::int64_t steps = 0, fresh = 0, pivots = 0, allocated = 0, allocating = 0;
        const Observer observe = [&](const Sample& sample) {
          const std::int64_t now = allocations();
          const bool kept = std::string_view(name) == "dense" || fresh_pivots() == pivots;
          // But the start, the first step, and the end, where the error of the accelerations is estimated once.
          if (++steps > 2 && sample.t < settings.end) {
            allocating += kept && now != allocated;
            fresh += !kept;
          }
          pivots = fresh_pivots();
          allocated = allocations();
        };
        Statistics statistics;
        const IntegratorEntry* integrator =
            integrators().find(settings.analysis == Analysis::kinematics ? "kinematics" : "implicit_euler");
        const Status status = integrator->make()->run({*problem, systems, settings, state, observe, statistics, {}});
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(steps, 41);
        EXPECT_LE(fresh, 4) << model << ' ' << name;
        // A look at how near a singular position is, once in a dozen steps, has pivots of its own to choose.
        EXPECT_LE(allocating, 1) << model << ' ' << name;
      }
    }
  }
}

// Nor do steps of the other methods of fixed steps; where pivots are chosen anew, or a look is due, it is the solver's.
TEST_P(Newton, StepsOfNoMethodAllocate) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const char* model : {"double_pendulum", "double_pendulum_joints", "slider_crank_joints"}) {
      Settings settings = dynamics_with(1e-3, 0.04);
      settings.integrator = integrator.name, settings.linear_solver = "dense";
      if (refusal_of(integrator, formulation())) continue;
      std::int64_t steps = 0, allocated = 0, allocating = 0;
      const Outcome outcome = simulate(scene_of(model), settings, [&](const Sample& sample) {
        const std::int64_t now = allocations();
        if (++steps > 2 && sample.t < settings.end) allocating += now != allocated;
        allocated = allocations();
      });
      EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_EQ(steps, 41);
      EXPECT_LE(allocating, 1) << model << ' ' << integrator.name;
    }
  }
}

TEST(Allocations, AreCounted) {
  const long before = allocations();
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(10);
  const std::vector<double> y(static_cast<std::size_t>(x.size()));
  EXPECT_GE(allocations() - before, 2);
}

}  // namespace
}  // namespace poinsot::test
