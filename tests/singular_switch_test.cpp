// Kinks and jumps of laws exactly where a mechanism is in a singular position.
#include "integrators/stepping/singular_switch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/scene_reader.h"
#include "tests/support/controlled_ways.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kFlatFrom = 0.8, kGravity = 9.81;

// Cranks of length 1 at the angle kFlatFrom, 2 apart, and a coupler: flat at 0. `law` is of the angle less kFlatFrom.
Scene flat_parallelogram(const char* law) {
  const double x = std::cos(kFlatFrom), z = std::sin(kFlatFrom);
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, -9.81], "bodies": [
      {{"name": "b0", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{2:.17g}, 0, {3:.17g}]}},
      {{"name": "b2", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{5:.17g}, 0, {3:.17g}]}},
      {{"name": "b1", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{4:.17g}, 0, {1:.17g}]}}], "joints": [
      {{"type": "revolute", "bodies": ["ground", "b0"], "point": [0, 0, 0], "axis": [0, -1, 0]}},
      {{"type": "revolute", "bodies": ["b0", "b1"], "point": [{0:.17g}, 0, {1:.17g}], "axis": [0, -1, 0]}},
      {{"type": "revolute", "bodies": ["b1", "b2"], "point": [{6:.17g}, 0, {1:.17g}], "axis": [0, -1, 0]}},
      {{"type": "revolute", "bodies": ["b2", "ground"], "point": [2, 0, 0], "axis": [0, -1, 0]}}], "forces": [
      {{"type": "torsion_spring", "bodies": ["ground", "b0"], "axis": [0, -1, 0], "law": "{7}"}}]}})j",
                                 x, z, 0.5 * x, 0.5 * z, 1 + x, 2 + 0.5 * x, 2 + x, law),
                     "parallelogram");
}

// A slider of mass 1 on z over two equal links, as a leg of Sarrus' linkage; folded where it is at 0. `spring`: between
// it and the ground, whose ends meet there.
Scene leg(const char* spring) {
  const double l = 0.8, z = 0.9, y = std::sqrt(l * l - 0.25 * z * z);
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, -9.81], "bodies": [
      {{"name": "lower", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{0:.17g}, 0, {1:.17g}]}},
      {{"name": "upper", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{0:.17g}, 0, {2:.17g}]}},
      {{"name": "top", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, {3:.17g}]}}], "joints": [
      {{"type": "revolute", "bodies": ["ground", "lower"], "point": [0, 0, 0], "axis": [0, 1, 0]}},
      {{"type": "revolute", "bodies": ["lower", "upper"], "point": [{4:.17g}, 0, {5:.17g}], "axis": [0, 1, 0]}},
      {{"type": "revolute", "bodies": ["upper", "top"], "point": [0, 0, {3:.17g}], "axis": [0, 1, 0]}},
      {{"type": "translational", "bodies": ["ground", "top"], "point": [0, 0, {3:.17g}], "axis": [0, 0, 1]}}],
      "forces": [{{"type": "spring", "bodies": ["ground", "top"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], {6}}}]}})j",
                                 0.5 * y, 0.25 * z, 0.75 * z, z, y, 0.5 * z, spring),
                     "leg");
}

// With two degrees of freedom less: x'' = f(x, x') from x0 at rest, up to a time, in short steps.
template <class Acceleration>
double led_to(double x0, double end, Acceleration f) {
  constexpr int kSteps = 1000000;
  const double h = end / kSteps;
  double x = x0, v = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double a = f(x, v), v2 = v + 0.5 * h * a, a2 = f(x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2,
                 a3 = f(x + 0.5 * h * v2, v3), v4 = v + h * a3, a4 = f(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4), v += h / 6 * (a + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

class SingularSwitch : public ControlledWays {
 protected:
  // z of the last body at the end, or a stop beside the position.
  void expect(const Scene& scene, double right) const {
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      const Recorded r = run(scene, settings(rtol, 1, 1));
      // Steps of radau5 and ida do not come by as near, and say so.
      const bool may_stop = GetParam().integrator == "radau5" || GetParam().integrator == "ida";
      if (may_stop && !r.outcome.status.ok()) continue;
      ASSERT_TRUE(r.outcome.status.ok()) << rtol << ": " << r.outcome.status.message;
      EXPECT_NEAR(r.samples.back().bodies.back().r.z(), right, 2e-6 + 30 * rtol) << rtol;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, SingularSwitch, ::testing::ValuesIn(controlled_ways()), name_of_way);

TEST_P(SingularSwitch, AStopEngagesWhereAParallelogramIsFlat) {
  const double J = 2 * (0.1 + 0.25) + 1;
  const double kink = led_to(
      kFlatFrom, 1, [&](double x, double) { return (-2 * kGravity * std::cos(x) + 300 * std::max(0.0, -x)) / J; });
  expect(flat_parallelogram("-300*max(0, -0.8 - x)"), std::sin(kink));
  const double jump =
      led_to(kFlatFrom, 1, [&](double x, double) { return (-2 * kGravity * std::cos(x) - (x > 0 ? 5 : -5)) / J; });
  expect(flat_parallelogram("5*sign(x + 0.8)"), std::sin(jump));
}

// Its force turns round there, or is as steep on either side. By the angle of the links, z = 1.6 sin.
TEST_P(SingularSwitch, ASpringPassesThroughNoLengthWhereLinksAreFolded) {
  const double l = 0.8, J = 0.1, start = std::asin(0.9 / 1.6);
  const auto at = [&](double stiffness, double length) {
    return 2 * l * std::sin(led_to(start, 1, [&](double x, double v) {
             const double s = std::sin(x), c = std::cos(x), z = 2 * l * s;
             // Of lower, upper and top: (l/2)², (l/2)² (s² + 9 c²), (2 l c)².
             const double M = 2 * J + l * l * (0.25 + 0.25 * (s * s + 9 * c * c) + 4 * c * c);
             const double M_x = l * l * s * c * (0.5 - 4.5 - 8);
             const double F = -stiffness * (z - (z > 0 ? length : -length));
             return (2 * l * c * F - kGravity * l * c * (0.5 + 1.5 + 2) - 0.5 * M_x * v * v) / M;
           }));
  };
  expect(leg(R"("stiffness": 60, "length": 0.7)"), at(60, 0.7));
  expect(leg(R"("stiffness": 60, "length": 0)"), at(60, 0));
}

}  // namespace
}  // namespace poinsot::test
