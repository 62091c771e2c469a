// Runs that cannot succeed, of every model in every formulation by every integrator: each ends with a status, keeps
// finite samples, and touches no memory that is gone (the sanitizers look on in the debug build).
#include <gtest/gtest.h>

#include <cmath>

#include "core/input_error.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

struct Hopeless {
  const char* what;
  void (*set)(Settings&);
};
constexpr Hopeless kHopeless[] = {
    {"one iteration, more asked for than rounding allows",
     [](Settings& s) { s.max_iterations = 1, s.tolerance = 1e-300, s.step = 0.02, s.end = 0.02; }},
    {"steps so long that nothing converges",
     [](Settings& s) { s.max_iterations = 3, s.step = 1e6, s.end = 3e6, s.rtol = 1e-8; }},
    {"steps too short for their squares", [](Settings& s) { s.step = 1e-200, s.end = 1e-199; }},
};

class FailingRuns : public testing::TestWithParam<std::string> {};

TEST_P(FailingRuns, end_with_a_status_that_says_why) {
  int failed = 0;
  for (const std::string& model : model_names()) {
    const Scene scene = scene_of(model);
    for (const IntegratorEntry& integrator : integrators()) {
      for (const Hopeless& hopeless : kHopeless) {
        Settings settings;
        settings.formulation = GetParam();
        settings.integrator = integrator.name;
        settings.analysis = integrator.analysis;
        hopeless.set(settings);
        if (integrator.controls_error && settings.end > 1)
          continue;  // they choose steps that work, a million seconds long
        const std::string where =
            fmt::format("{} {} {}: {}", scene.name, settings.formulation, integrator.name, hopeless.what);
        try {
          double sum = 0;
          const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
            std::vector<BodyState> bodies(scene.bodies.size());
            sample.problem.to_bodies(sample.a, bodies);
            for (const BodyState& body : bodies) sum += 0 * (body.r.sum() + body.rd.sum() + body.w.sum());
          });
          EXPECT_EQ(sum, 0) << where;
          EXPECT_EQ(outcome.status.ok(), outcome.status.message.empty()) << where;
          if (!outcome.status.ok()) ++failed;
        } catch (
            const InputError&) {  // an integrator and a formulation, or kinematics and free motion, do not go together
        }
      }
    }
  }
  EXPECT_GT(failed, 50) << "or these runs test nothing";
}

// Where a distance comes to zero its gradient vanishes. Methods that stop there name it; what they offer instead goes
// on.
TEST_P(FailingRuns, name_a_distance_of_zero) {
  Scene scene;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = Matrix3::Identity(), bob.position = {1, 0, 0},
  bob.velocity = {-1, 0, 0};
  Scene by_axes = scene;
  Constraint& length = scene.constraints.emplace_back();
  length.name = "string", length.type = ConstraintType::D, length.i = kGround, length.j = 0;
  length.f = Expression::parse("(1 - t)^2");
  for (int axis = 0; axis < 3; ++axis) {
    Constraint& along = by_axes.constraints.emplace_back();
    along.name = fmt::format("axis {}", axis), along.type = ConstraintType::CD, along.i = kGround, along.j = 0;
    along.c = Vector3::Unit(axis), along.f = Expression::parse(axis == 0 ? "1 - t" : "0");
  }
  Settings settings = dynamics(GetParam(), 0.0125, 2);
  settings.integrator = "rattle";
  const Recorded r = run(scene, settings);
  ASSERT_FALSE(r.outcome.status.ok());
  EXPECT_NE(r.outcome.status.message.find("'(1 - t)^2' comes to 0"), std::string::npos) << r.outcome.status.message;
  EXPECT_NE(r.outcome.status.message.find("; three CD constraints in its place"), std::string::npos);
  for (const Snapshot& s : motion(by_axes, settings)) EXPECT_NEAR(s.bodies[0].r.x(), 1 - s.t, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Formulations, FailingRuns, testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace poinsot::test
