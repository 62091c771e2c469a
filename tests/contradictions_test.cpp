// Constraints that contradict one another, or themselves, later than the run begins: no run ends as if they held.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/input_error.h"
#include "core/scene_reader.h"
#include "integrators/start/rank.h"
#include "tests/support/remedies.h"
#include "tests/support/twice_driven.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

Scene contradicting(const std::string& rest, const char* pose = "") {
  return parse_scene(R"json({"scene": 1, "name": "contradicting", "gravity": [0, -9.81, 0],
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0.5, 0, 0])json" +
                         std::string(pose) + "}], " + rest + "}",
                     "test");
}
const char* const kHinge = R"json("joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"],
    "point": [0, 0, 0], "axis": [0, 0, 1]}])json";
const char* const kClamp = R"json("joints": [{"type": "fixed", "name": "clamp", "bodies": ["ground", "rod"],
    "point": [0, 0, 0]}])json";

// All methods that take it, of dynamics and kinematics.
std::vector<Settings> every_way(std::string_view formulation, double end) {
  std::vector<Settings> all;
  for (const IntegratorEntry& entry : integrators()) {
    if (refusal_of(entry, formulation)) continue;
    Settings s = controlled(entry.name, formulation, 1e-7, end, end / 10);
    s.step = end / 500;
    if (entry.analysis == Analysis::kinematics) {
      s.integrator = Settings().integrator;
      s.analysis = Analysis::kinematics;
    }
    all.push_back(s);
  }
  return all;
}

class Contradictions : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Contradictions, ::testing::Values("rA", "rp", "reps"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Contradictions, OfPositionsThatJumpEndTheRun) {
  const Scene scene = contradicting(kHinge + std::string(R"json(, "drivers": [{"type": "angle", "bodies": ["ground",
    "rod"], "axis": [0, 0, 1], "angle": "t^2 + 0.1*step(t - 0.505)"}])json"));
  for (const Settings& settings : every_way(GetParam(), 1)) {
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::inconsistent_state) << settings.integrator;
    EXPECT_NEAR(r.outcome.status.time, 0.505, 1e-9) << settings.integrator;
    EXPECT_THAT(r.outcome.status.message, HasSubstr("prescribes a jump of positions")) << settings.integrator;
    EXPECT_EQ(r.samples.size(), 6u) << settings.integrator;
  }
}

// A kink that a step() makes of something continuous is no jump.
TEST_P(Contradictions, AreNotKinks) {
  const Scene scene = contradicting(kHinge + std::string(R"json(, "drivers": [{"type": "angle", "bodies": ["ground",
    "rod"], "axis": [0, 0, 1], "angle": "t^2 + (t - 0.505)*step(t - 0.505)"}])json"));
  for (const Settings& settings : every_way(GetParam(), 1)) {
    const Recorded r = run(scene, settings);
    EXPECT_TRUE(r.outcome.status.ok()) << settings.integrator << r.outcome.status.message;
  }
}

// −sin θ = sin t as a row, cos θ = g as its alternate: θ = −t.
Scene with_alternate(const char* g) {
  return contradicting(kHinge + std::string(R"json(, "constraints": [{"type": "DP1", "name": "motor",
    "bodies": ["ground", "rod"], "a_i": [0, -1, 0], "a_j": [1, 0, 0], "f": "cos(t - pi/2)",
    "alternate": {"a_i": [1, 0, 0], "a_j": [1, 0, 0], "f": ")json") +
                       g + R"json("}}])json");
}
TEST_P(Contradictions, OfAnAlternateEndTheRun) {
  const Scene by_angle = contradicting(kHinge + std::string(R"json(, "drivers": [{"type": "angle", "bodies": ["ground",
    "rod"], "axis": [0, 0, 1], "angle": "-t"}])json"));
  for (const Settings& settings : every_way(GetParam(), 2)) {
    const Recorded right = run(with_alternate("-sin(t - pi/2)"), settings);
    EXPECT_TRUE(right.outcome.status.ok()) << settings.integrator << right.outcome.status.message;
    const Recorded r = run(with_alternate("-sin(t - pi/2) + 0.01"), settings);
    EXPECT_FALSE(r.outcome.status.ok()) << settings.integrator;
    EXPECT_NEAR(r.outcome.status.time, std::asin(0.9), 0.2) << settings.integrator;
    if (!integrators().require(settings.integrator).controls_error) {
      EXPECT_THAT(r.outcome.status.message, HasSubstr("and its alternate contradict one another"))
          << settings.integrator;
      EXPECT_THAT(remedy_of(r), ::testing::EndsWith("or an angle driver takes the place of both"));
    }
    const Recorded angle = run(by_angle, settings);
    ASSERT_TRUE(angle.outcome.status.ok()) << settings.integrator << angle.outcome.status.message;
    EXPECT_LT((angle.samples.back().bodies[0].A - right.samples.back().bodies[0].A).norm(), 0.02)
        << settings.integrator;
  }
}

