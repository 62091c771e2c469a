// A mechanism of any size moves as a small one does, in times that go with the root of its length: rounding of
// positions goes with it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

Scene double_pendulum_of(double length) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "name": "double pendulum", "gravity": [0, 0, -9.81], "bodies": [
      {{"name": "upper", "mass": 1, "inertia": [{2:.17g}, {2:.17g}, {2:.17g}], "position": [0, {0:.17g}, 0]}},
      {{"name": "lower", "mass": 1, "inertia": [{2:.17g}, {2:.17g}, {2:.17g}], "position": [0, {1:.17g}, 0]}}],
      "joints": [{{"type": "revolute", "bodies": ["ground", "upper"], "point": [0, 0, 0], "axis": [1, 0, 0]}},
      {{"type": "revolute", "bodies": ["upper", "lower"], "point": [0, {3:.17g}, 0], "axis": [1, 0, 0]}}]}})j",
                                 0.6 * length, 1.8 * length, 0.1 * length * length, 1.2 * length),
                     "double_pendulum");
}

class HugeMechanisms : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, HugeMechanisms, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(HugeMechanisms, MoveAsSmallOnesDo) {
  constexpr double kTime = 2;  // s, of a metre
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
    const auto end = [&](double length) {
      const double t = kTime * std::sqrt(length);
      return motion(double_pendulum_of(length), controlled(integrator.name, GetParam(), 1e-8, t, t)).back().bodies[1];
    };
    const BodyState small = end(1);
    for (const double length : {1e9, 1e12}) {
      SCOPED_TRACE(fmt::format("{} {}", integrator.name, length));
      EXPECT_LT((end(length).r / length - small.r).norm(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
