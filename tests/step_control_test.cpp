// What error control is made of: the times of samples, the length of the next step, and when a run does not get on; and
// the clock of its phases.
#include "integrators/stepping/step_control.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "core/input_error.h"
#include "core/phase_clock.h"
#include "integrators/stepping/sample_times.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

TEST(SampleTimes, AreThoseOfFixedSteps) {
  SampleTimes times(0.1, 1);
  for (int k = 1; k <= 12; ++k, times.pass()) EXPECT_EQ(times.next(), k >= 10 ? 1 : k / 10.0);
  SampleTimes short_last(0.3, 1);  // the end is no multiple
  for (int k = 1; k <= 4; ++k, short_last.pass()) EXPECT_EQ(short_last.next(), k == 4 ? 1 : k * 0.3);
  SampleTimes none(0, 3);
  EXPECT_EQ(none.next(), 3);
}

// Steps and output times are counted: what is too many is refused, and an `every` beyond the end is the end.
TEST(TimeRanges, AreLookedAtBeforeTheyAreCounted) {
  const Scene scene = scene_of("double_pendulum");
  const auto rows = [&](Settings settings) {
    int count = 0;
    EXPECT_TRUE(simulate(scene, settings, [&](const Sample&) { ++count; }).status.ok());
    return count;
  };
  const auto refusal = [&](const Settings& settings) -> std::string {
    try {
      (void)simulate(scene, settings, [](const Sample&) { ADD_FAILURE() << "a sample"; });
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics) continue;
    Settings settings;
    settings.formulation = "rp";
    settings.integrator = integrator.name;
    settings.step = 1e-3;
    settings.end = 0.01;
    for (const double every : {0.01, 0.02, 1e17, 1e300}) {
      settings.every = every;
      EXPECT_EQ(rows(settings), 2) << integrator.name << ' ' << every;
    }
    settings.every = 1e-300;
    EXPECT_EQ(refusal(settings),
              "every: found 1e-300 s with end 0.01 s, which are 1e+298 output times, expected at most 1e15; try a "
              "larger one");
    settings.every = 0;
    settings.end = 1e-320;
    settings.rtol = 1;
    EXPECT_EQ(refusal(settings), "end: found 1e-320, expected a number, at least 1e-292");
    settings.end = 1;
    settings.rtol = 1e-6;
    settings.step = 1e-300;
    if (!integrator.controls_error) {
      EXPECT_EQ(refusal(settings),
                "step: found 1e-300 s with end 1 s, which are 1e+300 steps, expected at most 1e15; try a larger step");
    }
  }
}

// What helps a step of a given length is nothing to a run that chooses its steps.
TEST(StepTooSmall, TellsTheLastAttemptWithoutItsRemedy) {
  const Status cause = with_remedy(Failure::singular_matrix, 1, "the matrix is singular", "try a smaller step");
  EXPECT_EQ(cause.message, "the matrix is singular; try a smaller step");
  EXPECT_EQ(step_too_small(1, 1e-9, cause).message,
            "at t = 1 s the steps became too small to get on with (1e-09 s); the last attempt: the matrix is singular");
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

double all_phases(const PhaseClock& clock) {
  return clock.seconds(Phase::assembly) + clock.seconds(Phase::factor) + clock.seconds(Phase::solve) +
         clock.seconds(Phase::other);
}

// Few laps are all looked at, of many some; phases that never pass take nothing.
TEST(PhaseClock, DividesTheTotalAmongThePhasesThatPass) {
  for (const int laps : {2, 1000, 100000}) {
    PhaseClock clock;
    clock.start();
    for (int k = 0; k < laps; ++k) clock.lap(k % 2 == 0 ? Phase::assembly : Phase::solve);
    clock.stop();
    EXPECT_GT(clock.total(), 0);
    EXPECT_NEAR(all_phases(clock), clock.total(), 1e-9 * clock.total()) << laps;
    EXPECT_GT(clock.seconds(Phase::assembly), 0) << laps;
    EXPECT_GT(clock.seconds(Phase::solve), 0) << laps;
    EXPECT_EQ(clock.seconds(Phase::factor), 0) << laps;
  }
}

TEST(PhaseClock, LeavesPausesOut) {
  using Seconds = std::chrono::duration<double>;
  constexpr Seconds kPause(0.02);
  for (const int laps : {2, 2000}) {  // while every lap is looked at, and while none is
    const auto before = std::chrono::steady_clock::now();
    PhaseClock clock;
    clock.start();
    for (int k = 0; k < laps; ++k) clock.lap(Phase::solve);
    clock.pause();
    std::this_thread::sleep_for(kPause);
    clock.resume();
    clock.lap(Phase::solve);
    clock.stop();
    const Seconds elapsed = std::chrono::steady_clock::now() - before;
    EXPECT_LE(clock.total(), (elapsed - 0.99 * kPause).count()) << laps;
    EXPECT_NEAR(all_phases(clock), clock.total(), 1e-9 * clock.total()) << laps;
  }
}

}  // namespace
}  // namespace poinsot::test