// What kinematics leaves of positions at the default tolerance is no contradiction.
TEST_P(Contradictions, AreNotWhatAToleranceLeaves) {
  for (const char* model : {"slider_crank", "four_link"})
    for (const char* jacobian : {"exact", "kept", "simplified"})
      for (const double step : {0.05, 0.03, 0.02, 0.013, 0.007, 0.003}) {
        Settings settings = kinematics(GetParam(), step, 2);
        settings.jacobian = jacobian, settings.tolerance = Settings().tolerance;
        const Recorded r = run(scene_of(model), settings);
        EXPECT_TRUE(r.outcome.status.ok()) << model << ' ' << jacobian << ' ' << step << r.outcome.status.message;
      }
}

std::string blade(const char* a, const char* f) {
  return std::string(R"json(, "constraints": [{"type": "pfaffian", "name": "blade", "bodies": ["ground", "rod"],
    "a_j": )json") +
         a + R"json(, "s_i": [0, 0, 0], "s_j": [0.3, 0.2, 0.1], "f": ")json" + f + R"json("}])json";
}

// A velocity row on a body that is held stands at zero where the run begins.
TEST(VelocityRows, ThatContradictAreRefused) {
  const Scene scene = contradicting(kClamp + blade("[1, 2, 3]", "0.2*t"));
  try {
    (void)simulate(scene, Settings(), {});
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("m/s (velocity, at t = 0.001 s)"));
  }
}
TEST_P(Contradictions, OfVelocitiesLaterEndTheRun) {
  const Scene scene = contradicting(kClamp + blade("[1, 2, 3]", "0.2*max(0, t - 0.5)"));
  for (const Settings& settings : every_way(GetParam(), 1)) {
    if (settings.analysis == Analysis::kinematics) continue;
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::constraint_lost) << settings.integrator;
    EXPECT_THAT(r.outcome.status.message, HasSubstr("m/s: it followed from the other constraints"));
    EXPECT_EQ(remedy_of(r), "; one of them has to go");
    EXPECT_TRUE(simulate(contradicting(kClamp), settings, {}).status.ok()) << settings.integrator;
  }
}

// Two drivers of one hinge that stay within 1e-5 rad of one another and ask for velocities that do not.
TEST_P(Contradictions, OfRatesEndTheRun) {
  const Scene scene = twice_driven("sin(t)", "sin(t) + 9e-6*sin(1000*max(0, t - 0.1))^4");
  for (const Settings& settings : every_way(GetParam(), 0.5)) {
    if (settings.analysis == Analysis::kinematics) continue;
    const Recorded r = run(scene, settings);
    const bool told = std::ranges::any_of(r.outcome.notices, [](const std::string& notice) {
      return notice.find("set aside, as it follows from other constraints, and is off") != std::string::npos;
    });
    if (r.outcome.status.ok()) {  // velocities of these methods are differences of positions
      EXPECT_THAT(settings.integrator, ::testing::AnyOf("implicit_euler", "half_implicit", "generalized_alpha"));
      EXPECT_TRUE(told) << settings.integrator;
      continue;
    }
    EXPECT_EQ(r.outcome.status.failure, Failure::constraint_lost) << settings.integrator;
    EXPECT_THAT(r.outcome.status.message, HasSubstr("the rate of driver 'sin(t)")) << settings.integrator;
  }
}

// By less it is told; and not of what differs by rounding, or for an instant by where a kink is.
TEST_P(Contradictions, ThatAreSmallAreTold) {
  const char* const apart = "was set aside, as it follows from other constraints, and is off those by up to";
  for (const Settings& settings : every_way(GetParam(), 0.5)) {
    const Recorded r = run(twice_driven("sin(t)", "sin(t) + 9e-6*sin(3*t)^4"), settings);
    ASSERT_TRUE(r.outcome.status.ok()) << settings.integrator << ' ' << r.outcome.status.message;
    EXPECT_THAT(r.outcome.notices, ::testing::Contains(HasSubstr(apart))) << settings.integrator;
    for (const auto& [first, second] : {std::pair("2*t + sin(t)", "sin(t) + 0.5*t*4"),
                                        std::pair("abs(t - 0.25) - 0.25", "abs(t - 0.25000000001) - 0.25000000001")}) {
      const Recorded same = run(twice_driven(first, second), settings);
      EXPECT_TRUE(same.outcome.status.ok()) << settings.integrator << ' ' << same.outcome.status.message;
      EXPECT_THAT(same.outcome.notices, ::testing::Not(::testing::Contains(HasSubstr(apart)))) << settings.integrator;
    }
  }
}

