// What a run has lost or invented of the energy of mechanisms that should keep it is told at its end as it is,
// whichever the method; of others nothing is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "core/conserved_energy.h"
#include "core/mechanisms.h"
#include "core/scene_reader.h"
#include "tests/support/energy_course.h"
#include "tests/support/every_way.h"
#include "tests/support/loops.h"

namespace poinsot::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kTold = 6;  // percent

struct EnergyFound {
  bool ok = false;
  double percent = 0;       // lost of the largest kinetic energy
  bool told = false;        // of the energy
  double told_percent = 0;  // as the notice has it
  std::string said, remedy;
};

EnergyFound kept(const Scene& scene, const Settings& settings) {
  const EnergyCourse energy = energy_course(scene, settings);
  EnergyFound result{energy.outcome.status.ok(), energy.percent_lost(), false, 0, {}, {}};
  const std::regex pattern(
      " ([0-9.e+-]+) J (lower|higher) at t = .*, by ([0-9.e+]+) % of .*should stay as it is; (.*)");
  for (const std::string& notice : energy.outcome.notices) {
    std::smatch found;
    if (!std::regex_search(notice, found, pattern)) continue;
    result.told = true, result.said = notice, result.remedy = found[4];
    result.told_percent = (found[2] == "lower" ? 1 : -1) * std::stod(found[3]);
  }
  return result;
}

void expect_as_it_is(const EnergyFound& of) {
  constexpr double kBand = 0.3;  // percent: the largest kinetic energy is looked for at every fourth step
  EXPECT_EQ(of.told, std::abs(of.percent) > kTold) << of.percent << ' ' << of.said;
  if (of.told) {
    EXPECT_NEAR(of.told_percent, of.percent, 1e-2 * std::abs(of.percent) + kBand) << of.said;
  }
}

Scene free_body() {
  Scene scene;
  Body body;
  body.name = "body", body.mass = 1, body.inertia = Vector3(1, 2, 3).asDiagonal();
  body.angular_velocity = {2.7, 8.1, 2.7};
  scene.bodies.push_back(body);
  return scene;
}

Scene spun_top() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body top;
  top.name = "top", top.mass = 1, top.inertia = Vector3(0.05, 0.05, 0.08).asDiagonal();
  top.orientation = Eigen::AngleAxisd(0.4, Vector3::UnitX()).toRotationMatrix();
  top.position = top.orientation * Vector3(0, 0, 0.4);
  top.angular_velocity = {0, 0, 20};
  scene.bodies.push_back(top);
  Joint tip;
  tip.type = JointType::spherical, tip.i = kGround, tip.j = 0;
  scene.joints.push_back(tip);
  return scene;
}

// To and fro on a spring of the law given, from x = 0.
Scene on_law(const char* law) {
  Scene scene;
  Body ball;
  ball.name = "ball", ball.mass = 1, ball.inertia = 1e-2 * Matrix3::Identity();
  ball.position = {1.5, 0, 0}, ball.velocity = {2, 0, 0};
  scene.bodies.push_back(ball);
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0, spring.length = 1;
  spring.law = Expression::parse_law(law);
  scene.forces.push_back(spring);
  return scene;
}

// One turn shows nothing in most of these, ten seconds do.
TEST(EnergyBalance, what_adds_up_is_told_as_it_is) {
  int told = 0, silent = 0;
  for (const Scene& scene : {free_body(), spun_top(), scene_of("gimbal_pendulum"), on_law("40*x + 30*x^3")})
    in_every_way(2e-3, 6, [&](Settings settings) {
      settings.rtol = 1e-5;
      const EnergyFound of = kept(scene, settings);
      if (!of.ok) return;
      expect_as_it_is(of);
      ++(of.told ? told : silent);
    });
  EXPECT_GE(told, 12);
  EXPECT_GT(silent, 50);
}

