// Springs with a law, and runs that come to where a function has no value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formulations/law_potential.h"
#include "tests/support/dense_problem.h"
#include "tests/support/every_way.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// A rod that swings on a spring and turns against a torsion spring.
std::string sprung(const std::string& spring, const std::string& torsion) {
  return fmt::format(R"j({{"scene": 1, "name": "sprung", "gravity": [0, 0, -9.81], "bodies": [
    {{"name": "rod", "mass": 2, "inertia": [0.2, 0.3, 0.1], "position": [0.3, 0.1, -1.2], "velocity": [0.5, 0, 0.2],
      "angular_velocity": [0.3, 1, 0.1]}},
    {{"name": "disc", "mass": 1, "inertia": [0.05, 0.05, 0.1], "position": [0.3, 0.1, -1.7]}}],
    "joints": [{{"type": "revolute", "bodies": ["rod", "disc"], "point": [0.3, 0.1, -1.7], "axis": [0, 1, 0]}}],
    "forces": [{{"type": "spring", "bodies": ["ground", "rod"], "s_i": [0, 0, 0], "s_j": [0, 0, 0.4], "length": 0.7, {}}},
               {{"type": "torsion_spring", "bodies": ["rod", "disc"], "axis": [0, 1, 0], "angle": 0.4, {}}}]}})j",
                     spring, torsion);
}

Settings accurate(std::string_view formulation, std::string_view integrator) {
  Settings s;
  s.formulation = formulation;
  s.integrator = integrator;
  s.rtol = 1e-10;
  s.end = 1;
  s.every = 0.25;
  return s;
}

class SpringLaws : public testing::TestWithParam<const char*> {};

TEST_P(SpringLaws, linear_ones_are_linear_springs) {
  const Scene linear =
      parse_scene(sprung(R"j("stiffness": 60, "damping": 3)j", R"j("stiffness": 4, "damping": 0.2)j"), "a");
  const Scene laws = parse_scene(sprung(R"j("law": "60*x + 3*v")j", R"j("law": "v/5 + 4*x")j"), "b");
  for (const char* integrator : {"dop853", "radau5"}) {
    const auto a = motion(linear, accurate(GetParam(), integrator)), b = motion(laws, accurate(GetParam(), integrator));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
      for (std::size_t body = 0; body < 2; ++body)
        EXPECT_LT((a[k].bodies[body].r - b[k].bodies[body].r).norm(), 1e-8) << integrator << " " << a[k].t;
  }
}

TEST_P(SpringLaws, without_rate_and_time_conserve_energy) {
  const Scene scene = parse_scene(sprung(R"j("law": "30*x + 200*x^3 + 20*max(0, x)")j", R"j("law": "5*sin(x)")j"), "a");
  double first = 0, drift = 0, kinetic = 0;
  const Outcome outcome = simulate(scene, accurate(GetParam(), "dop853"), [&](const Sample& sample) {
    if (sample.t == 0) first = sample.problem.energy();
    drift = std::max(drift, std::abs(sample.problem.energy() - first));
    std::vector<BodyState> bodies(2);
    sample.problem.to_bodies(sample.a, bodies);
    kinetic = std::max(kinetic, bodies[0].rd.squaredNorm());
  });
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
  EXPECT_LT(drift, 1e-7);
  EXPECT_GT(kinetic, 0.3);  // it moves
}