// Bodies of a size on an arm of a metre, the second of two rows between which says `later` of it.
Scene small_on_arm(double size, const char* type, const char* later) {
  const auto row = [&](const char* name, const char* part) {
    const std::string value = fmt::format("{:.17g}*({})", size, part);
    return fmt::format(R"j({{"type": "{}", "name": "{}", "bodies": ["p", "q"], {} "s_i": [0, 0, 0], "s_j": [0, 0, 0],
        "f": "{}"}})j",
                       type, name, type == std::string("D") ? "" : R"j("a_i": [1, 0, 0],)j",
                       type == std::string("D") ? "(" + value + ")^2" : value);
  };
  return parse_scene(fmt::format(R"j({{"scene": 1, "name": "small", "gravity": [0, 0, 0], "bodies": [
      {{"name": "arm", "mass": 1000, "inertia": [83, 83, 83], "position": [-0.5, 0, 0], "velocity": [0, 0.05, 0],
        "angular_velocity": [0, 0, 0.1]}},
      {{"name": "p", "mass": 1e-9, "inertia": [{1:.17g}, {1:.17g}, {1:.17g}], "position": [0, 0, 0],
        "velocity": [0, 0.1, 0], "angular_velocity": [0, 0, 0.1]}},
      {{"name": "q", "mass": 1e-9, "inertia": [{1:.17g}, {1:.17g}, {1:.17g}], "position": [{0:.17g}, 0, 0],
        "velocity": [0, {2:.17g}, 0], "angular_velocity": [0, 0, 0.1]}}], "joints": [
      {{"type": "revolute", "bodies": ["ground", "arm"], "point": [-1, 0, 0], "axis": [0, 0, 1]}},
      {{"type": "fixed", "bodies": ["arm", "p"], "point": [0, 0, 0]}},
      {{"type": "translational", "bodies": ["p", "q"], "point": [0, 0, 0], "axis": [1, 0, 0]}}],
      "constraints": [{3}, {4}]}})j",
                                 size, 1e-10 * size * size, 0.1 + 0.1 * size, row("first", "1"), row("second", later)),
                     "small");
}

// What is small beside a body is not by what that hangs on.
TEST_P(Contradictions, AreSeenInSmallPartsOfLargeMechanisms) {
  Settings settings = controlled("dop853", GetParam(), 1e-8, 1, 1);
  for (const char* type : {"DP2", "D"}) {
    for (const double size : {1e-1, 1e-3, 1e-5, 1e-6, 1e-7}) {
      SCOPED_TRACE(fmt::format("{} {}", type, size));
      EXPECT_TRUE(run(small_on_arm(size, type, "1"), settings).outcome.status.ok());
      EXPECT_THROW((void)run(small_on_arm(size, type, "1.5"), settings), InputError);
      const Recorded r = run(small_on_arm(size, type, "1 + 4*max(0, t - 0.5)^2"), settings);
      EXPECT_EQ(r.outcome.status.failure, Failure::constraint_lost) << r.outcome.status.message;
    }
  }
}

// A triangle of two bars on the arm, open as far as it can be: it turns them by half a radian, and is small.
TEST(SmallLoops, OnLargeBodiesAreAssembled) {
  for (const double size : {1e-2, 1e-4, 1e-5, 1e-6}) {
    const double x = 0.25 * size, y = 0.25 * std::sqrt(3) * size;  // centres of bars of that size at 60 degrees
    const std::string bars = fmt::format(
        R"j({{"name": "r1", "mass": 1e-3, "inertia": [{0:.17g}, {0:.17g}, {0:.17g}], "position": [{1:.17g}, {2:.17g}, 0],
            "orientation": {{"axis": [0, 0, 1], "angle": "pi/3"}}}},
        {{"name": "r2", "mass": 1e-3, "inertia": [{0:.17g}, {0:.17g}, {0:.17g}], "position": [{3:.17g}, {2:.17g}, 0],
            "orientation": {{"axis": [0, 0, 1], "angle": "2*pi/3"}}}})j",
        1e-4 * size * size, x, y, size - x);
    const auto hinge = [](const char* i, const char* j, double at_i, double at_j) {
      return fmt::format(
          R"j({{"type": "revolute", "bodies": ["{}", "{}"], "s_i": [{:.17g}, 0, 0], "s_j": [{:.17g}, 0, 0],
          "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]}})j",
          i, j, at_i, at_j);
    };
    const Scene scene = parse_scene(
        R"j({"scene": 1, "name": "triangle", "gravity": [0, 0, 0], "bodies": [
          {"name": "arm", "mass": 1000, "inertia": [83, 83, 83], "position": [-0.5, 0, 0]}, )j" +
            bars + R"j(], "joints": [)j" + hinge("ground", "arm", -1, -0.5) + ", " +
            hinge("arm", "r1", 0.5, -0.5 * size) + ", " + hinge("arm", "r2", 0.5 + size, -0.5 * size) + ", " +
            hinge("r1", "r2", 0.5 * size, size) + "]}",
        "triangle");
    Settings settings = controlled("dop853", "rA", 1e-8, 0.1);
    settings.assembly = Assembly::always;
    const Recorded r = run(scene, settings);
    ASSERT_TRUE(r.outcome.status.ok()) << size << ' ' << r.outcome.status.message;
    const BodyState &r1 = r.samples.back().bodies[1], &r2 = r.samples.back().bodies[2];
    const Vector3 gap = r1.r + r1.A * Vector3(0.5 * size, 0, 0) - r2.r - r2.A * Vector3(size, 0, 0);
    EXPECT_LT(gap.norm(), 1e-9 * size) << size;
  }
}