TEST(EnergyBalance, what_is_invented_is_told_too) {
  Settings settings = dynamics("rA", 1e-3, 20);
  settings.integrator = "half_implicit";
  const EnergyFound of = kept(free_body(), settings);
  EXPECT_LT(of.percent, -10);
  expect_as_it_is(of);
  EXPECT_THAT(of.said, HasSubstr("J higher at t = 20 s than at the start"));
}

// However little a drag takes, it does not give.
TEST(EnergyBalance, what_is_invented_beside_a_drag_is_told) {
  Settings settings = dynamics("rA", 1e-3, 20);
  settings.integrator = "half_implicit";
  Scene scene = free_body();
  LinearDrag drag;
  drag.body = 0, drag.rotational = 1e-9;
  scene.forces.push_back(drag);
  const Outcome run = simulate(scene, settings, [](const Sample&) {});
  EXPECT_THAT(run.notices, Contains(AllOf(HasSubstr("J higher at t = 20 s than at the start"),
                                          HasSubstr("dampers take of it and nothing gives; a step below "))));
  EXPECT_FALSE(run.statistics.energy_change);
  std::get<LinearDrag>(scene.forces[0]).rotational = 0.01;  // enough to make up for it
  EXPECT_THAT(simulate(scene, settings, [](const Sample&) {}).notices, Not(Contains(HasSubstr("dampers take"))));
}

TEST(EnergyBalance, the_step_that_is_offered_keeps_it) {
  const std::regex pattern("a step below ([0-9.e-]+) s, or error control, keeps it to 6 %");
  int offered = 0;
  for (const Scene& scene : {free_body(), spun_top(), scene_of("steel_pendulum"), on_law("40*x + 30*x^3")})
    in_every_way(4e-3, 2, [&](Settings settings) {
      if (integrators().require(settings.integrator).controls_error) return;
      const EnergyFound coarse = kept(scene, settings);
      std::smatch found;
      if (!coarse.ok || !std::regex_search(coarse.remedy, found, pattern)) return;
      settings.step = 0.99 * std::stod(found[1]);
      EXPECT_LT(std::abs(kept(scene, settings).percent), kTold) << coarse.said;
      ++offered;
    });
  EXPECT_GE(offered, 8);
}

// Error control holds the error of a step, not what adds up.
TEST(EnergyBalance, error_control_is_told_of_as_well) {
  int told = 0;
  for (const char* integrator : {"dopri5", "dop853", "radau5"}) {
    Settings settings = dynamics("rA", 1e-3, 60);
    settings.integrator = integrator, settings.rtol = 1e-2;
    const EnergyFound of = kept(scene_of("simple_pendulum"), settings);
    EXPECT_TRUE(of.ok);
    expect_as_it_is(of);
    if (!of.told) continue;
    ++told;
    EXPECT_EQ(of.remedy, "rtol 1e-04 or less keeps more of it");
    settings.rtol = 1e-4;
    EXPECT_LT(std::abs(kept(scene_of("simple_pendulum"), settings).percent), std::abs(of.percent));
  }
  EXPECT_GE(told, 1);
}