// Its direction is undefined, so it pulls in none; moved in any direction it pulls back all the same.
TEST_P(SpringLaws, of_no_length_stiffen_the_newton_matrix) {
  for (const char* law : {R"j("stiffness": 60)j", R"j("law": "60*x + x^3")j"}) {
    const Scene scene = parse_scene(fmt::format(R"j({{"scene": 1, "bodies": [
      {{"name": "ball", "mass": 2, "inertia": [1, 1, 1], "position": [1, 2, 3]}}], "forces": [
      {{"type": "spring", "bodies": ["ground", "ball"], "s_i": [1, 2, 3], "s_j": [0, 0, 0], "length": 0, {}}}]}})j",
                                                law),
                                    "ball.json");
    const std::unique_ptr<Problem> problem = make_problem(GetParam(), compile(scene));
    std::vector<BodyState> at(1);
    at[0].r = Vector3(1, 2, 3);
    VectorX q(problem->nq()), v(problem->nv());
    problem->from_bodies(at, view(q), view(v));
    problem->set_position(0, view(q));
    problem->set_velocity(view(v));
    const VectorX none = VectorX::Zero(problem->nv()), lambda = VectorX::Zero(problem->nc());
    const MatrixX matrix = assemble(*problem, MatrixKind::exact, {1, 0, 0.5}, none, none, lambda);
    EXPECT_LT((matrix.topLeftCorner(3, 3) - 32 * MatrixX::Identity(3, 3)).norm(), 1e-12) << matrix;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SpringLaws, testing::Values("rA", "rp", "reps"),
                         [](const auto& formulation) { return std::string(formulation.param); });

TEST(SpringLaw, stores_the_integral_of_its_force) {
  const auto stored = [](const char* law, double x) {
    const Expression F = Expression::parse_law(law);
    return LawPotential(&F).at(x, 2);
  };
  EXPECT_NEAR(stored("3*x", -0.5), 0.375, 1e-15);
  EXPECT_NEAR(stored("5*sin(x) + 7*v", 2), 5 * (1 - std::cos(2.0)), 1e-14);
  EXPECT_NEAR(stored("100*max(0, x - 0.3)", 1), 50 * 0.49, 1e-12);
  EXPECT_NEAR(stored("t*x + 1", 1), 2, 1e-15);
  EXPECT_EQ(stored("x", 0), 0);
  // What is narrow beside the way is not passed over.
  EXPECT_NEAR(stored("-2000*exp(-(x/0.003)^2)", -1), 3 * std::sqrt(M_PI), 1e-13);
  EXPECT_NEAR(stored("1e6*min(0, abs(x) - 0.001)", 1), -0.5, 1e-13);
  EXPECT_NEAR(stored("1e6*max(0, 0.001 - abs(x - 0.3))", 1), 1, 1e-12);
  EXPECT_NEAR(stored("1 - 2000*exp(-((x - 0.33)/0.003)^2)", 1), 1 - 6 * std::sqrt(M_PI), 1e-12);
  // Far from 0, where x is rounded to more than F is.
  EXPECT_NEAR(stored("0.02*sin(24*x)", 300), 0.02 / 24 * (1 - std::cos(7200.0)), 1e-14);
  EXPECT_NEAR(stored("sin(x + 1e7)", 50), std::cos(1e7) - std::cos(1e7 + 50), 1e-8);
  EXPECT_NEAR(stored("2*pi*sin(2*pi*x)/(1.0001 + cos(2*pi*x))", 40.5), std::log(2.0001 / 1e-4), 1e-8);
  // Where terms cancel to less than their rounding, as beyond 2 here.
  EXPECT_NEAR(stored("25.6*tanh((x - 1)/0.053) - 51.2*tanh(x/0.053) + 25.6*tanh((x + 1)/0.053)", 3.1),
              -51.2 * (1 - 0.053 * std::log(2.0)), 1e-12);
  // From 0 these are infinite.
  EXPECT_NEAR(stored("0.001/x^2", 2), 0.0005, 1e-17);
  EXPECT_NEAR(stored("0.001/x^2", 1e-3), -0.999, 1e-13);
  EXPECT_NEAR(stored("3/x", -2), 3 * std::log(2.0), 1e-14);
}

