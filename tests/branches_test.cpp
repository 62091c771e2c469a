// Kinematics stays on the branch it began on, whatever its steps, or stops where there are two ways to go on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/index.h"
#include "core/input_error.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;
constexpr const char* kFormulations[] = {"rA", "rp", "reps"};

// With the matrix of every iterate, one that is kept, and that of the position before.
class Branches : public ::testing::TestWithParam<const char*> {
 protected:
  static Settings kinematics(std::string_view formulation, double step, double end) {
    Settings settings = test::kinematics(formulation, step, end);
    settings.jacobian = GetParam();
    return settings;
  }
};
INSTANTIATE_TEST_SUITE_P(Kinematics, Branches, ::testing::Values("exact", "kept", "simplified"),
                         [](const auto& jacobian) { return std::string(jacobian.param); });

// A four-bar in the plane z = 0: crank from the origin, rocker from (d, 0, 0), crank at `angle` at the start and the
// coupler's far end B to the left of the way from the crank's end A to the rocker's pivot. The crank turns at 1 rad/s.
struct FourBar {
  double crank, coupler, rocker, d;

  Vector3 A(double angle) const { return {crank * std::cos(angle), crank * std::sin(angle), 0}; }
  Vector3 B(double angle) const {
    const Vector3 a = A(angle), way = Vector3(d, 0, 0) - a;
    const double length = way.norm();
    const double along = (coupler * coupler - rocker * rocker + length * length) / (2 * length);
    const Vector3 e = way / length, up(-e.y(), e.x(), 0);
    return a + along * e + std::sqrt(std::max(0.0, coupler * coupler - along * along)) * up;
  }
};

int add_bar(Scene& scene, const std::string& name, const Vector3& from, const Vector3& to) {
  const Vector3 x = (to - from).normalized();
  Body bar;
  bar.name = name, bar.mass = 1, bar.inertia = Vector3(0.01, 0.1, 0.1).asDiagonal();
  bar.position = 0.5 * (from + to);
  bar.orientation << x.x(), -x.y(), 0, x.y(), x.x(), 0, 0, 0, 1;
  scene.bodies.push_back(bar);
  return static_cast<int>(scene.bodies.size()) - 1;
}

void join_at(Scene& scene, JointType type, int i, int j, const Vector3& point) {
  Joint joint;
  joint.type = type, joint.i = i, joint.j = j, joint.point = point;
  if (type != JointType::spherical) joint.axis = {0, 0, 1};
  scene.joints.push_back(joint);
}

// Coupler and rocker beside the crank, without redundant rows.
void add_dyad(Scene& scene, int crank, const FourBar& of, double angle, const Vector3& at) {
  const Vector3 A = of.A(angle), B = of.B(angle), D(of.d, 0, 0);
  const int coupler = add_bar(scene, "coupler", A + at, B + at), rocker = add_bar(scene, "rocker", D + at, B + at);
  join_at(scene, JointType::revolute, crank, coupler, A + at);
  join_at(scene, JointType::spherical, coupler, rocker, B + at);
  join_at(scene, JointType::cylindrical, kGround, rocker, D + at);
  scene.bodies.back().name = "rocker" + std::to_string(scene.bodies.size());
  scene.bodies[scene.bodies.size() - 2].name = "coupler" + std::to_string(scene.bodies.size());
}

void add_four_bar(Scene& scene, const FourBar& of, double angle, const char* turn, const Vector3& at) {
  const std::string number = std::to_string(scene.drivers.size());
  const int crank = add_bar(scene, "crank" + number, at, of.A(angle) + at);
  join_at(scene, JointType::revolute, kGround, crank, at);
  add_dyad(scene, crank, of, angle, at);
  Driver motor;
  motor.name = "motor" + number, motor.i = kGround, motor.j = crank, motor.axis = {0, 0, 1},
  motor.value = Expression::parse(turn);
  scene.drivers.push_back(motor);
}

Scene four_bar(const FourBar& of, double angle, const char* turn = "t") {
  Scene scene;
  add_four_bar(scene, of, angle, turn, Vector3::Zero());
  return scene;
}