// Of a quarter turn of the swing in two steps every fourth is at rest.
TEST(EnergyBalance, is_seen_whatever_the_swing) {
  const Scene scene = parse_scene(R"j({"scene": 1, "bodies": [
      {"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
      "joints": [{"type": "translational", "bodies": ["ground", "b"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
      "forces": [{"type": "spring", "bodies": ["ground", "b"], "s_i": [-1, 0, 0], "s_j": [0, 0, 0], "length": 0.9,
                  "stiffness": 1e6}]})j",
                                  "swing");
  for (const double end : {0.05, 0.1, 0.2}) {
    Settings settings = dynamics("rA", 1e-3, end);
    settings.integrator = "implicit_euler";
    EXPECT_TRUE(kept(scene, settings).told) << end;
  }
}

TEST(EnergyBalance, is_that_of_each_mechanism) {
  Scene both = spun_top();
  Body large = free_body().bodies[0];
  large.name = "large", large.inertia *= 1e4, large.angular_velocity = {0, 0, 1}, large.position = {9, 0, 0};
  both.gravity.setZero(), both.bodies[0].angular_velocity = {3, 0, 20};
  both.bodies.push_back(large);
  Scene alone = both;
  alone.bodies.pop_back();
  Settings settings = dynamics("rp", 1e-3, 3);
  settings.integrator = "half_implicit";
  const EnergyFound of_alone = kept(alone, settings), of_both = kept(both, settings);
  ASSERT_TRUE(of_alone.told && of_both.told) << of_alone.percent;
  expect_as_it_is(of_alone);
  EXPECT_NEAR(of_both.told_percent, of_alone.told_percent, 0.1);
  EXPECT_THAT(of_both.said, HasSubstr("the energy of the mechanism of body 'top' (/bodies/0)"));
  EXPECT_THAT(of_both.said, HasSubstr("its largest kinetic energy"));
}

// A pendulum that loose tolerances drive faster and faster until nothing follows it: the stop is none of the
// mechanism's.
TEST(EnergyBalance, is_said_where_a_run_stops) {
  Settings settings = dynamics("rA", 1e-3, 400);
  settings.integrator = "dopri5", settings.rtol = 1e-2;
  const EnergyFound of = kept(scene_of("simple_pendulum"), settings);
  EXPECT_FALSE(of.ok);
  EXPECT_TRUE(of.told);
  EXPECT_THAT(of.said, HasSubstr("J higher at t = "));
}

// A first order is half a step late, which is much in a few steps and no loss.
TEST(EnergyBalance, what_is_late_is_not_lost) {
  Settings settings = dynamics("rA", 1e-2, 0.1);
  settings.integrator = "implicit_euler";
  const EnergyFound of_few = kept(scene_of("simple_pendulum"), settings);
  EXPECT_GT(of_few.percent, 1.5 * kTold);
  EXPECT_FALSE(of_few.told);
}

// At rest what is left of Newton's method is no loss.
TEST(EnergyBalance, rest_loses_nothing) {
  Scene hanging = loop({.links = 4});
  hanging.gravity = {0, -1e4, 0};
  for (Body& body : hanging.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  Joint weld;
  weld.type = JointType::fixed, weld.i = kGround, weld.j = 0, weld.point = hanging.bodies[0].position;
  hanging.joints.push_back(weld);
  Scene sprung = on_law("1e3*x");
  sprung.bodies[0].velocity.setZero(), sprung.bodies[0].position = {1 + 9.81e-3, 0, 0};
  sprung.gravity = {9.81, 0, 0};
  for (const Scene& scene : {hanging, sprung})
    in_every_way(1e-2, 1, [&](const Settings& settings) {
      const EnergyFound of = kept(scene, settings);
      EXPECT_TRUE(of.ok);
      EXPECT_FALSE(of.told) << of.said;
    });
}

TEST(EnergyBalance, of_what_is_driven_or_damped_nothing_is_known) {
  for (const char* law : {"40*x + 1e-9*v", "40*x + 1e-9*t"}) {
    Settings settings = dynamics("rA", 2e-2, 2);
    settings.integrator = "generalized_alpha";
    settings.parameters["spectral_radius"] = 0;
    EXPECT_FALSE(kept(on_law(law), settings).told) << law;
    const EnergyFound of = kept(on_law("200*x"), settings);
    EXPECT_TRUE(of.told) << of.percent;
  }
}

// A truss that snaps through: 1 kg on a slide between two springs, with less energy than the hill at x = 0 has.
Scene truss(double length, double stiffness, double damping, double x, double v) {
  Scene scene;
  Body block;
  block.name = "block", block.mass = 1, block.inertia = Matrix3::Identity();
  block.position = {x, 0, 0}, block.velocity = {v, 0, 0};
  scene.bodies.push_back(block);
  Joint slide;
  slide.type = JointType::translational, slide.i = kGround, slide.j = 0, slide.axis = {1, 0, 0};
  scene.joints.push_back(slide);
  for (const double side : {1.0, -1.0}) {
    Spring spring;
    spring.name = side > 0 ? "left" : "right", spring.i = kGround, spring.j = 0, spring.s_i = {0, side, 0};
    spring.length = length, spring.stiffness = stiffness, spring.damping = damping;
    scene.forces.push_back(spring);
  }
  return scene;
}

// What the first step invents leads over the hill; at the end it happens to be as at the start, or dampers have taken
// it.
TEST(EnergyBalance, what_is_invented_on_the_way_is_told) {
  Scene fallen = truss(1.2264175471673584, 3200, 0, 0.71, -4.959);
  fallen.gravity = {-9.81, 0, 0};
  Settings settings = dynamics("rA", 0.08592, 25.776);
  settings.integrator = "implicit_euler";
  const auto notices = [&](const Scene& scene) { return simulate(scene, settings, [](const Sample&) {}).notices; };
  EXPECT_THAT(notices(fallen),
              Contains(AllOf(HasSubstr("implicit_euler has the energy "), HasSubstr("J off what it was at the start"),
                             HasSubstr("though no more at the end: nothing drives or damps it"))));
  settings.step /= 64;
  EXPECT_THAT(notices(fallen), Not(Contains(HasSubstr("off what it was"))));

  const Scene damped = truss(1.0733592129385203, 100, 1, 0.39, -0.92);
  settings.integrator = "generalized_alpha", settings.step = 0.1774, settings.end = 17.74;
  settings.parameters["spectral_radius"] = 0;
  EXPECT_THAT(notices(damped), Contains(AllOf(HasSubstr("J off what it was at the least before"),
                                              HasSubstr("dampers take of it and nothing gives"))));
  settings.step /= 16;
  EXPECT_THAT(notices(damped), Not(Contains(HasSubstr("off what it was"))));
}

// Of what rests rounding is all the energy there is.
TEST(EnergyBalance, rest_where_nothing_pulls_is_no_motion) {
  Scene scene;
  Body rod;
  rod.name = "rod", rod.mass = 1, rod.inertia = 0.1 * Matrix3::Identity(), rod.position = {0.5, 0, 0};
  scene.bodies.push_back(rod);
  Joint hinge;
  hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  scene.joints.push_back(hinge);
  TorsionSpring spring;
  spring.i = kGround, spring.j = 0, spring.axis = {0, 0, 1}, spring.law = Expression::parse_law("9.7*x + 16*x^3");
  scene.forces.push_back(spring);
  in_every_way(1e-2, 2, [&](const Settings& settings) {
    const Outcome run = simulate(scene, settings, [](const Sample&) {});
    EXPECT_THAT(run.notices, Not(Contains(HasSubstr("energy")))) << settings.integrator << settings.formulation;
  });
}

// A force that stays as it is in space has a potential.
TEST(EnergyBalance, constant_forces_do_not_hide_what_is_invented) {
  Scene pushed = truss(0.8450713991808606, 9347.884381740016, 0, 0.6008130395768837, -0.9847133314606027);
  pushed.bodies[0].mass = 4.355108217992118;
  for (std::size_t k = 0; k < 2; ++k) std::get<Spring>(pushed.forces[k]).s_i *= 0.6924994676426393;
  PointForce push;
  push.name = "push", push.body = 0, push.force[0] = Expression(-142.76);
  pushed.forces.push_back(push);
  Settings settings = dynamics("reps", 1.54 / 12, 1.54);
  settings.integrator = "generalized_alpha_i2";
  EXPECT_THAT(simulate(pushed, settings, [](const Sample&) {}).notices, Contains(HasSubstr("leaves the energy 75")));
  settings.integrator = "rattle", settings.step = 1.54 / 1000;
  EXPECT_THAT(simulate(pushed, settings, [](const Sample&) {}).notices, Not(Contains(HasSubstr("energy"))));
}

std::vector<EnergyFate> fates(const Scene& scene) {
  const Model model = compile(scene);
  return energy_fates(model, mechanisms(model));
}

TEST(ConservedEnergy, what_moves_or_brakes_a_mechanism_is_seen) {
  using enum EnergyFate;
  Scene two = free_body();
  two.bodies.push_back(two.bodies[0]);
  two.bodies[1].name = "other", two.bodies[1].position = {3, 0, 0};
  EXPECT_THAT(fates(two), ElementsAre(kept, kept));
  const auto with_force = [&](const Force& force) {
    Scene scene = two;
    scene.forces.push_back(force);
    return fates(scene);
  };
  PointForce push;
  push.body = 1;
  EXPECT_THAT(with_force(push), ElementsAre(kept, kept));
  push.force[1] = Expression(1.0);
  EXPECT_THAT(with_force(push), ElementsAre(kept, kept));
  EXPECT_TRUE(conserves_energy(compile(two)));
  two.forces.push_back(push);
  EXPECT_FALSE(conserves_energy(compile(two)));  // T + V alone is not
  two.forces.clear();
  push.frame = Frame::body;
  EXPECT_THAT(with_force(push), ElementsAre(kept, unknown));
  Torque twist;
  twist.body = 0, twist.torque[2] = Expression::parse("t");
  EXPECT_THAT(with_force(twist), ElementsAre(unknown, kept));
  LinearDrag drag;
  drag.body = 0;
  EXPECT_THAT(with_force(drag), ElementsAre(kept, kept));
  drag.rotational = 1;
  EXPECT_THAT(with_force(drag), ElementsAre(taken, kept));
  drag.rotational = -1;
  EXPECT_THAT(with_force(drag), ElementsAre(unknown, kept));
  CallbackForce callback;
  callback.bodies = {1}, callback.loads = [](double, std::span<const BodyState>, std::span<Load>) {};
  EXPECT_THAT(with_force(callback), ElementsAre(kept, unknown));
  Spring spring;
  spring.i = kGround, spring.j = 1, spring.stiffness = 1;
  EXPECT_THAT(with_force(spring), ElementsAre(kept, kept));
  spring.damping = 1;
  EXPECT_THAT(with_force(spring), ElementsAre(kept, taken));
  two.forces.push_back(push);
  EXPECT_THAT(with_force(spring), ElementsAre(kept, unknown));
  two.forces.clear();
  TorsionSpring torsion;
  torsion.i = kGround, torsion.j = 0, torsion.axis = {0, 0, 1}, torsion.law = Expression::parse_law("x^3");
  EXPECT_THAT(with_force(torsion), ElementsAre(kept, kept));
  torsion.law = Expression::parse_law("x^3 + v");
  EXPECT_THAT(with_force(torsion), ElementsAre(unknown, kept));
  torsion.law = Expression::parse_law("x^3*t");
  EXPECT_THAT(with_force(torsion), ElementsAre(unknown, kept));

  const auto with_row = [&](ConstraintType type, const char* f) {
    Scene scene = two;
    Constraint row;
    row.type = type, row.i = kGround, row.j = 1, row.c = row.a_j = {1, 0, 0}, row.s_i = {3, 0, 0};
    row.f = Expression::parse(f);
    scene.constraints.push_back(row);
    return fates(scene);
  };
  EXPECT_THAT(with_row(ConstraintType::CD, "0"), ElementsAre(kept, kept));
  EXPECT_THAT(with_row(ConstraintType::CD, "t"), ElementsAre(kept, unknown));
  EXPECT_THAT(with_row(ConstraintType::pfaffian, "0"), ElementsAre(kept, kept));
  EXPECT_THAT(with_row(ConstraintType::pfaffian, "1"), ElementsAre(kept, unknown));
}

}  // namespace
}  // namespace poinsot::test