// Of a hinge and a velocity row that follows from it the latter is set aside: it keeps no positions.
TEST_P(Contradictions, AreNotVelocityRowsThatFollow) {
  for (const double angle : {0.3, 1.1, 2.0}) {
    const std::string pose = fmt::format(R"(, "orientation": {{"axis": [1, 2, 2], "angle": {}}})", angle);
    const Scene alone = contradicting(kHinge, pose.c_str());
    const Vector3 axis = alone.bodies[0].orientation.transpose() * Vector3(0, 0, 1);
    const std::string along = fmt::format("[{:.17g}, {:.17g}, {:.17g}]", axis.x(), axis.y(), axis.z());
    const Scene scene = contradicting(kHinge + blade(along.c_str(), "0"), pose.c_str());
    const auto model = std::make_shared<const Model>(compile(scene));
    std::vector<BodyState> states(1);
    states[0].r = scene.bodies[0].position, states[0].A = scene.bodies[0].orientation;
    const RankAnalysis rank = analyze_rank(model, states, RankNames::none);
    ASSERT_EQ(rank.aside.size(), 1u);
    EXPECT_EQ(model->rows[static_cast<std::size_t>(rank.aside[0])].type, RowType::pfaffian) << angle;
    for (const Settings& settings : every_way(GetParam(), 1)) {
      if (settings.analysis == Analysis::kinematics) continue;
      const Recorded with = run(scene, settings), without = run(alone, settings);
      ASSERT_TRUE(with.outcome.status.ok()) << settings.integrator << with.outcome.status.message;
      EXPECT_LT((with.samples.back().bodies[0].r - without.samples.back().bodies[0].r).norm(), 1e-6)
          << settings.integrator;
    }
  }
}

// Nor one that is the lesser part of the rows that it follows from: of two that are a tenth of a radian apart ten
// times.
TEST(VelocityRows, AreSetAsideBeforePositionsThatLeanOnOneAnother) {
  const Scene scene = contradicting(R"j("constraints": [
      {"type": "CD", "bodies": ["ground", "rod"], "c": [1, 0, 0], "s_i": [0, 0, 0], "s_j": [-0.5, 0, 0]},
      {"type": "CD", "bodies": ["ground", "rod"], "c": [1, 0.3, 0], "s_i": [0, 0, 0], "s_j": [-0.5, 0, 0]},
      {"type": "CD", "bodies": ["ground", "rod"], "c": [0, 0, 1], "s_i": [0, 0, 0], "s_j": [-0.5, 0, 0]},
      {"type": "DP1", "bodies": ["ground", "rod"], "a_i": [0, 0, 1], "a_j": [1, 0, 0]},
      {"type": "DP1", "bodies": ["ground", "rod"], "a_i": [0, 0, 1], "a_j": [0, 1, 0]},
      {"type": "pfaffian", "bodies": ["ground", "rod"], "a_j": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [-0.5, 0, 0]}])j");
  const auto model = std::make_shared<const Model>(compile(scene));
  std::vector<BodyState> states(1);
  states[0].r = scene.bodies[0].position, states[0].A = scene.bodies[0].orientation;
  const RankAnalysis rank = analyze_rank(model, states, RankNames::none);
  ASSERT_EQ(rank.aside.size(), 1u);
  EXPECT_EQ(model->rows[static_cast<std::size_t>(rank.aside[0])].type, RowType::pfaffian);
}

}  // namespace
}  // namespace poinsot::test
