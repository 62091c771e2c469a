// The violation that a run reports is that of the bodies it gives out, in every formulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kArmOfBall = 1;  // m, from its centre to the joint

struct OfBody {
  double position = 0, velocity = 0;
};

// Of a body that a ball joint holds at the origin.
OfBody largest_of(const std::vector<Snapshot>& samples) {
  OfBody most;
  for (const Snapshot& sample : samples) {
    const BodyState& b = sample.bodies[0];
    const Vector3 s(0, -kArmOfBall, 0);
    const Matrix3 A = b.A / std::cbrt(b.A.determinant());
    most.position = std::max(most.position, (b.r + A * s).cwiseAbs().maxCoeff());
    most.velocity = std::max(most.velocity, (b.rd + A * b.w.cross(s)).cwiseAbs().maxCoeff());
  }
  return most;
}

class LargestResiduals : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, LargestResiduals, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// In rp p·ṗ is of the order of the step in methods of first order, and hid about half.
TEST_P(LargestResiduals, AreThoseOfTheBodiesGivenOut) {
  const Scene ball = parse_scene(R"j({"scene": 1, "gravity": [0, 0, -9.81], "bodies": [{"name": "a", "mass": 3,
      "inertia": [1, 0.4, 1.1], "position": [0, 1, 0], "angular_velocity": [1, 2, 3], "velocity": [-3, 0, 1]}],
      "joints": [{"type": "spherical", "bodies": ["ground", "a"], "point": [0, 0, 0]}]})j",
                                 "ball");
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings = dynamics(GetParam(), 1e-2, 0.5);
    settings.integrator = integrator.name, settings.every = 0.01;
    const Recorded r = run(ball, settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    const OfBody given = largest_of(r.samples);
    const LargestResidual said = r.outcome.statistics.violation;
    EXPECT_NEAR(said.position, given.position, 0.02 * given.position + 1e-12);
    EXPECT_NEAR(said.velocity, given.velocity, 0.02 * given.velocity + 1e-12);
    if (integrator.name == "implicit_euler" || integrator.name == "half_implicit") {
      EXPECT_GT(said.velocity, 0.05);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
