// Motions that error control cannot follow to the end, or not in all they have: what it says of them.
#include "integrators/stepping/progress.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "core/interruption.h"
#include "tests/support/every_way.h"
#include "tests/support/remedies.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// Steps as long as that of a motion at t, in a run to t = 1.
TEST(Progress, TellsStepsThatNeverComeToTheEnd) {
  const auto limit = [](const std::function<double(double)>& h) -> std::optional<double> {
    Progress progress(1);
    double t = 0;
    for (int k = 0; k < 200000 && t < 1; ++k) {
      t += h(t);
      if (progress.look(t) && progress.never_ends()) return progress.limit();
    }
    return {};
  };
  for (const double power : {1.5, 2.0, 4.0}) {
    SCOPED_TRACE(power);
    EXPECT_NEAR(limit([&](double t) { return 1e-2 * std::pow(std::abs(0.5 - t), power); }).value_or(0), 0.5, 0.1);
  }
  EXPECT_FALSE(limit([](double t) { return 1e-3 * std::pow(1.02 - t, 2); })) << "beyond the end";
  EXPECT_FALSE(limit([](double t) { return 1e-5 / (0.01 + t); })) << "ever faster";
  EXPECT_FALSE(limit([](double t) { return 1e-3 * std::exp(-5 * t); })) << "ever faster";
  EXPECT_FALSE(limit([](double t) { return t < 0.9 ? 1e-3 : 1e-6; })) << "once";
  EXPECT_FALSE(limit([](double t) { return 1e-6 + 1e-3 * std::pow(std::sin(20 * t), 4); })) << "now and then";
}

TEST(Progress, TellsALongWay) {
  const auto left = [](double h) {
    Progress progress(1);
    for (double t = h; !progress.takes_long() && t < 100000 * h; t += h) progress.look(t);
    return progress.takes_long() ? progress.steps_left() : 0;
  };
  EXPECT_EQ(left(1e-7), 0);
  EXPECT_NEAR(left(1e-9), 1e9, 1e6);
}

class ErrorControlled : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, ErrorControlled, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

template <class Try>
void with_error_control(const std::string& formulation, double end, const Try& attempt) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error || refusal_of(integrator, formulation)) continue;
    SCOPED_TRACE(integrator.name);
    attempt(controlled(integrator.name, formulation, 1e-8, end, end));
  }
}

Scene with_body(const char* name, double inertia) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = name, body.mass = 1, body.inertia = inertia * Matrix3::Identity();
  return scene;
}

Scene speck() {
  Scene scene = with_body("speck", 1e-14);
  Torque& torque = std::get<Torque>(scene.forces.emplace_back(Torque()));
  torque.name = "torque", torque.body = 0, torque.torque[2] = Expression::parse("1");
  return scene;
}

// A ball on a thread that is drawn in to nothing: its angular momentum stays, so that it turns by (1 − t)⁻⁴ rad/s.
TEST_P(ErrorControlled, StepsThatGetShorterTowardsATimeDoNotGoOnForEver) {
  Scene scene = with_body("ball", 1);
  scene.bodies[0].position = {1, 0, 0}, scene.bodies[0].velocity = {-2, 1, 0};
  Driver& thread = scene.drivers.emplace_back();
  thread.name = "thread", thread.type = DriverType::distance, thread.i = kGround, thread.j = 0;
  thread.value = Expression::parse("(1 - t)^2");
  with_error_control(GetParam(), 2, [&](Settings settings) {
    const Recorded r = run(scene, settings);
    expect_stopped(r, Failure::step_size_too_small, "body 'ball'", "end before it");
    EXPECT_THAT(r.outcome.status.message, HasSubstr("steps get shorter and shorter"));
    EXPECT_LT(r.outcome.statistics.steps, 50000);
    settings.end = 0.7;
    expect_helped(scene, settings);
    const BodyState ball = run(scene, settings).samples.back().bodies[0];
    EXPECT_NEAR(ball.r.norm(), 0.09, 1e-7);
    EXPECT_NEAR(ball.r.cross(ball.rd).z(), 1, 1e-5);
  });
}

// A torque on next to nothing: what steps turn by is known to rounding of that.
TEST(ErrorControl, TellsOrientationsThatRoundingLeavesOpen) {
  const auto told = Contains(HasSubstr("rounding alone leaves its orientation open by"));
  int open = 0;
  with_error_control("rA", 0.01, [&](const Settings& settings) {
    const Recorded r = run(speck(), settings);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    const bool rounded = r.outcome.statistics.largest_rotation > 1e8;
    open += rounded;
    if (rounded) {
      EXPECT_THAT(r.outcome.notices, told);
    } else {
      EXPECT_THAT(r.outcome.notices, Not(told));
    }
  });
  EXPECT_GT(open, 0);
}

// Coordinates that follow every turn: the moment it is known, so that it can be ended.
TEST(ErrorControl, TellsALongWay) {
  with_error_control("rp", 0.01, [&](const Settings& settings) {
    std::string told;
    const Outcome outcome = simulate(
        speck(), settings, [](const Sample&) {},
        [&](const std::string& notice) {
          told = notice;
          interruption_requested = true;
        });
    interruption_requested = false;
    EXPECT_EQ(outcome.status.failure, Failure::interrupted);
    EXPECT_THAT(told, ::testing::MatchesRegex("up to t = .* s [0-9]+ steps were done, and as it goes on the end is "
                                              "some [0-9]e.[0-9]+ further ones away"));
  });
}

}  // namespace
}  // namespace poinsot::test