// Where the coupler's far end is off its place, the worst over the samples.
double off_branch(const FourBar& of, double angle, const std::vector<Snapshot>& samples) {
  double worst = 0;
  for (const Snapshot& s : samples) {
    const BodyState& coupler = s.bodies[1];
    const Vector3 B = coupler.r + coupler.A * Vector3(0.5 * of.coupler, 0, 0);
    worst = std::max(worst, (B - of.B(angle + s.t)).norm());
  }
  return worst;
}

TEST_P(Branches, a_crank_rocker_beside_its_change_point_keeps_its_assembly) {
  for (double gap : {1e-3, 1e-5, 1e-7}) {
    const FourBar close{1, 2 + gap, 2, 3};  // at crank angle pi the dyad is straight but for `gap`
    for (const char* formulation : kFormulations)
      for (double step : {0.005, 0.013, 0.1}) {
        Settings settings = kinematics(formulation, step, 2 * pi);
        const auto samples = motion(four_bar(close, pi / 2), settings);
        EXPECT_LT(off_branch(close, pi / 2, samples), 1e-6) << formulation << " step " << step << " gap " << gap;
      }
  }
}

TEST_P(Branches, keep_with_every_linear_solver_and_the_default_tolerance) {
  const FourBar close{1, 2 + 1e-4, 2, 3};
  for (const auto& solver : linear_solvers()) {
    Settings settings = kinematics("rA", 0.02, 2 * pi);
    settings.linear_solver = solver.name;
    settings.tolerance = 1e-3;
    EXPECT_LT(off_branch(close, pi / 2, motion(four_bar(close, pi / 2), settings)), 1e-3) << solver.name;
  }
}

TEST_P(Branches, steps_of_more_than_half_a_turn_are_followed) {
  const FourBar easy{1, 3, 3, 4};
  for (const char* formulation : kFormulations)
    for (double step : {0.7, 2.5, 4.0, 6.0}) {
      const auto samples = motion(four_bar(easy, pi / 2), kinematics(formulation, step, 24));
      EXPECT_LT(off_branch(easy, pi / 2, samples), 1e-8) << formulation << " step " << step;
    }
}

TEST_P(Branches, a_change_point_stops_the_run_and_is_named) {
  const FourBar change{1, 2, 2, 3}, parallelogram{1, 2, 1, 2};
  for (const char* formulation : kFormulations)
    for (double step : {0.01, 0.1, 0.35}) {
      for (const FourBar& of : {change, parallelogram}) {
        const Recorded r = run(four_bar(of, pi / 2), kinematics(formulation, step, 2 * pi));
        ASSERT_FALSE(r.outcome.status.ok()) << formulation << " step " << step;
        EXPECT_NEAR(r.outcome.status.time, pi / 2, 1e-3) << r.outcome.status.message;
        EXPECT_EQ(r.outcome.status.failure, Failure::singular_position) << r.outcome.status.message;
        EXPECT_LT(off_branch(of, pi / 2, r.samples), 1e-6);
      }
    }
}

TEST_P(Branches, two_change_points_at_once_are_seen_each) {
  const FourBar of{1, 2, 1, 2};
  Scene scene = four_bar(of, pi / 2);
  add_dyad(scene, 0, of, pi / 2, Vector3::Zero());
  const Recorded r = run(scene, kinematics("rA", 0.01, pi));
  EXPECT_EQ(r.outcome.status.failure, Failure::singular_position) << r.outcome.status.message;
}

// Some 900 rows, of which those of one loop come to depend on one another.
TEST_P(Branches, a_change_point_is_seen_in_a_large_mechanism) {
  const FourBar easy{1, 3, 3, 4}, change{1, 2, 2, 3};
  for (const char* formulation : kFormulations) {
    Scene scene;
    for (int k = 0; k < 50; ++k) add_four_bar(scene, k == 30 ? change : easy, pi / 2, "t", Vector3(0, 3.0 * k, 0));
    const Recorded r = run(scene, kinematics(formulation, 0.35, 2 * pi));
    EXPECT_EQ(r.outcome.status.failure, Failure::singular_position) << r.outcome.status.message;
    EXPECT_NEAR(r.outcome.status.time, pi / 2, 1e-3);
    EXPECT_THAT(r.outcome.status.message, ::testing::ContainsRegex("/joints/12[0-3]|/drivers/30"));
  }
}

