// Kinks and jumps of drivers and forces: stepped onto by error control, told by fixed steps.
#include <gmock/gmock.h>

#include <random>

#include "core/scene_reader.h"
#include "tests/support/controlled_ways.h"
#include "tests/support/pushed.h"
#include "tests/support/simulation.h"
#include "tests/support/twice_driven.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(SwitchTimes, TellOfASignThatRoundingDecides) {
  for (const IntegratorEntry& entry : integrators()) {
    if (entry.analysis != Analysis::dynamics || refusal_of(entry, "rp")) continue;
    Settings settings = controlled(entry.name, "rp", 1e-6, 0.02);
    settings.step = 0.01;
    const auto notices = [&](const char* force) { return simulate(pushed(force), settings, {}).notices; };
    ASSERT_EQ(notices("1e-6*sign(sin(t)^2 + cos(t)^2 - 1)").size(), 1u) << entry.name;
    EXPECT_THAT(notices("1e-6*sign(sin(t)^2 + cos(t)^2 - 1)")[0], HasSubstr("zero up to rounding")) << entry.name;
    EXPECT_THAT(notices("abs(sin(t)^2 + cos(t)^2 - 1)"), IsEmpty()) << entry.name;
  }
}

class Switches : public ControlledWays {};
INSTANTIATE_TEST_SUITE_P(All, Switches, ::testing::ValuesIn(controlled_ways()), name_of_way);

// The velocity after an impulse is its integral, however short it is.
TEST_P(Switches, ImpulsesAreNotSteppedOver) {
  const std::pair<const char*, double> impulses[] = {
      {"1000*max(0, 1 - abs(t - 0.5)/0.001)", 1},
      {"1e6*max(0, 1 - abs(t - 0.5004)/1e-6)", 1},
      {"max(0, min(1, (t - 0.5)*1e9))*max(0, min(1, (0.502 - t)*1e9))*500", 1 - 5e-7},
      {"500*(step(t - 0.4) - step(t - 0.402))", 1},
      {"250*(1 - sign(abs(t - 0.5) - 0.001))", 1}};
  for (const auto& [impulse, integral] : impulses) {
    const Recorded r = run(pushed(impulse), settings(1e-8, 1, 0.25));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    ASSERT_EQ(r.samples.size(), 5u);
    EXPECT_EQ(r.samples[1].bodies[0].rd.x(), 0) << impulse;
    EXPECT_NEAR(r.samples[4].bodies[0].rd.x(), integral, 1e-7) << impulse;
    EXPECT_LT(r.outcome.statistics.steps, 3000) << impulse;
  }
}

// Zeros of the sine of pi t at whole numbers are zeros up to rounding: one comes a little before or after.
TEST_P(Switches, AtTheEndLeaveNothingOut) {
  for (const char* force : {"sign(sin(pi*t))", "step(cos(pi*t/2))", "abs(sin(pi*t))"}) {
    for (const double every : {0.0, 0.25}) {
      for (const double end : {1.0, 2.0, 3.0}) {
        const Recorded r = run(pushed(force), settings(1e-8, end, every));
        ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
        EXPECT_EQ(r.samples.back().t, end) << force << " every " << every;
      }
    }
  }
}

// Nor are smooth ones, alone, on a slope, beside a wave, to and fro, or cut out of one.
TEST_P(Switches, SmoothPulsesAreNotSteppedOver) {
  const double gauss = std::sqrt(M_PI);
  const std::pair<const char*, double> pulses[] = {
      {"1e4*exp(-((t - 0.5)/1e-4)^2)", gauss},
      {"1e6*exp(-((t - 0.77)/1e-6)^2)", gauss},
      {"3*t + 1e3*exp(-((t - 0.3)/1e-3)^2)", 1.5 + gauss},
      {"3*sin(5*t) + 1e3*exp(-((t - 0.3)/1e-3)^2)", 0.6 * (1 - std::cos(5)) + gauss},
      {"1e8*(t - 0.5)*exp(-((t - 0.5)/1e-4)^2) + 2", 2},
      {"500*(1 - cos(2*pi*(t - 0.4)/0.002))*step(t - 0.4)*step(0.402 - t)", 1},
      {"1e3*max(0, 1 - ((t - 0.6)/1e-3)^2)^4", 256.0 / 315},
      {"1e5/(1 + ((t - 0.7)/1e-5)^2)", std::atan(3e4) + std::atan(7e4)}};
  for (const auto& [pulse, integral] : pulses) {
    const Recorded r = run(pushed(pulse), settings(1e-8, 1, 1));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_NEAR(r.samples[1].bodies[0].rd.x(), integral, 1e-6) << pulse;
    EXPECT_LT(r.outcome.statistics.steps, 3000) << pulse;
    EXPECT_THAT(r.outcome.notices, IsEmpty()) << pulse;
  }
}

