// Kinks and jumps of laws of springs by the state: runs under error control are as right as those of smooth laws.
#include "integrators/stepping/law_switches.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/scene_reader.h"
#include "tests/support/controlled_ways.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;

// ida has its own error control, and finds kinks by that.
std::vector<ControlledWay> ways_but_ida() {
  std::vector<ControlledWay> all = controlled_ways();
  std::erase_if(all, [](const ControlledWay& way) { return way.integrator == "ida"; });
  return all;
}

class LawSwitchesTest : public ControlledWays {};
INSTANTIATE_TEST_SUITE_P(All, LawSwitchesTest, ::testing::ValuesIn(ways_but_ida()), name_of_way);

// A body of 1 kg at x, pulled back by the force of a law; its spring is 3 m long where x is 0.
Scene pulled(double x, std::initializer_list<const char*> laws) {
  Scene scene;
  scene.name = "pulled";
  Body body;
  body.name = "body", body.mass = 1, body.inertia = Vector3(1, 1, 1).asDiagonal();
  body.position = {x, 0, 0};
  scene.bodies.push_back(body);
  for (const char* law : laws) {
    Spring spring;
    spring.j = 0, spring.length = 3, spring.s_i = {-3, 0, 0};
    spring.law = Expression::parse_law(law);
    scene.forces.push_back(spring);
  }
  return scene;
}

// x(t) from x0 at rest.
double of_two_springs(double t) {  // 25 x, and 100 x below 0; from 0.5
  const double part = std::fmod(t, 0.3 * pi);
  return part < 0.1 * pi   ? 0.5 * std::cos(5 * part)
         : part < 0.2 * pi ? -0.25 * std::sin(10 * (part - 0.1 * pi))
                           : 0.5 * std::sin(5 * (part - 0.2 * pi));
}
double of_friction(double t) {  // 25 x + 0.5 sign(v), from 1: half waves about ±0.02
  const double waves = std::floor(t / (pi / 5)), side = std::fmod(waves, 2) == 0 ? 1 : -1;
  return -side * -0.02 + (1 - 0.02 - 0.04 * waves) * side * std::cos(5 * (t - waves * pi / 5));
}
double of_relay(double t) {  // sign(x), from 0.5
  const double part = std::fmod(t + 1, 4), in = std::fmod(part, 2);
  return (part < 2 ? 1 : -1) * (0.5 - 0.5 * (in - 1) * (in - 1));
}
double of_floor(double t) {  // 1 and 1e4 x below 0, from 0.02
  const double a = std::hypot(1e-4, 2e-3), phase = std::atan2(2e-3, 1e-4), touch = (2 * pi - 2 * phase) / 100;
  const double part = std::fmod(t + 0.2, 0.4 + touch);
  if (part < 0.4) return 0.02 - 0.5 * (part - 0.2) * (part - 0.2);
  return -1e-4 + a * std::cos(100 * (part - 0.4) + phase);
}

TEST_P(LawSwitchesTest, CostNoDigitsAndFewRejections) {
  const struct {
    double x0;
    const char* law;
    double (*x)(double);
    double crossings;  // in 5 s
  } cases[] = {{0.5, "25*max(0, x) + 100*min(0, x)", of_two_springs, 10.6},
               {1, "25*x + 0.5*sign(v)", of_friction, 8},
               {0.5, "sign(x)", of_relay, 2.5},
               {0.02, "1e4*min(0, x) + 1", of_floor, 23}};
  for (const auto& c : cases) {
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      const Recorded r = run(pulled(c.x0, {c.law}), settings(rtol, 5, 0.003));
      ASSERT_TRUE(r.outcome.status.ok()) << c.law << ": " << r.outcome.status.message;
      double most = 0;
      for (const Snapshot& s : r.samples) most = std::max(most, std::abs(s.bodies[0].r.x() - c.x(s.t)));
      EXPECT_LT(most, 30 * rtol) << c.law << ' ' << rtol;
      EXPECT_LT(r.outcome.statistics.rejected_steps, 5 * c.crossings + 12) << c.law << ' ' << rtol;
    }
  }
}