// A rod turned about z by its direction's cosine alone: at 0 and pi the constraint does not say which way.
TEST_P(Branches, a_direction_driven_past_its_turning_point) {
  Scene bare;
  Body rod;
  rod.name = "rod", rod.mass = 1, rod.inertia = Matrix3::Identity(), rod.angular_velocity = {0, 0, 1};
  bare.bodies.push_back(rod);
  join_at(bare, JointType::revolute, kGround, 0, Vector3::Zero());
  Constraint cosine;
  cosine.name = "cosine", cosine.type = ConstraintType::DP1, cosine.i = kGround, cosine.j = 0;
  cosine.a_i = {0, 1, 0}, cosine.a_j = {1, 0, 0}, cosine.f = Expression::parse("sin(t)");
  bare.constraints.push_back(cosine);
  Scene helped = bare;
  helped.constraints[0].alternate = Constraint::Alternate{{1, 0, 0}, {1, 0, 0}, Expression::parse("cos(t)")};
  for (const char* formulation : kFormulations)
    for (double step : {0.0103, 0.37}) {
      const Recorded stopped = run(bare, kinematics(formulation, step, 2 * pi));
      EXPECT_FALSE(stopped.outcome.status.ok()) << formulation << " step " << step;
      EXPECT_NEAR(stopped.outcome.status.time, pi / 2, 0.01)
          << formulation << " step " << step << stopped.outcome.status.message;
      for (const Snapshot& s : motion(helped, kinematics(formulation, step, 2 * pi)))
        EXPECT_LT((s.bodies[0].A.col(0) - Vector3(std::cos(s.t), std::sin(s.t), 0)).norm(), 1e-8)
            << formulation << " step " << step;
    }
}

// Likewise where the turning point is a time of the grid itself, and nothing is given out there.
TEST_P(Branches, a_direction_driven_to_its_turning_point_by_a_step) {
  Scene scene;
  Body rod;
  rod.name = "rod", rod.mass = 1, rod.inertia = Matrix3::Identity(), rod.angular_velocity = {0, 0, 1};
  scene.bodies.push_back(rod);
  join_at(scene, JointType::revolute, kGround, 0, Vector3::Zero());
  Constraint sine;
  sine.type = ConstraintType::DP1, sine.j = 0;
  sine.a_i = {0, 1, 0}, sine.a_j = {1, 0, 0}, sine.f = Expression::parse("sin(t)");
  scene.constraints.push_back(sine);
  for (const char* formulation : kFormulations) {
    for (const int steps : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16, 33, 100}) {
      SCOPED_TRACE(::testing::Message() << formulation << ", a quarter turn in " << steps);
      const Recorded r = run(scene, kinematics(formulation, pi / 2 / steps, pi));
      EXPECT_EQ(r.outcome.status.failure, Failure::singular_position) << r.outcome.status.message;
      for (const Snapshot& s : r.samples) EXPECT_NEAR(s.bodies[0].w.z(), 1, 1e-6) << s.t;
    }
  }
}

// Six legs from a hexagon to the platform in its plane at t = pi/2, where it may go on up or down.
TEST_P(Branches, a_platform_driven_through_its_flat_pose_stops) {
  Scene scene;
  Body platform;
  platform.name = "platform", platform.mass = 1, platform.inertia = Vector3(1, 1, 2).asDiagonal();
  platform.position = {0, 0, 1};
  scene.bodies.push_back(platform);
  for (int k = 0; k < 6; ++k) {
    const double base = pi / 3 * k + (k % 2 ? -0.2 : 0.2), top = pi / 3 * k + (k % 2 ? 0.35 : -0.35);
    Driver leg;
    leg.name = "leg" + std::to_string(k + 1), leg.type = DriverType::distance, leg.i = kGround, leg.j = 0;
    leg.s_i = {2 * std::cos(base), 2 * std::sin(base), 0}, leg.s_j = {std::cos(top), std::sin(top), 0};
    leg.value = Expression::parse(fmt::format("sqrt({:.17g} + cos(t)^2)", (leg.s_i - leg.s_j).squaredNorm()));
    scene.drivers.push_back(leg);
  }
  for (const char* formulation : kFormulations)
    for (double step : {0.01, 0.1, 0.3}) {
      const Recorded r = run(scene, kinematics(formulation, step, pi));
      ASSERT_FALSE(r.outcome.status.ok()) << formulation << " step " << step;
      EXPECT_NEAR(r.outcome.status.time, pi / 2, 0.01) << r.outcome.status.message;
      for (const Snapshot& s : r.samples) EXPECT_NEAR(s.bodies[0].r.z(), std::cos(s.t), 1e-6);
    }
}

