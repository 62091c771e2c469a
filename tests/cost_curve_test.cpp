// What an accuracy costs: interpolated curves, who is below all others by more than the noise, and what is said of it;
// medians with intervals.
#include "bench/study/cost_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <tuple>

#include "bench/study/interval.h"

namespace poinsot::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ChartRow row(const std::string& integrator, double error, double seconds, double spread = 0.01) {
  ChartRow r{"rA", integrator, kUsualSolver, "step", 1, {}, {}};
  r.measured.error.fill(error);
  r.measured.seconds = seconds;
  r.measured.spread = spread;
  return r;
}

TEST(CostCurve, IsAPowerBetweenTwoCasesAndEndsAtTheFinest) {
  const std::vector<CostCurve> curves = cost_curves({row("a", 1e-2, 1), row("a", 1e-6, 100)}, 0, 1e-16);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].method, "a in rA");
  EXPECT_NEAR(*curves[0].seconds_at(1e-4), 10, 1e-12);
  EXPECT_NEAR(*curves[0].seconds_at(1e-5), std::pow(10, 1.5), 1e-12);
  EXPECT_EQ(*curves[0].seconds_at(0.1), 1) << "its coarsest case does for less";
  EXPECT_FALSE(curves[0].seconds_at(0.9e-6)) << "nothing is known beyond its finest case";
}

TEST(CostCurve, LeavesOutWhatItsOwnCasesBeat) {
  const auto curves = cost_curves({row("a", 1e-2, 1), row("a", 1e-3, 5), row("a", 1e-4, 3)}, 0, 1e-16);
  ASSERT_EQ(curves[0].knots.size(), 2u);
  EXPECT_EQ(curves[0].knots[1].row, 2u);
}

TEST(CostCurve, ErrorsBelowWhatIsResolvedAreEqual) {
  const auto curves = cost_curves({row("a", 1e-2, 1), row("a", 3e-12, 2), row("a", 1e-14, 9)}, 0, 1e-12);
  EXPECT_EQ(curves[0].knots.back().row, 1u);
  EXPECT_DOUBLE_EQ(curves[0].knots.back().error, 1e-11);
}

TEST(CostCurves, FrontIsWhereTheCurveIsBelowTheOthersByMoreThanTheNoise) {
  // b is interpolated at a's accuracy 1e-4: 10 s. There a is apart with 8 s and a noise of a per cent, not with 9.95 s.
  const std::vector<ChartRow> apart{row("a", 1e-4, 8), row("b", 1e-2, 1), row("b", 1e-6, 100)};
  EXPECT_THAT(CostCurves(apart, 0, 1e-16).front(), ElementsAre(true, true, true));
  const std::vector<ChartRow> alike{row("a", 1e-4, 9.95), row("b", 1e-2, 1), row("b", 1e-6, 100)};
  EXPECT_THAT(CostCurves(alike, 0, 1e-16).front(), ElementsAre(false, true, true));
  // Sampled alone at 1e-4, but above the other's curve: nobody beats the case itself, and yet it is not on the front.
  const std::vector<ChartRow> above{row("a", 1e-4, 20), row("b", 1e-2, 1), row("b", 1e-6, 100)};
  EXPECT_THAT(CostCurves(above, 0, 1e-16).front(), ElementsAre(false, true, true));
}

TEST(CostCurves, NoiseIsAtLeastTheChartsMedianSpread) {
  std::vector<ChartRow> rows{row("a", 1e-4, 1, 0), row("b", 1e-4, 1.05, 0), row("c", 1e-4, 9, 0.2),
                             row("d", 1e-4, 9, 0.2), row("e", 1e-4, 9, 0.2)};
  EXPECT_EQ(CostCurves(rows, 0, 1e-16).at(1e-4).alike, 2u) << "spreads of nothing are chance";
  for (ChartRow& r : rows) r.measured.spread = 0.01;
  EXPECT_EQ(CostCurves(rows, 0, 1e-16).at(1e-4).alike, 1u);
}

// One of few repetitions was disturbed: quartiles are far apart, and the median is what it was.
TEST(CostCurves, NoiseOfOneCaseIsBoundedByThatOfTheChart) {
  std::vector<ChartRow> rows{row("a", 1e-4, 1, 3)};
  for (int k = 2; k <= 9; ++k) rows.push_back(row(std::string(1, static_cast<char>('a' + k)), 1e-4, k, 0.01));
  EXPECT_EQ(CostCurves(rows, 0, 1e-16).at(1e-4).alike, 1u);
  rows[1].measured.seconds = 1.04;
  EXPECT_EQ(CostCurves(rows, 0, 1e-16).at(1e-4).alike, 2u) << "it counts as four times the common one";
}