// A fall onto a stiff stop, at coarse tolerances: a long step whose middle stages are thrown back from the stop sees
// nothing of it in those that its end and its error are made of.
TEST_P(LawSwitchesTest, AStopIsNotSteppedThrough) {
  const Scene fall = parse_scene(R"json({"scene": 1, "name": "fall", "gravity": [0, 0, -9.81], "parameters": {"k": 1},
    "bodies": [{"name": "m", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 1]}],
    "joints": [{"type": "translational", "bodies": ["ground", "m"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "forces": [{"type": "spring", "bodies": ["ground", "m"], "s_i": [0, 0, -1], "s_j": [0, 0, 0], "length": 1.5,
                "law": "k*min(x, 0)"}]})json",
                                 "fall.json");
  for (const double k : {1e5, 1e6, 1e7}) {
    for (const double rtol : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      const Recorded r = run(with_parameters(fall, {{"k", k}}), settings(rtol, 1, 0.01));
      ASSERT_TRUE(r.outcome.status.ok()) << k << ": " << r.outcome.status.message;
      for (const Snapshot& s : r.samples) {
        EXPECT_LT(s.bodies[0].r.z(), 1 + std::max(0.02, 5 * rtol)) << k << ' ' << rtol << " at " << s.t;
        EXPECT_GT(s.bodies[0].r.z(), 0.48) << k << ' ' << rtol << " at " << s.t;
      }
    }
  }
}

// A body of 1 kg at x on a spring that begins where x is 0.
Scene on_spring(double x, double v, double length, double stiffness, const char* law) {
  Scene scene = pulled(x, {});
  scene.bodies[0].velocity = {v, 0, 0};
  Spring spring;
  spring.j = 0, spring.length = length, spring.stiffness = stiffness;
  if (law) spring.law = Expression::parse_law(law);
  scene.forces.push_back(spring);
  return scene;
}
double of_string(double t) {  // 1 towards 0 with v = 1 from 0
  const double part = std::fmod(t, 4), in = std::fmod(part, 2);
  return (part < 2 ? 1 : -1) * 0.5 * in * (2 - in);
}
double of_pushing_spring(double t) {  // 25 (|x| − 0.3) from 1 at rest
  const double quarter = std::acos(-0.3 / 0.7) / 5, half = std::fmod(t, 2 * quarter);
  const auto out = [](double s) { return 0.3 + 0.7 * std::cos(5 * s); };
  const double side = std::fmod(std::floor(t / (2 * quarter)), 2) == 0 ? 1 : -1;
  return side * (half < quarter ? out(half) : -out(2 * quarter - half));
}

// The force of a spring turns round where it has no length.
TEST_P(LawSwitchesTest, OfSpringsThroughNoLength) {
  const struct {
    const char* name;
    Scene scene;
    double (*x)(double);
    double passages;  // in 5 s
  } cases[] = {{"linear", on_spring(1, 0, 0.3, 25, nullptr), of_pushing_spring, 6.3},
               {"law", on_spring(1, 0, 0.3, 0, "25*x + 0*t"), of_pushing_spring, 6.3},
               {"constant, from there", on_spring(0, 1, 0, 0, "1"), of_string, 3.5}};
  for (const auto& c : cases) {
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      const Recorded r = run(c.scene, settings(rtol, 5, 0.003));
      ASSERT_TRUE(r.outcome.status.ok()) << c.name << ": " << r.outcome.status.message;
      double most = 0;
      for (const Snapshot& s : r.samples) most = std::max(most, std::abs(s.bodies[0].r.x() - c.x(s.t)));
      EXPECT_LT(most, 50 * rtol) << c.name << ' ' << rtol;
      EXPECT_LT(r.outcome.statistics.rejected_steps, 5 * c.passages + 12) << c.name << ' ' << rtol;
    }
  }
}

// One that passes beside that place turns round in a time that error control has to see: here 4e-7 s.
TEST_P(LawSwitchesTest, OfSpringsBesideNoLengthAreSeen) {
  Scene scene = on_spring(0.5, 1, 0, 0, "5");
  scene.bodies[0].velocity.y() = 1e-6;
  static const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, 1, 1));
  EXPECT_LT(distance(motion(scene, settings(1e-10, 1, 1)), exact).r, 1e-7);
}

