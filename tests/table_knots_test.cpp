// Tables under error control: f‴ jumps at their points, which estimates of the error of high order make little of.
#include "integrators/stepping/table_knots.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene_reader.h"
#include "tests/support/controlled_ways.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using Points = std::vector<std::array<double, 2>>;

Scene tabled(const Points& points, const char* forces) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, 0], "tables": {{"f": {{"points": {}}}}},
      "bodies": [{{"name": "block", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}}],
      "joints": [{{"type": "translational", "bodies": ["ground", "block"], "point": [0, 0, 0], "axis": [1, 0, 0]}}],
      "forces": [{}]}})j",
                                 points, forces),
                     "tabled");
}
constexpr const char* kPushed = R"j({"type": "force", "body": "block", "point": [0, 0, 0], "force": ["f(t)", 0, 0]})j";
constexpr const char* kTabledSpring = R"j({"type": "spring", "bodies": ["ground", "block"], "s_i": [-10, 0, 0],
                                     "s_j": [0, 0, 0], "length": 10, "law": "f(x)"})j";

// To and fro at every point: 0, 1000, 0, −1000 and so on.
Points zigzag(double step, int n) {
  Points points;
  for (int k = 0; k <= n; ++k) points.push_back({step * k, k % 2 == 0 ? 0 : k % 4 == 1 ? 1000.0 : -1000.0});
  return points;
}

class TableKnotsTest : public ControlledWays {};
INSTANTIATE_TEST_SUITE_P(All, TableKnotsTest, ::testing::ValuesIn(controlled_ways()), name_of_way);

// Where a kilogram goes that the table pushes from 1 and from rest: the rule of Gauss, exact for f and (1 − s) f on
// each of its cubics.
double pushed_to(const Spline& table, double step, int n) {
  constexpr double kNodes[] = {0.1127016653792583, 0.5, 0.8872983346207417}, kShare[] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
  double x = 1, v = 0;
  for (int k = 0; k < n; ++k) {
    double speed = 0, way = 0;
    for (int i = 0; i < 3; ++i) {
      const double f = table.at(Jet2<double>{step * (k + kNodes[i]), 1, 0}).f;
      speed += step * kShare[i] * f;
      way += step * step * kShare[i] * (1 - kNodes[i]) * f;
    }
    x += step * v + way, v += speed;
  }
  return x;
}

TEST_P(TableKnotsTest, ForcesByTablesAreFollowed) {
  constexpr double kStep = 0.005;
  constexpr int kParts = 200;
  const Points points = zigzag(kStep, kParts);
  std::vector<double> x, y;
  for (const auto& [t, f] : points) x.push_back(t), y.push_back(f);
  const double right = pushed_to(Spline("f", x, y), kStep, kParts);
  const double allowed = GetParam().integrator == "ida" ? 3e-6 : 6e-8;
  const Recorded r = run(tabled(points, kPushed), settings(1e-8, 1, 1));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_NEAR(r.samples.back().bodies[0].r.x(), right, allowed);
  if (GetParam().integrator != "ida") {
    EXPECT_LT(r.outcome.statistics.rejected_steps, 60);
  }
}

// A spring by a table keeps its energy: ½ v² + U, U by Simpson's rule over parts of its cubics.
TEST_P(TableKnotsTest, LawsByTablesAreFollowed) {
  Points points;
  std::vector<double> x, y;
  for (int k = 0; k <= 40; ++k) {
    points.push_back({-2 + 0.1 * k, 100 * (-2 + 0.1 * k) + 30 * std::sin(40.0 * k * k)});
    x.push_back(points.back()[0]), y.push_back(points.back()[1]);
  }
  const Spline table("f", x, y);
  const auto energy = [&](const BodyState& at) {
    double stored = 0;
    constexpr int kParts = 16;
    for (double from = -2; from < at.r.x(); from += 0.1 / kParts) {
      const double to = std::min(from + 0.1 / kParts, at.r.x());
      const auto f = [&](double s) { return table.at(Jet2<double>{from + s * (to - from), 1, 0}).f; };
      stored += (to - from) / 6 * (f(0) + 4 * f(0.5) + f(1));
    }
    return 0.5 * at.rd.squaredNorm() + stored;
  };
  const Recorded r = run(tabled(points, kTabledSpring), settings(1e-8, 3, 3));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  const double most = GetParam().integrator == "ida" ? 3e-4 : 1e-5;
  EXPECT_NEAR(energy(r.samples.back().bodies[0]), energy(r.samples[0].bodies[0]), most);
}

// Points far closer than steps are smooth: none is stepped onto.
TEST(TableKnots, OfDenseTablesDoNotMatter) {
  Points points;
  for (int k = 0; k <= 20000; ++k) points.push_back({k * 5e-4, 100 * std::sin(k * 1e-3)});
  const Recorded r = run(tabled(points, kPushed), controlled("dop853", "rA", 1e-8, 9.9));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_LT(r.outcome.statistics.steps, 200);
}

TEST(TableKnots, AreFoundWhereTheyMatter) {
  // |x|³ about 0.3, (x − 0.6)³ beyond 0.6, a hundredth of that.
  const auto cubics = [](double s, std::span<int> out) { out[0] = s < 0.3 ? 0 : s < 0.6 ? 1 : 2; };
  const auto slope = [](double s) {
    const double beyond = std::max(s - 0.6, 0.0);
    return 3 * std::abs(s - 0.3) * (s - 0.3) + 0.03 * beyond * beyond;
  };
  EXPECT_NEAR(first_knot(cubics, slope, 1e-6), 0.3, 1e-8);
  EXPECT_NEAR(first_knot(
                  cubics, [&](double s) { return slope(s) - 3 * std::abs(s - 0.3) * (s - 0.3); }, 1e-6),
              0.6, 1e-8);
  EXPECT_EQ(first_knot(cubics, slope, 1), 1);
}

}  // namespace
}  // namespace poinsot::test
