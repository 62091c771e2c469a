// Kinematics of crank-rockers that all but come to a change point on their way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/index.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;

// A crank-rocker through the points of its hinges.
Scene near_change_point(const std::vector<Vector3>& at, const char* angle) {
  Scene scene;
  for (const int k : {0, 1, 2}) {
    Body bar;
    bar.name = "abc"[k], bar.mass = 1, bar.inertia = Vector3(0.01, 0.1, 0.1).asDiagonal();
    bar.position = 0.5 * (at[index(k)] + at[index(k + 1)]);
    scene.bodies.push_back(bar);
  }
  for (const int k : {0, 1, 2, 3}) {
    Joint hinge;
    hinge.type = JointType::revolute, hinge.i = k - 1, hinge.j = k == 3 ? kGround : k;
    hinge.point = at[index(k)], hinge.axis = {0, 0, 1};
    scene.joints.push_back(hinge);
  }
  Driver motor;
  motor.type = DriverType::angle, motor.i = kGround, motor.j = 0;
  motor.axis = {0, 0, 1}, motor.value = Expression::parse(angle);
  scene.drivers.push_back(motor);
  return scene;
}

const std::vector<Vector3> kNearChange = {{0, 0, 0},
                                          {-0.18902561544751362, 0.8826384859096528, 0},
                                          {0.704368013401201, 1.0125595731767851, 0},
                                          {1.0800894449633351, 0, 0}};

// A position that is right to the tolerance may say nothing of velocities.
TEST(KinematicSteps, beside_a_change_point_have_velocities_to_the_tolerance_as_well) {
  const Scene cranks[] = {near_change_point(kNearChange, "1.9553182296794809*t"),
                          near_change_point({{0, 0, 0},
                                             {0.51980852398688615, -0.36221694812411981, 0},
                                             {1.2637043339039145, 0.86513025505308216, 0},
                                             {1.2014096358670501, 0, 0}},
                                            "1.2143760376282524*t"),
                          near_change_point({{0, 0, 0},
                                             {0.5026491727439274, 0.41616739717557211, 0},
                                             {1.1296787145649794, 1.1518718689315914, 0},
                                             {1.5352807510039281, 0, 0}},
                                            "-2.2682178680297307*t")};
  for (const Scene& scene : cranks)
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const double step : {0.02, 0.05, 0.1}) {
        Settings settings = kinematics(formulation, step, 3);
        settings.tolerance = 1e-12;
        const Recorded sharp = run(scene, settings);
        for (const char* jacobian : {"exact", "kept", "simplified"}) {
          settings.jacobian = jacobian, settings.tolerance = 1e-3;
          const Recorded r = run(scene, settings);
          ASSERT_TRUE(r.outcome.status.ok()) << jacobian << ": " << r.outcome.status.message;
          ASSERT_EQ(r.samples.size(), sharp.samples.size());
          double most = 0;
          for (std::size_t k = 0; k < r.samples.size(); ++k) {
            double off = 0, fastest = 0;
            for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
              const Vector3& rd = sharp.samples[k].bodies[b].rd;
              off = std::max(off, (r.samples[k].bodies[b].rd - rd).norm());
              fastest = std::max(fastest, rd.norm());
            }
            most = std::max(most, off / fastest);
          }
          EXPECT_LT(most, 4e-3) << formulation << ' ' << jacobian << ' ' << step;
        }
      }
}

// One step ends off the position by the tolerance, with a matrix of before, and shorter ones find their way from it.
TEST(KinematicSteps, that_end_off_the_position_beside_a_change_point_go_on) {
  const struct {
    Scene scene;
    const char *formulation, *jacobian;
    double step, end;
  } cases[] = {
      {near_change_point(kNearChange, "1.9553182296794809*t"), "rA", "simplified", 0.05, 3.53472},
      {near_change_point({{0, 0, 0},
                          {0.2124122152739908, -0.25339265814863454, 0},
                          {1.6790627714610782, 0.4505727691068426, 0},
                          {1.7526929388731944, 0, 0}},
                         "-1.975788381447585*t"),
       "rp", "kept", 0.05, 3.4981},
  };
  for (const auto& of : cases) {
    Settings settings = kinematics(of.formulation, of.step, of.end);
    settings.jacobian = of.jacobian, settings.tolerance = 1e-3;
    const Recorded r = run(of.scene, settings);
    ASSERT_TRUE(r.outcome.status.ok()) << of.jacobian << ": " << r.outcome.status.message;
    settings.jacobian = "exact", settings.step = of.step / 50, settings.tolerance = 1e-10;
    const Recorded exact = run(of.scene, settings);
    EXPECT_LT((r.samples.back().bodies[1].r - exact.samples.back().bodies[1].r).norm(), 1e-3) << of.jacobian;
  }
}