// Laws of springs may vary with time as forces do.
TEST_P(Switches, PulsesOfLawsAreNotSteppedOver) {
  const std::pair<const char*, double> laws[] = {{"1e3*exp(-((t - 0.5)/1e-3)^2)", std::sqrt(M_PI)},
                                                 {"500*(step(t - 0.4) - step(t - 0.402)) + 0*abs(x - v)", 1}};
  for (const auto& [law, integral] : laws) {
    Scene scene = pushed("0");
    Spring spring;
    spring.j = 0;
    spring.s_i = {5, 0, 0};
    spring.law = Expression::parse_law(law);
    scene.forces.push_back(spring);
    const Recorded r = run(scene, settings(1e-8, 1, 1));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_NEAR(r.samples[1].bodies[0].rd.x(), integral, 1e-6) << law;
  }
}

TEST(Pulses, AreTakenFromFixedStepsBySayingSo) {
  const auto told = ::testing::Contains(HasSubstr("varies within less than a step"));
  for (const IntegratorEntry& entry : integrators()) {
    if (entry.analysis != Analysis::dynamics || entry.controls_error) continue;
    Settings s;
    s.integrator = entry.name;
    s.end = s.every = 1;
    s.step = 0.01;
    for (const char* pulse : {"1e4*exp(-((t - 0.5034)/1e-4)^2)", "t + exp(-((t - 0.5034)/1e-3)^2)", "sin(400*t)"})
      EXPECT_THAT(simulate(pushed(pulse), s, {}).notices, told) << entry.name << ' ' << pulse;
    for (const char* smooth : {"10*exp(-((t - 0.5034)/0.1)^2)", "sin(20*t)", "exp(-5*t)*t^3", "1/(1 + t)", "7"})
      EXPECT_THAT(simulate(pushed(smooth), s, {}).notices, ::testing::Not(told)) << entry.name << ' ' << smooth;
  }
}

// Kinematics looks at redundant rows in its steps alone; where it is told, a shorter step sees that they do not hold.
TEST(Pulses, OfRedundantRowsAreToldByKinematics) {
  const auto told = ::testing::Contains(HasSubstr("varies within less than a step at t = 0.70"));
  Settings s;
  s.analysis = Analysis::kinematics;
  s.step = 0.01;
  const Scene scene = twice_driven("sin(t)", "sin(t) + 0.1*exp(-((t - 0.70031)/1e-5)^2)");
  const Outcome coarse = simulate(scene, s, {});
  EXPECT_TRUE(coarse.status.ok()) << coarse.status.message;
  EXPECT_THAT(coarse.notices, told);
  s.step = 1e-5;
  EXPECT_FALSE(simulate(scene, s, {}).status.ok());
  s.step = 0.01;
  EXPECT_THAT(simulate(twice_driven("sin(t)", "sin(1*t)"), s, {}).notices, ::testing::Not(told));
  Scene alone = scene;
  alone.drivers.erase(alone.drivers.begin());
  EXPECT_THAT(simulate(alone, s, {}).notices, ::testing::Not(told));
}

// Closed form: v = ∫ |sin| .
TEST_P(Switches, KinksCostNoDigits) {
  const Recorded r = run(pushed("abs(sin(2*pi*t))"), settings(1e-9, 2.75, 0.25));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  ASSERT_EQ(r.samples.size(), 12u);
  for (std::size_t n = 0; n < r.samples.size(); ++n) {
    const double t = 0.25 * static_cast<double>(n);
    EXPECT_NEAR(r.samples[n].t, t, 1e-15);
    const double halves = std::floor(2 * t), rest = t - halves / 2;
    const double v = (2 * halves + 1 - std::cos(2 * M_PI * rest)) / (2 * M_PI);
    EXPECT_NEAR(r.samples[n].bodies[0].rd.x(), v, 50e-9) << t;
  }
}

// A crank that sets out at 0.3 s, a rod that hangs on it: the same motion whatever the tolerance.
Scene driven(const char* angle) {
  Scene scene;
  scene.name = "driven";
  scene.gravity = {0, 0, -9.81};
  for (const double y : {0.5, 1.5}) {
    Body body;
    body.name = y < 1 ? "crank" : "rod";
    body.mass = 1;
    body.inertia = Vector3(0.1, 0.01, 0.1).asDiagonal();
    body.position = {0, y, 0};
    scene.bodies.push_back(body);
  }
  for (int k = 0; k < 2; ++k) {
    Joint hinge;
    hinge.type = JointType::revolute;
    hinge.i = k - 1;
    hinge.j = k;
    hinge.point = {0, static_cast<double>(k), 0};
    hinge.axis = {1, 0, 0};
    scene.joints.push_back(hinge);
  }
  Driver driver;
  driver.j = 0;
  driver.axis = {1, 0, 0};
  driver.value = Expression::parse(angle);
  scene.drivers.push_back(driver);
  return scene;
}

