// Constraints that all but depend on one another, as of hinges whose axes are written to a few digits: what satisfies
// them is not what was meant, and a run says so. And rows whose gradient vanishes where the run begins, though others
// say the same.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/input_error.h"
#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// A door on two hinges whose axes are `tilt` apart, turning at 2 rad/s about the first.
Scene door(double tilt, double rate = 2) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, -9.81],
      "bodies": [{{"name": "door", "mass": 20, "inertia": [3, 5, 2], "position": [0.4, 0, 1],
                   "velocity": [0, {1:.17g}, 0], "angular_velocity": [0, 0, {2:.17g}]}}],
      "joints": [{{"type": "revolute", "bodies": ["ground", "door"], "point": [0, 0, 0], "axis": [0, 0, 1]}},
                 {{"type": "revolute", "bodies": ["ground", "door"], "point": [0, 0, 2], "axis": [{0:.17g}, 0, 1]}}]}})j",
                                 tilt, 0.4 * rate, rate),
                     "door");
}

std::string refused(const Scene& scene) {
  try {
    (void)simulate(scene, dynamics("rA", 1e-3, 1e-2), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParallelButForDigits, VelocitiesThatThoseWouldTakeAwayAreRefused) {
  for (const double tilt : {1e-8, 1e-7})
    EXPECT_THAT(refused(door(tilt)),
                AllOf(HasSubstr("the initial velocities violate joint 'revolute2'"), HasSubstr("to more digits")))
        << tilt;
  for (const double tilt : {0.0, 1e-11}) EXPECT_EQ(refused(door(tilt)), "") << tilt;
}

TEST(ParallelButForDigits, APoseThatThoseWouldTurnIsRefused) {
  const Scene scene = parse_scene(R"j({"scene": 1, "gravity": [0, 0, -9.81],
      "bodies": [{"name": "door", "mass": 20, "inertia": [3, 5, 2], "position": [0.4, 0, 1]}],
      "joints": [{"type": "revolute", "bodies": ["ground", "door"], "point": [0, 0, 0], "axis": [0, 0, 1]},
                 {"type": "revolute", "bodies": ["ground", "door"], "s_i": [0, 0, 2], "s_j": [-0.4, 0, 1],
                  "axis_i": [1e-7, 0, 1], "axis_j": [1e-7, 1e-9, 1]}]})j",
                                  "door");
  EXPECT_THAT(refused(scene),
              AllOf(HasSubstr("the initial pose violates joint 'revolute2'"), HasSubstr("to more digits")));
}

TEST(ParallelButForDigits, AtRestItIsSaid) {
  const Outcome run = simulate(door(1e-8, 0), dynamics("rA", 1e-3, 1e-2), {});
  EXPECT_TRUE(run.status.ok());
  EXPECT_THAT(run.notices, Contains(HasSubstr("is that near to moving")));
}

// Turned by a driver, with a constraint that says the same in another way, whose gradient vanishes at times.
Scene rotor(const std::string& constraint) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, -9.81],
      "bodies": [{{"name": "rotor", "mass": 2, "inertia": [0.1, 0.2, 0.3], "position": [0.3, 0, 0]}}],
      "joints": [{{"type": "revolute", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]}}],
      "drivers": [{{"type": "angle", "bodies": ["ground", "rotor"], "axis": [0, 0, 1], "angle": "2*pi*t"}}],
      "constraints": [{}]}})j",
                                 constraint),
                     "rotor");
}
constexpr const char* kCosine = R"j({"type": "DP1", "bodies": ["ground", "rotor"], "a_i": [1, 0, 0], "a_j": [1, 0, 0],
    "f": "cos(2*pi*t)"})j";
constexpr const char* kDistance = R"j({"type": "D", "bodies": ["ground", "rotor"], "s_i": [0.3, 0, 0], "s_j": [0, 0, 0],
    "f": "0.36*sin(pi*t)^2"})j";

class Vanishing : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rows, Vanishing, ::testing::Values(kCosine, kDistance),
                         [](const auto& of) { return std::string(of.param == kCosine ? "cosine" : "distance"); });

TEST_P(Vanishing, ThatOthersStandInForAreSetAside) {
  const Scene scene = rotor(GetParam());
  for (const FormulationEntry& formulation : formulations()) {
    std::vector<Settings> all = {kinematics(formulation.name, 1e-2, 2.1)};
    for (const char* integrator : {"rattle", "implicit_euler", "half_implicit", "generalized_alpha", "dop853"}) {
      all.push_back(dynamics(formulation.name, 1e-3, 2.1));
      all.back().integrator = integrator;
    }
    for (const Settings& settings : all) {
      SCOPED_TRACE(fmt::format("{} {}", formulation.name, settings.integrator));
      std::vector<BodyState> states(1);
      const Outcome run = simulate(scene, settings, [&](const Sample& x) { x.problem.to_bodies(x.a, states); });
      ASSERT_TRUE(run.status.ok()) << run.status.message;
      EXPECT_NEAR(states[0].r.x(), 0.3 * std::cos(4.2 * pi), 1e-6);
      EXPECT_THAT(run.notices, Not(Contains(AnyOf(HasSubstr("has vanished"), HasSubstr("near to a singular")))));
    }
  }
}

// Two cosines, of which one at least says where the rotor is.
TEST(Vanishing, RowsGiveWayToThoseThatDoNot) {
  const std::string sine = R"j({"type": "DP1", "bodies": ["ground", "rotor"], "a_i": [0, 1, 0], "a_j": [1, 0, 0],
      "f": "sin(2*pi*t)"})j";
  Scene scene = rotor(std::string(kCosine) + ", " + sine);
  scene.drivers.clear();
  for (const FormulationEntry& formulation : formulations()) {
    const Outcome run = simulate(scene, kinematics(formulation.name, 1e-2, 2.1), {});
    EXPECT_TRUE(run.status.ok()) << formulation.name << ": " << run.status.message;
  }
}

}  // namespace
}  // namespace poinsot::test