// A four-bar whose shortest and longest bars are together as long as the others: folded flat it can go on in two ways,
// and of these the one with the determinant's old sign is the one on which velocities jump.
TEST(KinematicSteps, never_pass_a_change_point_unseen) {
  constexpr double lead = 0.9;
  const struct {
    double crank, coupler, rocker, d, folded;
  } bars[] = {{0.5, 0.8, 0.9, 1.2, pi}, {0.5, 0.8, 1.2, 0.9, 0}, {0.45, 1.25, 0.7, 1.0, 0}, {0.7, 0.9, 0.7, 0.9, pi}};
  for (const auto& of : bars)
    for (const double side : {-1.0, 1.0}) {
      const double angle = of.folded - lead;
      const Vector3 A(of.crank * std::cos(angle), of.crank * std::sin(angle), 0), D(of.d, 0, 0), way = D - A;
      const double length = way.norm(), along = (std::pow(of.coupler, 2) - std::pow(of.rocker, 2)) / (2 * length);
      const double up = std::sqrt(std::pow(of.coupler, 2) - std::pow(along + length / 2, 2));
      const Vector3 e = way / length, B = A + (along + length / 2) * e + side * up * Vector3(-e.y(), e.x(), 0);
      const Scene scene = near_change_point({Vector3::Zero(), A, B, D}, "3*t");
      for (const char* formulation : {"rA", "rp", "reps"})
        for (const char* jacobian : {"exact", "kept", "simplified"})
          for (const double step : {0.1, 0.05, 0.01})
            for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
              Settings settings = kinematics(formulation, step, 0.6);
              settings.jacobian = jacobian, settings.tolerance = tolerance;
              const Recorded r = run(scene, settings);
              EXPECT_EQ(r.outcome.status.failure, Failure::singular_position)
                  << formulation << ' ' << jacobian << ' ' << step << ' ' << tolerance << ": " << of.d << ' ' << side;
              EXPECT_NEAR(r.outcome.status.time, lead / 3, 1e-3);
            }
    }
}

// Where a driver's velocity jumps all others do, and the mechanism goes on as it is, whatever its size.
TEST(KinematicSteps, pass_kinks_of_drivers) {
  const char* const law = "abs(t - 0.333) + 0.5*max(0, t - 0.7771) - 3*max(0, t - 0.9) - 0.333";
  const double angle = 0.867 + 0.5 * 0.4229 - 3 * 0.3 - 0.333;
  for (const double size : {1e-6, 1.0, 1e6}) {
    const Scene scene = near_change_point(
        {Vector3::Zero(), size * Vector3(0.5, 0, 0), size * Vector3(0.7, 0.9, 0), size * Vector3(1.2, 0, 0)}, law);
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const char* jacobian : {"exact", "kept", "simplified"})
        for (const double step : {0.2, 0.05, 0.01}) {
          Settings settings = kinematics(formulation, step, 1.2);
          settings.jacobian = jacobian, settings.tolerance = 1e-10 * std::max(1.0, size);
          const Recorded r = run(scene, settings);
          ASSERT_TRUE(r.outcome.status.ok()) << size << jacobian << step << r.outcome.status.message;
          const Vector3 at = 0.25 * size * Vector3(std::cos(angle), std::sin(angle), 0);
          EXPECT_LT((r.samples.back().bodies[0].r - at).norm(), 1e-6 * size)
              << formulation << ' ' << jacobian << ' ' << step;
        }
  }
}

// Velocities that are nothing but rounding jump from step to step.
TEST(KinematicSteps, pass_where_velocities_are_rounding) {
  for (const char* law :
       {"sin(2*t) - 2*sin(t)*cos(t)", "exp(-((t - 1)/0.001)^2)", "0.1*(cos(t) + cos(t + 2*pi/3) + cos(t + 4*pi/3))"}) {
    const Scene scene = near_change_point({{0, 0, 0}, {0.5, 0, 0}, {0.7, 0.9, 0}, {1.2, 0, 0}}, law);
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const double step : {0.1, 0.01}) {
        const Recorded r = run(scene, kinematics(formulation, step, 2));
        ASSERT_TRUE(r.outcome.status.ok()) << law << ' ' << formulation << ' ' << step << r.outcome.status.message;
        EXPECT_LT((r.samples.back().bodies[1].r - scene.bodies[1].position).norm(), 1e-9) << law << ' ' << formulation;
        const double iterations = static_cast<double>(r.outcome.statistics.newton_iterations),
                     steps = static_cast<double>(r.outcome.statistics.steps);
        const bool moves = std::string_view(law).starts_with("exp");  // for an instant
        EXPECT_LT(iterations, moves ? 5 * steps + 1000 : 1.5 * steps + 5) << law << ' ' << formulation;
      }
  }
}

}  // namespace
}  // namespace poinsot::test