TEST_P(Switches, OfDriversCostNoDigits) {
  const Scene scene = driven("max(0, t - 0.3)^2 + 0.2*max(0, t - 0.5)^3");
  const auto exact = motion(scene, controlled("radau5", "rA", 1e-13, 1, 0.1));
  const auto found = motion(scene, settings(1e-8, 1, 0.1));
  const Distance d = distance(found, exact);
  EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), GetParam().integrator == "ida" ? 2e-6 : 1e-7) << d;
}

// A driver that goes and comes back between two steps.
TEST_P(Switches, PulsesOfDriversAreNotSteppedOver) {
  const char* angle = "0.2*t + 0.1*exp(-((t - 0.3)/1e-4)^2)";
  static const auto exact = motion(driven(angle), controlled("radau5", "rA", 1e-11, 0.5, 0.25));
  const Recorded r = run(driven(angle), settings(1e-8, 0.5, 0.25));
  if (!r.outcome.status.ok()) {
    EXPECT_EQ(GetParam().integrator, "ida") << r.outcome.status.message;
    return;
  }
  const Distance d = distance(r.samples, exact);
  EXPECT_LT(std::max(d.r, d.w), 1e-4) << d;
  EXPECT_GT(r.outcome.statistics.steps, 20);
}

// Where the rate jumps, bodies are struck: the rod's momentum about its hinge with the crank stays.
TEST_P(Switches, RatesThatJumpStrikeTheBodies) {
  Scene scene = driven("0.5*max(0, t - 0.3)");
  scene.gravity.setZero();
  // The hinge at 1 m sets out with 0.5 m/s along z; about it the rod takes I w = −m l v with I = 0.1 + 0.25, l = 0.5.
  const auto found = motion(scene, settings(1e-8, 0.6, 0.1));
  ASSERT_EQ(found.size(), 7u);
  EXPECT_EQ(found[2].bodies[1].w.x(), 0);
  EXPECT_EQ(found[3].t, 0.3);
  EXPECT_NEAR(found[3].bodies[1].w.x(), -0.5 * 0.5 / 0.35, 1e-6);
}

TEST_P(Switches, RatesThatTurnRoundAreFollowed) {
  for (const char* angle : {"t^2*abs(1 - 2.003*t)", "t^2*abs(1 - 2.1*t)", "t^2*abs(1 - 3*t)", "t^2*min(0.3, 1 - 1.7*t)",
                            "t^2*acos(cos(9.1*t))", "t^2*asin(sin(9.1*t))", "t^2*sqrt(1 - cos(9.1*t))"}) {
    const auto found = motion(driven(angle), settings(1e-8, 0.8, 0.8));
    const double w = Expression::parse(angle).at(0.8).fd;
    EXPECT_NEAR(found.back().bodies[0].w.x(), w, 1e-6) << angle;
  }
}

TEST_P(Switches, AreTakenFromFixedStepsBySayingSo) {
  const Scene scene = pushed("abs(t - 0.305)");
  for (const IntegratorEntry& entry : integrators()) {
    if (entry.analysis != Analysis::dynamics || refusal_of(entry, GetParam().formulation)) continue;
    Settings s = settings(1e-6, 1, 1);
    s.integrator = entry.name;
    s.step = 0.01;
    const Outcome outcome = simulate(scene, s, {});
    if (entry.controls_error) {
      EXPECT_THAT(outcome.notices, IsEmpty()) << entry.name;
    } else {
      ASSERT_EQ(outcome.notices.size(), 1u) << entry.name;
      EXPECT_THAT(outcome.notices[0], HasSubstr("t = 0.305 s"));
    }
    s.end = s.every = 0.3;
    EXPECT_THAT(simulate(scene, s, {}).notices, IsEmpty()) << entry.name;
  }
}

// A body of 2 kg at the origin with what a table has to do with it.
Scene by_a_table(const char* rest) {
  return parse_scene(fmt::format(R"json({{"scene": 1, "name": "by a table",
      "bodies": [{{"name": "b", "mass": 2, "inertia": [1, 1, 1], "position": [0, 0, 0]}}],
      "tables": {{"pulse": {{"points": [[0, 0], [4.999, 0], [5, 1000], [5.001, 0], [10, 0]]}},
                 "way": {{"points": [[0, 0], [0.3, 0.5], [0.31, 0.49], [0.6, 0.1], [1, 1]]}}}},
      {}}})json",
                                 rest),
                     "table.json");
}

