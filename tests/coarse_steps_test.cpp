// Steps of a fixed length that are too long for a vibration: how far its phase is off is told as it is, and the step
// offered keeps it small.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <regex>

#include "core/scene_reader.h"
#include "tests/support/remedies.h"
#include "tests/support/simulation.h"
#include "tests/support/sprung_wheel.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kOmega = 40;  // rad/s, of what vibrates

struct Vibration {
  Scene scene;
  double (*of)(const BodyState&);    // the coordinate less its mean, and its rate
  double (*rate)(const BodyState&);  //
};

Vibration on_a_spring() {
  Scene scene;
  Body block;
  block.name = "block", block.mass = 2, block.inertia = Matrix3::Identity();
  block.position = {1.1, 0, 0};
  scene.bodies.push_back(block);
  Spring spring;
  spring.i = kGround, spring.j = 0, spring.length = 1, spring.stiffness = 2 * kOmega * kOmega;
  scene.forces.push_back(spring);
  return {scene, [](const BodyState& at) { return at.r.x() - 1; }, [](const BodyState& at) { return at.rd.x(); }};
}

Vibration on_a_torsion_spring() {
  return {sprung_wheel(4, 3 * kOmega * kOmega), [](const BodyState& at) { return std::atan2(at.A(1, 0), at.A(0, 0)); },
          [](const BodyState& at) { return at.w.z(); }};
}

Settings fixed(std::string_view method, std::string_view formulation, double step, double end) {
  Settings s;
  s.integrator = method, s.formulation = formulation, s.step = step, s.end = end, s.tolerance = 1e-6;
  return s;
}

// rad, of the vibration at the end beside its own.
double phase_ahead(const Vibration& of, const std::vector<Snapshot>& motion) {
  const auto phase = [&](const Snapshot& at) {
    return std::atan2(-of.rate(at.bodies[0]) / kOmega, of.of(at.bodies[0]));
  };
  return std::remainder(phase(motion.back()) - phase(motion.front()) - kOmega * motion.back().t, 2 * std::numbers::pi);
}

struct Told {
  double ahead = 0;  // rad
  double step = 0;   // s, that is offered
};

std::optional<Told> told(const Outcome& outcome) {
  std::smatch found;
  const std::regex pattern(" about ([0-9.e+-]+) rad (ahead of|behind) .* a step below ([0-9.e+-]+) s");
  for (const std::string& notice : outcome.notices)
    if (std::regex_search(notice, found, pattern))
      return Told{std::stod(found[1]) * (found[2] == "behind" ? -1 : 1), std::stod(found[3])};
  return {};
}

// Of the methods whose steps are of one length and that keep amplitudes.
constexpr std::array kKeepAmplitudes{"rattle", "half_implicit", "generalized_alpha", "generalized_alpha_i2"};

TEST(CoarseSteps, are_told_with_the_phase_that_is_off) {
  for (const Vibration& of : {on_a_spring(), on_a_torsion_spring()})
    for (const char* method : kKeepAmplitudes)
      for (const char* formulation : {"rA", "rp", "reps"})
        for (const double h_omega : {0.3, 0.45, 0.6}) {
          SCOPED_TRACE(fmt::format("{} {} {}", method, formulation, h_omega));
          const double steps = std::ceil(1.2 * 12 / std::pow(h_omega, 3));  // 0.6 and 1.2 rad
          const Settings settings = fixed(method, formulation, h_omega / kOmega, steps * h_omega / kOmega);
          const Recorded coarse = run(of.scene, settings);
          ASSERT_TRUE(coarse.outcome.status.ok()) << coarse.outcome.status.message;
          const std::optional<Told> of_phase = told(coarse.outcome);
          ASSERT_TRUE(of_phase);
          const double ahead = phase_ahead(of, coarse.samples);
          const bool staggered = method == std::string_view("half_implicit");  // velocities half a step from positions
          EXPECT_NEAR(of_phase->ahead, ahead, 0.3 * std::abs(ahead) + (staggered ? h_omega / 2 : 0));
          const Settings offered = with_step(settings, of_phase->step);
          const Recorded finer = run(of.scene, offered);
          EXPECT_LT(std::abs(phase_ahead(of, finer.samples)), 0.13 + (staggered ? kOmega * offered.step / 2 : 0));
          EXPECT_FALSE(told(finer.outcome));
        }
}

// Steps that a swing is a whole number of, and of what looks are apart.
TEST(CoarseSteps, are_told_whatever_the_swing) {
  for (const int swing : {6, 9, 18, 34}) {
    SCOPED_TRACE(swing);
    const double h_omega = 2 * std::sin(std::numbers::pi / swing);  // a full one in so many steps
    const int steps = 10'000;
    const Recorded r = run(on_a_spring().scene, fixed("rattle", "rA", h_omega / kOmega, steps * h_omega / kOmega));
    ASSERT_TRUE(told(r.outcome));
    const double ahead = steps * (2 * std::numbers::pi / swing - h_omega);
    EXPECT_NEAR(told(r.outcome)->ahead, ahead, 0.3 * ahead);
  }
}

// With a spectral radius below 1 frequencies fall further.
TEST(CoarseSteps, of_a_method_that_damps_are_told_as_they_are) {
  for (const double radius : {0.0, 0.5, 1.0}) {
    SCOPED_TRACE(radius);
    const Vibration of = on_a_spring();
    Settings settings = fixed("generalized_alpha", "rA", 0.2 / kOmega, 2.0);
    settings.parameters["spectral_radius"] = radius;
    const Recorded coarse = run(of.scene, settings);
    ASSERT_TRUE(told(coarse.outcome));
    const double ahead = phase_ahead(of, coarse.samples);
    EXPECT_NEAR(told(coarse.outcome)->ahead, ahead, 0.3 * std::abs(ahead));
  }
}