TEST(CostCurves, SaysWhoIsTheFastestAndByHowMuch) {
  const std::vector<ChartRow> rows{row("a", 1e-2, 1), row("a", 1e-5, 10), row("b", 1e-2, 2), row("b", 1e-5, 20),
                                   row("b", 1e-9, 40)};
  EXPECT_EQ(CostCurves(rows, 0, 1e-16).conclusion(),
            "1e-2 to 1e-4 in position: a in rA, 2.0 times as fast as the next, b in rA; 1e-6 to 1e-8: b in rA, which "
            "nothing else reaches");
  EXPECT_THAT(CostCurves({row("a", 1e-3, 1), row("b", 1e-3, 1.001)}, 1, 1e-16).conclusion(),
              HasSubstr("1e-2 in velocity: a in rA, b in rA, alike within the noise"));
  EXPECT_EQ(CostCurves({row("a", 0.5, 1)}, 0, 1e-16).conclusion(), "no case comes below an error of 0.01");
}

TEST(CostCurves, RoundingIsSaidAndNotRanked) {
  const CostCurves curves({row("a", 1e-14, 1), row("b", 3e-15, 2)}, 0, 1e-14);
  EXPECT_TRUE(curves.rounding_only());
  EXPECT_THAT(curves.conclusion(), HasSubstr("what differs is rounding"));
  EXPECT_FALSE(CostCurves({row("a", 1e-14, 1), row("b", 1e-3, 2)}, 0, 1e-14).rounding_only());
}

// 1 − 2 P(B < k) of the binomial distribution, by hand: n = 11, k = 2: 1 − 2 · 12 / 2048.
TEST(Interval, OfTheMedianByTheOrderOfTheValues) {
  const Interval eleven = median_interval({11, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1});
  EXPECT_EQ(eleven.median, 6);
  EXPECT_EQ(eleven.low, 2);
  EXPECT_EQ(eleven.high, 10);
  EXPECT_NEAR(eleven.confidence, 1 - 24.0 / 2048, 1e-15);
  const Interval strict = median_interval({11, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1}, 0.999);
  EXPECT_EQ(strict.low, 1);
  EXPECT_NEAR(strict.confidence, 1 - 2.0 / 2048, 1e-15);
  const Interval few = median_interval({3, 1, 2});
  EXPECT_EQ(few.low, 1);
  EXPECT_EQ(few.high, 3);
  EXPECT_NEAR(few.confidence, 0.75, 1e-15) << "too few for what is asked: all of them, and what that is worth";
  EXPECT_EQ(median_interval({5}).confidence, 0);
  EXPECT_EQ(median_interval({1, 4}).median, 2.5);
}

// A chart that goes on takes a row for the case that it is of, and for no other.
TEST(ChartRow, IsOfOneCase) {
  Case one;
  one.settings.formulation = "rA";
  one.settings.integrator = "dop853";
  one.settings.linear_solver = "klu";
  one.settings.rtol = 1e-6;
  const ChartRow row{"rA", "dop853", "klu", one.parameter(), one.value(), {}, {}};
  EXPECT_TRUE(row.of(one));
  Case other = one;
  other.settings.linear_solver = "block";
  EXPECT_FALSE(row.of(other));
  other = one;
  other.settings.formulation = "rp";
  EXPECT_FALSE(row.of(other));
  other = one;
  other.settings.integrator = "dopri5";
  EXPECT_FALSE(row.of(other));
  other = one;
  other.settings.rtol = 1e-7;
  EXPECT_FALSE(row.of(other));
}

// Both are more accurate than the reference can tell: what is left is their time.
TEST(ChartFile, FrontIsThatOfWhatTheReferenceResolves) {
  std::string folder = (std::filesystem::temp_directory_path() / "poinsot-chart-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  ChartFile file(std::filesystem::path(folder) / "chart.csv", {}, true);
  for (const auto& [integrator, error, seconds] : {std::tuple("dop853", 1e-13, 1.0), {"dopri5", 1e-15, 2.0}}) {
    Case one;
    one.settings.integrator = integrator;
    Measured measured;
    measured.error.fill(error);
    measured.seconds = seconds;
    file.add(one, measured);
  }
  Reference reference;
  reference.methods.emplace_back();
  reference.given = 0;
  reference.agreement.fill(1e-12);
  file.finish(reference);
  for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
    EXPECT_TRUE(file.rows()[0].front[quantity]);
    EXPECT_FALSE(file.rows()[1].front[quantity]);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace poinsot::study