// A pulse between points that are near to one another. Between them the spline is a cubic, of which Simpson's rule has
// the integral exactly.
TEST_P(Switches, PulsesOfTablesAreNotSteppedOver) {
  const Scene scene = by_a_table(
      R"json("forces": [{"type": "force", "body": "b", "point": [0, 0, 0], "force": ["pulse(t)", "0", "0"]}])json");
  const Expression& force = std::get<PointForce>(scene.forces[0]).force[0];
  const std::vector<double> points{0, 4.999, 5, 5.001, 10};
  double v = 0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double a = points[k - 1], b = points[k];
    v += (b - a) / 6 * (force.at(a).f + 4 * force.at((a + b) / 2).f + force.at(b).f) / 2;
  }
  const Recorded r = run(scene, settings(1e-8, 10, 10));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_NEAR(r.samples.back().bodies[0].rd.x(), v, 1e-6 * std::abs(v));
  EXPECT_THAT(fmt::format("{}", fmt::join(r.outcome.notices, "\n")), ::testing::Not(HasSubstr("singular")));
}

// Tables have no kinks: steps of fixed length lose nothing at their points.
TEST_P(Switches, TablesLeadAsTheyAre) {
  const Scene scene = by_a_table(
      R"json("constraints": [{"type": "CD", "bodies": ["ground", "b"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "c": [1, 0, 0], "f": "way(t)"}])json");
  const Expression& way = scene.constraints[0].f;
  for (const bool controlled : {true, false}) {
    Settings s = settings(1e-8, 1, 0.1);
    if (!controlled) s.integrator = "rattle", s.step = 1e-3, s.tolerance = 1e-8;
    const Recorded r = run(scene, s);
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    ASSERT_EQ(r.samples.size(), 11u);
    for (const Snapshot& sample : r.samples) {
      EXPECT_NEAR(sample.bodies[0].r.x(), way.at(sample.t).f, 1e-6);
      EXPECT_NEAR(sample.bodies[0].rd.x(), way.at(sample.t).fd, 1e-5);
    }
    EXPECT_THAT(fmt::format("{}", fmt::join(r.outcome.notices, "\n")), ::testing::Not(HasSubstr("kink")));
  }
}

// A driver that turns by 2 rad within milliseconds, between two stages of a step: accelerations show nothing of it, the
// projection does.
TEST_P(Switches, WhatTheProjectionMovesIsAnError) {
  const char* angle = "1 + tanh((t - 0.5)/0.0005)";
  static const auto exact = motion(driven(angle), controlled("radau5", "rA", 1e-11, 0.52, 0.13));
  const auto found = motion(driven(angle), settings(1e-8, 0.52, 0.13));
  const Distance d = distance(found, exact);
  EXPECT_LT(d.w, 1e-5) << d;  // of some 1000 rad/s
}

// Thirty-two pulses between two kinks each, without a force at either.
TEST_P(Switches, PulsesBetweenKinksAreFelt) {
  Scene scene;
  Body body;
  body.name = "body", body.mass = 1, body.inertia = Matrix3::Identity();
  scene.bodies.push_back(body);
  PointForce push;
  push.body = 0;
  push.force[0] = Expression::parse("1e3*max(0, sin(200*t) - 0.999)");
  scene.forces.push_back(push);
  const double half = std::acos(0.999), each = 1e3 * 2 * (std::sin(half) - 0.999 * half) / 200;
  const Recorded r = run(scene, settings(1e-8, 1, 1));
  ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  EXPECT_NEAR(r.samples.back().bodies[0].rd.x(), 32 * each, 1e-7);
}

// Where the run begins, as a saved one does that ends where a driver sets out: what holds beyond is begun with.
TEST_P(Switches, AtTheStartAreCrossed) {
  for (const char* angle : {"max(0, sin(3*t))", "max(0, exp(t) - 1)", "max(0, (t + 0.31) - 0.31)",
                            "max(sin(3*t), sin(6*t))", "max(0, sqrt(1 + t) - 1)"}) {
    const auto found = motion(driven(angle), settings(1e-8, 0.25, 0.25));
    const Expression f = Expression::parse(angle);
    EXPECT_NEAR(found.back().bodies[0].w.x(), f.at(0.25).fd, 1e-6) << angle;
  }
}

// Kinks of two drivers that are as near as rounding puts them.
TEST_P(Switches, NextToOneAnotherAreCrossedTogether) {
  for (const double apart : {1e-15, 1e-13, 1e-11, 1e-9}) {
    Scene scene = driven(fmt::format("0.3*max(0, t - 0.3) + 0.2*max(0, t - {:.17g})", 0.3 + apart).c_str());
    const auto found = motion(scene, settings(1e-8, 0.6, 0.3));
    EXPECT_NEAR(found.back().bodies[0].w.x(), 0.5, 1e-9) << apart;
  }
}

}  // namespace
}  // namespace poinsot::test