// What is left there of a law of 290 N that is written to six digits does not turn round.
TEST(SpringLawAtNoLength, IsNotWhatDigitsAreRoundedTo) {
  const auto left = [](double length, const char* law) {
    const Model model = compile(on_spring(0.5, 1, length, 0, law));
    const std::vector<SpringLaw> laws = spring_laws(model);
    return laws.front().at_no_length(0);
  };
  EXPECT_EQ(left(0.24241051476403105, "25.08*(x + 0.242411)/((x + 0.242411)^2 + 0.0426^2)"), 0);
  EXPECT_NEAR(left(0.24, "25.08*(x + 0.25)/((x + 0.25)^2 + 0.0426^2)"), 131, 1);
  EXPECT_NEAR(left(0.3, "25*x + 0*t"), -7.5, 1e-14);
  EXPECT_EQ(left(0, "5 + 0*x"), 5);
}

// Nor is one taken to turn round alone whose force has a peak there, of 1e-5 m.
TEST_P(LawSwitchesTest, OfPeaksAtNoLengthAreSeen) {
  const Scene scene = on_spring(0.5, 1, 0, 0, "5 + 5000/(1 + (1e5*x)^2)");
  static const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, 1, 1));
  EXPECT_LT(distance(motion(scene, settings(1e-8, 1, 1)), exact).r, 1e-6);
}

TEST_P(LawSwitchesTest, OfAJumpAtTheStartAreNotSearchedFor) {
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const Recorded r = run(pulled(1, {"25*x + 0.5*sign(v)"}), settings(rtol, 0.5, 0.5));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_LT(r.outcome.statistics.rejected_steps, 4) << rtol;
  }
}

// A relay with a damper goes to and fro ever faster.
TEST_P(LawSwitchesTest, ComeEverFaster) {
  const Scene scene = pulled(0.5, {"sign(x) + 2*v"});
  static const auto exact = motion(scene, controlled("dop853", "rA", 1e-12, 10, 10));
  const auto found = motion(scene, settings(1e-8, 10, 10));
  EXPECT_NEAR(found.back().bodies[0].rd.x(), exact.back().bodies[0].rd.x(), 5e-6);
}

// Springs that switch at the same instant are one spring of as much force.
TEST_P(LawSwitchesTest, MayCoincide) {
  const auto one = run(pulled(0.02, {"2e4*min(0, x) + 2"}), settings(1e-9, 1, 0.05)).samples;
  const auto two = run(pulled(0.02, {"1e4*min(0, x) + 1", "1e4*min(0, x) + 1"}), settings(1e-9, 1, 0.05)).samples;
  ASSERT_EQ(one.size(), two.size());
  EXPECT_LT(distance(one, two).r, 1e-8);
}

// Three links with a stop and friction in each hinge, which switch one hundred times.
TEST_P(LawSwitchesTest, OfMechanisms) {
  Scene scene;
  scene.name = "stops";
  scene.gravity = {0, 0, -9.81};
  for (int k = 0; k < 3; ++k) {
    Body body;
    body.name = fmt::format("link{}", k);
    body.mass = 1, body.inertia = Vector3(0.02, 0.001, 0.02).asDiagonal();
    body.position = {0, 0.25 + 0.5 * k, 0};
    scene.bodies.push_back(body);
    Joint hinge;
    hinge.type = JointType::revolute;
    hinge.i = k - 1, hinge.j = k;
    hinge.point = {0, 0.5 * k, 0}, hinge.axis = {1, 0, 0};
    scene.joints.push_back(hinge);
    TorsionSpring stop;
    stop.i = k - 1, stop.j = k, stop.axis = {1, 0, 0};
    stop.law = Expression::parse_law("200*(max(0, x - 0.5) + min(0, x + 0.5)) + 0.05*min(max(v/0.1, -1), 1)");
    scene.forces.push_back(stop);
  }
  static const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, 1, 0.1));
  const Distance d = distance(motion(scene, settings(1e-9, 1, 0.1)), exact);
  EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), 3e-7) << d;
}

}  // namespace
}  // namespace poinsot::test
