// What error control is made of: the times of samples, the length of the next step, and when a run does not get on.
#include "integrators/stepping/step_control.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrators/stepping/sample_times.h"

namespace poinsot::test {
namespace {

TEST(SampleTimes, AreThoseOfFixedSteps) {
  SampleTimes times(0.1, 1);
  for (int k = 1; k <= 12; ++k, times.pass()) EXPECT_EQ(times.next(), k >= 10 ? 1 : k / 10.0);
  SampleTimes none(0, 3);
  EXPECT_EQ(none.next(), 3);
}

TEST(Creeping, TellsStepsThatDoNotGetOn) {
  const auto stops = [](double h, double growth, int most) {
    Creeping creeping(1);
    double t = 0;
    for (int k = 0; k < most && t < 1; ++k, t += h, h *= growth) {
      if (creeping.tries(t, h)) return true;
      creeping.completed(h);
    }
    return false;
  };
  EXPECT_TRUE(stops(1e-100, 1, 20000));
  EXPECT_TRUE(stops(0, 1, 20000));
  EXPECT_FALSE(stops(1e-100, 1.1, 20000));  // from a small start
  EXPECT_FALSE(stops(2e-10, 1, 100000));
  EXPECT_TRUE(stops(0.01, 0.9, 1000));  // towards a point

  // Of steps that cover 1e-9 each, every `period`-th is rejected.
  const auto stops_rejecting = [](int period) {
    Creeping creeping(1);
    double t = 0;
    for (int k = 1; k <= 100000; ++k) {
      if (creeping.tries(t, 1e-9)) return true;
      if (k % period == 0) continue;
      creeping.completed(1e-9);
      t += 1e-9;
    }
    return false;
  };
  EXPECT_TRUE(stops_rejecting(2));
  EXPECT_TRUE(stops_rejecting(3));
  EXPECT_FALSE(stops_rejecting(5));
}

TEST(StepController, KeepsWithinItsBounds) {
  const StepRule rule{0.9, 0.2, 0.0, 0.2, 5};
  StepController c(rule);
  EXPECT_DOUBLE_EQ(c.accepted(1, 1), 0.9);
  EXPECT_DOUBLE_EQ(c.accepted(1, 0), 5);
  EXPECT_DOUBLE_EQ(c.accepted(1, std::pow(0.9 / 2, 5)), 2);
  EXPECT_DOUBLE_EQ(c.rejected(1, 32), 0.45);
  EXPECT_DOUBLE_EQ(c.accepted(1, 1e-8), 1);  // no growth after a rejection
  EXPECT_DOUBLE_EQ(c.accepted(1, 1e-8), 5);
  EXPECT_DOUBLE_EQ(c.rejected(1, 1e30), 0.2);
  EXPECT_DOUBLE_EQ(c.failed(1), 0.2);
}

// The second step's error is 16 times the first's at the same length: at this rate the third's would be 16 times
// larger.
TEST(StepController, FollowsTheTrend) {
  StepController c({1, 0.25, 0.0, 0.2, 8, true});
  EXPECT_DOUBLE_EQ(c.accepted(1, 1.0 / 16), 2);
  EXPECT_DOUBLE_EQ(c.accepted(1, 1), 0.5);
  StepController steady({1, 0.25, 0.0, 0.2, 8, true});
  EXPECT_DOUBLE_EQ(steady.accepted(1, 1.0 / 16), 2);
  EXPECT_DOUBLE_EQ(steady.accepted(2, 1.0 / 16), 4);
}

}  // namespace
}  // namespace poinsot::test
