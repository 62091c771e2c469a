// Functions of a scene that ask for what no position has, or no step is short enough for, are found.
#include "core/model_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StrEq;

Model asking(ConstraintType type, const char* f) {
  Scene scene = scene_of("free_body");
  Constraint& row = scene.constraints.emplace_back();
  row.name = "row", row.type = type, row.j = 0, row.a_i = {0, 0, 2}, row.a_j = {0, 3, 0}, row.s_j = {1, 0, 0},
  row.c = {1, 0, 0};
  row.f = Expression::parse(f);
  return compile(scene);
}

TEST(BeyondAnyPosition, IsACosineBeyondOneOrASquaredDistanceBelowZero) {
  const auto found = [](ConstraintType type, const char* f, double from, double to) {
    return beyond_any_position(asking(type, f), from, to);
  };
  EXPECT_THAT(found(ConstraintType::DP1, "3*t", 1.9, 2.1),  // of directions of lengths 2 and 3
              StrEq("constraint 'row' asks for a cosine beyond 1 from t = 2 s on"));
  EXPECT_THAT(found(ConstraintType::DP1, "3 - 3*t", 2.9999, 3.0001),
              StrEq("constraint 'row' asks for a cosine beyond -1 from t = 3 s on"));
  EXPECT_THAT(found(ConstraintType::DP1, "7", 0, 0), StrEq("constraint 'row' asks for a cosine beyond 1"));
  EXPECT_THAT(found(ConstraintType::DP1, "6.000000001", 0, 0), StrEq(""));
  EXPECT_THAT(found(ConstraintType::D, "1 - t", 0.5, 1.5),
              StrEq("constraint 'row' asks for a squared distance below 0 from t = 1 s on"));
}

TEST(BeyondAnyPosition, IsNothingWithinReach) {
  EXPECT_THAT(beyond_any_position(asking(ConstraintType::DP1, "6*cos(t)"), 0, 7), IsEmpty());
  EXPECT_THAT(beyond_any_position(asking(ConstraintType::DP1, "3*t"), 1, 1.99), IsEmpty());
  EXPECT_THAT(beyond_any_position(asking(ConstraintType::D, "t^2"), 0, 7), IsEmpty());
  EXPECT_THAT(beyond_any_position(asking(ConstraintType::CD, "100*t"), 0, 7), IsEmpty());
}

TEST(FasterThanTimes, IsADrivenAngleThatNoStepIsShortEnoughFor) {
  const auto found = [](const char* angle, double t, double end) {
    Scene scene = scene_of("free_body");
    Driver& spin = scene.drivers.emplace_back();
    spin.name = "spin", spin.type = DriverType::angle, spin.j = 0, spin.axis = {0, 0, 1};
    spin.value = Expression::parse(angle);
    return faster_than_times(compile(scene), t, t + 1e-3, end);
  };
  EXPECT_THAT(found("1e100*t", 0, 1), StrEq("driver 'spin' turns at 1e+100 rad/s, by 2.2e+84 rad from one time to the "
                                            "next that numbers tell apart"));
  EXPECT_THAT(found("1e100*t^2", 0, 1), ::testing::Not(IsEmpty()));
  EXPECT_THAT(found("exp(100*t)", 0.25, 1), IsEmpty());
  EXPECT_THAT(found("exp(100*t)", 0.4, 1), ::testing::Not(IsEmpty()));
  EXPECT_THAT(found("1e14*t", 0, 1), IsEmpty());
  EXPECT_THAT(found("1e20*t", 0, 1e-7), IsEmpty());
}

TEST(GrowingWithoutBound, IsSeenOfValuesAndRatesOnTheWayToThem) {
  const auto found = [](const char* f) { return growing_without_bound(asking(ConstraintType::CD, f), 0.4995, 0.5005); };
  EXPECT_THAT(found("1/(t - 0.5)^2"), StrEq("constraint 'row': '1/(t - 0.5)^2' grows without bound towards t = 0.5 s"));
  EXPECT_THAT(found("3 + 1/(0.5003 - t)"), HasSubstr("grows without bound towards t = 0.5003 s"));
  EXPECT_THAT(found("sqrt(0.5 - t)"), HasSubstr("the first derivative of 'sqrt(0.5 - t)' grows without bound"));
  EXPECT_THAT(found("asin(2*t)"), HasSubstr("the first derivative of 'asin(2*t)' grows without bound"));
  EXPECT_THAT(found("abs(t - 0.5)^1.5"), HasSubstr("the second derivative of 'abs(t - 0.5)^1.5' grows without bound"));
  for (const char* bounded : {"t", "sin(1e4*t)", "exp(40*t)", "tanh(1e6*(t - 0.5))", "abs(t - 0.5)", "abs(t - 0.5)^3",
                              "1/(t - 0.51)", "sqrt(0.6 - t)", "min(t, 0.5)", "1/(1e-9 + (t - 0.5)^2)"})
    EXPECT_THAT(found(bounded), IsEmpty()) << bounded;
}

}  // namespace
}  // namespace poinsot::test