TEST_P(Branches, drivers_that_ask_for_the_pose_half_a_turn_off_or_a_negative_length_are_refused) {
  Scene sled;
  Body& body = sled.bodies.emplace_back();
  body.name = "sled", body.mass = 1, body.inertia.setIdentity(), body.position = {1, 0, 0};
  Joint guide;
  guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {1, 0, 0};
  sled.joints.push_back(guide);
  Driver length;
  length.name = "length", length.type = DriverType::distance, length.i = kGround, length.j = 0;
  length.value = Expression::parse("-1 - t");
  sled.drivers.push_back(length);
  Scene crank;
  add_bar(crank, "crank", Vector3::Zero(), {1, 0, 0});
  join_at(crank, JointType::revolute, kGround, 0, Vector3::Zero());
  Driver motor;
  motor.name = "motor", motor.i = kGround, motor.j = 0, motor.axis = {0, 0, 1};
  motor.value = Expression::parse("pi + t");
  crank.drivers.push_back(motor);
  for (const char* formulation : kFormulations)
    for (const Scene& scene : {sled, crank})
      for (const IntegratorEntry& integrator : integrators()) {
        Settings settings = kinematics(formulation, 0.01, 0.02);
        settings.analysis = integrator.analysis, settings.integrator = integrator.name;
        if (refusal_of(integrator, formulation)) continue;
        try {
          EXPECT_THAT(run(scene, settings).outcome.status.failure,
                      testing::AnyOf(Failure::inconsistent_state, Failure::not_finite))
              << formulation << ' ' << integrator.name;
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(), testing::HasSubstr("asks for an angle of 3.14159 rad at t = 0"));
        }
      }
}

// Which no method passes, however near to it a step has come: another step or method is not all that is offered.
TEST(DrivenBeyondReach, is_to_be_ended_before) {
  int stopped = 0;
  for (const FourBar& of : {FourBar{1, 1.2, 0.6, 2}, FourBar{1, 1.3, 0.7, 2.2}, FourBar{0.5, 0.9, 0.4, 1.4}})
    for (const char* integrator : {"implicit_euler", "rattle", "generalized_alpha", "half_implicit"})
      for (const double step : {1e-2, 7e-3, 3e-3}) {
        Settings settings;
        settings.integrator = integrator, settings.step = step, settings.end = 3;
        const Recorded r = run(four_bar(of, pi / 3), settings);
        ASSERT_FALSE(r.outcome.status.ok());
        if (r.outcome.status.failure == Failure::rotation_too_large) continue;
        ++stopped;
        EXPECT_THAT(r.outcome.status.message, ::testing::HasSubstr("end before it")) << integrator << ' ' << step;
      }
  EXPECT_GT(stopped, 20);
}

TEST(DrivenBeyondReach, is_found_in_kinematics_to_the_time) {
  for (const FourBar& of : {FourBar{1, 1.2, 0.6, 2}, FourBar{1, 1.3, 0.7, 2.2}, FourBar{0.5, 0.9, 0.4, 1.4}})
    for (const char* formulation : {"rA", "rp", "reps"})
      for (const double step : {0.3, 0.03, 0.003}) {
        const Recorded r = run(four_bar(of, pi / 3), kinematics(formulation, step, 3));
        EXPECT_EQ(r.outcome.status.failure, Failure::singular_position);
        EXPECT_THAT(r.outcome.status.message, ::testing::HasSubstr("no method passes; end before it"));
        const double stretched = of.coupler + of.rocker;
        const double last =
            std::acos((of.crank * of.crank + of.d * of.d - stretched * stretched) / (2 * of.crank * of.d));
        EXPECT_NEAR(r.outcome.status.time, last - pi / 3, 1e-6) << formulation << ' ' << step;
      }
}

}  // namespace
}  // namespace poinsot::test