// Where a function of time has a part in the motion it may keep the phase.
TEST(CoarseSteps, of_what_is_driven_are_told_with_a_doubt) {
  Scene scene = on_a_spring().scene;
  PointForce force;
  force.body = 0, force.force[0] = Expression::parse("sin(20*t)"), force.force[1] = force.force[2] = Expression(0.0);
  scene.forces.push_back(force);
  for (const char* method : kKeepAmplitudes) {
    SCOPED_TRACE(method);
    const Recorded r = run(scene, fixed(method, "rA", 0.5 / kOmega, 5));
    ASSERT_TRUE(told(r.outcome));
    EXPECT_THAT(r.outcome.notices, Contains(HasSubstr("where functions of time do not keep them")));
  }
}

// A slider that a free crank moves to and fro is the crank's, which loses less.
TEST(CoarseSteps, OfABodyThatTurnsOnAreToldAsABound) {
  const Scene engine = parse_scene(R"j({"scene": 1, "bodies": [
      {"name": "crank", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, 0], "angular_velocity": [0, 0, 150]},
      {"name": "slider", "mass": 0.5, "inertia": [1, 1, 1], "position": [0.1, 0, 0]}],
      "joints": [
      {"type": "revolute", "bodies": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"type": "translational", "bodies": ["ground", "slider"], "point": [0.1, 0, 0], "axis": [1, 0, 0]}],
      "constraints": [{"type": "CD", "bodies": ["crank", "slider"], "c": [1, 0, 0], "s_i": [0.1, 0, 0], "s_j": [0, 0, 0]}]
      })j",
                                   "engine");
  Settings settings = dynamics("rA", 1e-3, 5);
  settings.integrator = "generalized_alpha";
  const Outcome outcome = run(engine, settings).outcome;
  EXPECT_THAT(outcome.notices, Contains(AllOf(HasSubstr("they are up to 0."), HasSubstr("a body that turns on"))));
}

// A wheel that turns evenly: its angle in rp, by the turns that a torsion spring without stiffness counts.
TEST(CoarseSteps, of_even_turns_are_told_in_rp) {
  Scene scene = on_a_torsion_spring().scene;
  std::get<TorsionSpring>(scene.forces[0]).stiffness = 0;
  scene.bodies[0].angular_velocity = {0, 0, 100};
  for (const auto& [method, within] :
       {std::pair("rattle", 0.1), {"generalized_alpha", 0.7}, {"generalized_alpha_i2", 0.7}}) {
    SCOPED_TRACE(method);
    const Settings settings = fixed(method, "rp", 1e-3, 10);
    double turned = 0;
    const auto measure = [&](const Sample& at) { turned = at.problem.twist(0); };
    const Outcome outcome = simulate(scene, settings, measure);
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
    const std::optional<Told> of_turns = told(outcome);
    ASSERT_TRUE(of_turns) << fmt::format("{}", fmt::join(outcome.notices, "\n"));
    EXPECT_NEAR(of_turns->ahead, turned - 1000, within * std::abs(turned - 1000));
    simulate(scene, with_step(settings, of_turns->step), measure);
    EXPECT_NEAR(turned, 1000, 0.2);
    simulate(scene, fixed(method, "rA", 1e-3, 10), measure);
    EXPECT_NEAR(turned, 1000, 1e-6);
  }
}

// What goes evenly or is damped after the start has no phase to lose, however long the steps are for it.
TEST(CoarseSteps, are_not_told_of_what_does_not_vibrate) {
  const auto silent = [](const char* what, const Scene& scene, double h, double end) {
    for (const char* method : kKeepAmplitudes) {
      SCOPED_TRACE(fmt::format("{} {}", what, method));
      const Recorded r = run(scene, fixed(method, "rA", h, end));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_FALSE(told(r.outcome));
    }
  };
  Scene spinning = on_a_torsion_spring().scene;
  spinning.forces.clear();
  spinning.bodies[0].position = {0.3, 0, 0};
  spinning.bodies[0].angular_velocity = {0, 0, 0.3 * kOmega};
  spinning.bodies[0].velocity = {0, 0.3 * 0.3 * kOmega, 0};
  silent("even rotation", spinning, 1 / kOmega, 50);

  Scene flying = spinning;
  flying.joints.clear();
  flying.bodies[0].velocity = {3, 1, 2};
  silent("flight", flying, 1 / kOmega, 50);

  Scene driven = on_a_spring().scene;
  PointForce force;
  force.body = 0, force.force[0] = Expression::parse("sin(20*t)"), force.force[1] = force.force[2] = Expression(0.0);
  driven.forces.push_back(force);
  silent("driven", driven, 0.1 / kOmega, 10);

  Scene damped = on_a_spring().scene;
  std::get<Spring>(damped.forces[0]).damping = 2 * 2 * kOmega;
  silent("damped after the start", damped, 0.4 / kOmega, 20);
}

TEST(CoarseSteps, are_not_told_where_models_are_followed) {
  int followed = 0;
  for (const std::string& name : model_names()) {
    if (name == "andrews") continue;  // it goes round in 0.015 s
    for (const char* method : kKeepAmplitudes) {
      SCOPED_TRACE(name + " " + method);
      const Outcome outcome = run(scene_of(name), fixed(method, "rA", 1e-3, 1)).outcome;
      EXPECT_FALSE(told(outcome));
      if (outcome.status.ok()) ++followed;
    }
  }
  EXPECT_GT(followed, 100);  // some stop, as stiff springs do in methods that see forces at the start of a step
}

}  // namespace
}  // namespace poinsot::test