// Where a function ends, so does the run: with its name, its text and the time.
struct Fault {
  const char *what, *scene, *message;
};
constexpr Fault kFaults[] = {
    {"a pole",
     R"j("forces": [{"type": "force", "name": "push", "body": "rod", "point": [0, 0, 0],
      "force": [0, "1/(0.5 - t)", 0]}]})j",
     "at t = 0\\.[45].* s force 'push' \\(/forces/0\\), component y: '1/\\(0\\.5 - t\\)' (is not finite|grows without "
     "bound towards t = 0\\.5 s); end the run "
     "before, or change "
     "the function"},
    {"a table that ends",
     R"j("tables": {"road": {"points": [[0, 0], [0.2, 1], [0.4, 0]]}}, "drivers": [{"type": "angle", "name": "motor",
      "bodies": ["ground", "rod"], "axis": [0, 0, 1], "angle": "road(t)"}]})j",
     "at t = 0\\.4.* s driver 'motor' \\(/drivers/0\\): 'road\\(t\\)': table 'road' has no value at 0\\.4.*: its "
     "points go from 0 to "
     "0\\.4; .*"},
    {"a length that ends",
     R"j("drivers": [{"type": "distance", "name": "rope", "bodies": ["ground", "rod"], "s_i": [1, 0, -1],
      "s_j": [0, 0, 0], "length": "1 - 2*t"}]})j",
     "at t = 0\\.[45].* s driver 'rope' \\(/drivers/0\\): the length '1 - 2\\*t' is .* m, expected a positive one; .*"},
    {"a law",
     R"j("forces": [{"type": "spring", "name": "rope", "bodies": ["ground", "rod"], "s_i": [0, 0, 0],
      "s_j": [0, 0, 0], "length": 0.9, "law": "10*sqrt(x)"}]})j",
     "at t = .* s force 'rope' \\(/forces/0\\): '10\\*sqrt\\(x\\)' is not finite at x = -.*, v = .*; .*"},
};

TEST(SpringLaw, runs_end_where_a_function_does) {
  const std::string bodies = R"j({"scene": 1, "gravity": [0, 0, 0], "bodies": [
    {"name": "rod", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]},
    {"name": "free", "mass": 1, "inertia": [1, 1, 1], "position": [5, 0, 0]}], )j";
  for (const Fault& fault : kFaults) {
    const Scene scene = parse_scene(bodies + fault.scene, "fault.json");
    const int ways = in_every_way(0.01, 2, [&](Settings settings) {
      settings.rtol = 1e-8;
      settings.every = 0;
      const Recorded run = test::run(scene, settings);
      for (const Snapshot& sample : run.samples) EXPECT_TRUE(sample.bodies[0].r.allFinite());
      if (run.outcome.status.failure == Failure::step_size_too_small) {
        // Before the pole, which grows without bound, or where the length has all but ended.
        EXPECT_THAT(fault.what, testing::AnyOf(testing::StrEq("a pole"), testing::StrEq("a length that ends")));
        if (std::string_view(fault.what) == "a length that ends") {
          EXPECT_THAT(run.outcome.status.message,
                      testing::HasSubstr("driver 'rope' (/drivers/0) has come to a length"));
        }
        EXPECT_NEAR(run.outcome.status.time, 0.5, 1e-9);
        return;
      }
      EXPECT_EQ(run.outcome.status.failure, Failure::not_finite) << fault.what;
      EXPECT_THAT(run.outcome.status.message, testing::MatchesRegex(fault.message)) << fault.what;
    });
    EXPECT_GE(ways, 25);
  }
}

TEST(SpringLaw, a_start_without_a_value_says_so) {
  const Scene scene = parse_scene(R"j({"scene": 1, "bodies": [{"name": "rod", "mass": 1, "inertia": [1, 1, 1],
    "position": [1, 0, 0]}], "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [0, 0, 1],
    "angle": "sqrt(t)"}]})j",
                                  "start.json");
  EXPECT_EQ(run(scene, Settings{}).outcome.status.message,
            "at t = 0 s driver 'angle1' (/drivers/0): the first derivative of 'sqrt(t)' is not finite; the run begins "
            "there: change the function, or write (t + T) for t to begin at T");
}

}  // namespace
}  // namespace poinsot::test
