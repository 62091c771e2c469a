// What is given out as acceleration and multiplier where rounding has spoilt those of index 3.
#include <gmock/gmock.h>

#include <limits>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// A pendulum whose hinge is `far` away from the origin; its centre is a metre from the hinge, at the angle given.
Scene pendulum(double far) {
  Scene scene;
  scene.name = "far pendulum";
  scene.gravity = {0, 0, -9.81};
  Body rod;
  rod.name = "rod";
  rod.mass = 2;
  rod.inertia = Vector3(0.6, 0.01, 0.6).asDiagonal();
  rod.position = {0, far + 1, 0};
  scene.bodies.push_back(rod);
  Joint hinge;
  hinge.type = JointType::revolute;
  hinge.j = 0;
  hinge.point = {0, far, 0};
  hinge.axis = {1, 0, 0};
  scene.joints.push_back(hinge);
  return scene;
}

struct Index3Method {
  std::string integrator, formulation;
};
std::vector<Index3Method> index3_methods() {
  std::vector<Index3Method> all;
  for (const char* integrator : {"implicit_euler", "half_implicit", "generalized_alpha", "generalized_alpha_i2"})
    for (const FormulationEntry& formulation : formulations())
      all.push_back({integrator, std::string(formulation.name)});
  return all;
}

class Index1Output : public ::testing::TestWithParam<Index3Method> {
 protected:
  Recorded run_far(double far, double step, int steps) const {
    Settings s = dynamics(GetParam().formulation, step, steps * step, steps * step);
    s.integrator = GetParam().integrator;
    s.tolerance = 1e-3;
    return run(pendulum(far), s);
  }
};
INSTANTIATE_TEST_SUITE_P(All, Index1Output, ::testing::ValuesIn(index3_methods()),
                         [](const auto& test) { return test.param.integrator + "_" + test.param.formulation; });

// From the horizontal: the first moments of the fall, a = −m g l²/(m l² + I) along z, 3 g/... at the hinge.
TEST_P(Index1Output, TakesThePlaceOfWhatRoundingHasSpoilt) {
  for (const auto& [far, step] : {std::pair(1e3, 1e-5), {1e6, 1e-4}, {1e8, 1e-3}}) {
    const Recorded r = run_far(far, step, 20);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    const double t = 20 * step, alpha = -2 * 9.81 / 2.6, theta = alpha * t * t / 2, rate = alpha * t;
    const double turn = alpha * std::cos(theta);
    const Vector3 expected = turn * Vector3(0, -std::sin(theta), std::cos(theta)) -
                             rate * rate * Vector3(0, std::cos(theta), std::sin(theta));
    const double loose = 1e-12 * far + 20 * step;  // of the position, and of the method
    EXPECT_LT((r.samples.back().bodies[0].rdd - expected).norm(), loose) << far << ' ' << step;
    ASSERT_TRUE(r.outcome.statistics.acceleration_error);
    EXPECT_EQ(r.outcome.statistics.acceleration_error->index, 1) << far;
    // Of velocities that are off by the rounding of positions over the step, and turn at this rate.
    const double rounding = std::numeric_limits<double>::epsilon() * far;
    EXPECT_LT(r.outcome.statistics.acceleration_error->acceleration, 1e-6 + 50 * rounding * (std::abs(rate) / step + 1))
        << far;
  }
}

// At the usual steps it is what the step has computed, and the error is estimated.
TEST_P(Index1Output, LeavesRegularMotionsAsTheyAre) {
  const Recorded coarse = run_far(0, 1e-2, 50), fine = run_far(0, 1e-3, 500);
  for (const Recorded* r : {&coarse, &fine}) {
    ASSERT_TRUE(r->outcome.statistics.acceleration_error);
    EXPECT_EQ(r->outcome.statistics.acceleration_error->index, 3);
  }
  const double theirs = fine.outcome.statistics.acceleration_error->acceleration;
  EXPECT_GT(theirs, 0);
  EXPECT_LT(theirs, 0.2);
  EXPECT_LT(theirs, 0.3 * coarse.outcome.statistics.acceleration_error->acceleration);
}

}  // namespace
}  // namespace poinsot::test
