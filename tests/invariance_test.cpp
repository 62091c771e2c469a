// A mechanism moves the same however it is told: turned or moved as a whole, in other body frames, renumbered, with its
// rows in another order.
//
// In kinematics this holds to rounding in every formulation, and so it does in dynamics for the discrete trajectories
// of rA, where implicit Euler adds h ω̄ in the body (A → R A F takes A exp(h ω̃̄) along), and of rp, where a change of
// frame is a constant orthogonal matrix on the Euler parameters, which p_n + h ṗ takes along as well. For reps it holds
// only to O(h): ε_n + h ε̇ is another approximation of a turn in other Euler angles, because these do not depend
// linearly on one another. What reps keeps: translations, numbering and order; turns about the global z axis (φ is
// shifted) and of body frames about their z axes (ψ is shifted); and, where no degree of freedom is left, positions and
// all that follows from them alone (A, ṙ, r̈: the scheme then solves Φ = 0 at every step, whatever the angles).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <tuple>

#include "tests/support/scene_transform.h"

namespace poinsot::test {
namespace {

constexpr unsigned kRandomSeed = 20240607;

Matrix3 random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

Matrix3 about(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

enum class Kind { turned, moved, reframed, renumbered, reordered, all };
constexpr std::pair<Kind, const char*> kKinds[] = {{Kind::turned, "turned"},       {Kind::moved, "moved"},
                                                   {Kind::reframed, "reframed"},   {Kind::renumbered, "renumbered"},
                                                   {Kind::reordered, "reordered"}, {Kind::all, "all"}};

Transform make(Kind kind, const Scene& scene) {
  std::mt19937 random(kRandomSeed + static_cast<unsigned>(kind));
  const auto is = [&](Kind k) { return kind == k || kind == Kind::all; };
  Transform x;
  if (is(Kind::turned)) x.R = random_rotation(random);
  if (is(Kind::moved)) x.t = Vector3(1, -2, 3);
  for (std::size_t b = 0; is(Kind::reframed) && b < scene.bodies.size(); ++b) x.F.push_back(random_rotation(random));
  if (is(Kind::renumbered)) {
    x.place.resize(scene.bodies.size());
    std::iota(x.place.begin(), x.place.end(), 0);
    std::rotate(x.place.begin(), x.place.begin() + 1, x.place.end());
  }
  if (is(Kind::reordered)) x.shuffle = kRandomSeed, x.exchange = true;
  return x;
}

Distance apart(const Scene& scene, const Transform& transform, const Settings& settings) {
  return distance(transform.back(motion(transform.apply(scene), settings)), motion(scene, settings));
}

// The loop of revolute, universal and spherical joints without its driver, with forces of every type.
Scene free_loop() {
  Scene scene = scene_of("four_link_joints");
  scene.drivers.clear();
  PointForce push;
  push.body = 1;
  push.point = {0.3, 0.2, -0.1};
  push.force[0] = Expression::parse("10*sin(3*t)"), push.force[2] = Expression(5);
  PointForce follower = push;
  follower.frame = Frame::body;
  Torque motor;
  motor.body = 0;
  motor.torque[2] = Expression::parse("2 + t");
  Torque outside = motor;
  outside.frame = Frame::global;
  Spring spring;
  spring.i = kGround, spring.j = 2;
  spring.s_i = {-8, -8.5, 1}, spring.s_j = {0.1, -3.7, 0.2};
  spring.stiffness = 20, spring.damping = 1, spring.length = 2;
  TorsionSpring torsion;
  torsion.i = kGround, torsion.j = 0;  // where a revolute joint is: elsewhere the angle depends on the frame
  torsion.axis = {1, 0, 0};
  torsion.stiffness = 3, torsion.damping = 0.2, torsion.angle = 0.1;
  LinearDrag drag;
  drag.body = 2;
  drag.translational = 0.5, drag.rotational = 0.2;
  scene.forces = {push, follower, motor, outside, spring, torsion, drag};
  return scene;
}

// Two bodies with full inertia tensors on a universal and a spherical joint, tumbling.
Scene tumbling_chain() {
  std::mt19937 random(kRandomSeed);
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const Matrix3 turn = random_rotation(random);
  for (int b = 0; b < 2; ++b) {
    Body body;
    body.name = b ? "lower" : "upper";
    body.mass = 1 + b;
    body.inertia = turn * Vector3(0.1, 0.2, 0.25).asDiagonal() * turn.transpose();
    body.position = {0.2, 0.3, -0.5 - b};
    body.orientation = random_rotation(random);
    scene.bodies.push_back(body);
  }
  Joint universal;
  universal.name = "universal";
  universal.type = JointType::universal;
  universal.j = 0;
  universal.axis_i = {1, 0, 0}, universal.axis_j = {0, 0.6, 0.8};
  Joint spherical;
  spherical.name = "spherical";
  spherical.type = JointType::spherical;
  spherical.i = 0, spherical.j = 1;
  spherical.point = {0.3, 0.2, -1};
  scene.joints = {universal, spherical};
  // an angular velocity of the upper body about its own axis of the joint; the lower body's centre goes along
  const Vector3 w = 3 * universal.axis_j;
  scene.bodies[0].angular_velocity = scene.bodies[0].orientation.transpose() * w;
  scene.bodies[0].velocity = w.cross(scene.bodies[0].position);
  scene.bodies[1].angular_velocity = {0.5, -1, 2};
  scene.bodies[1].velocity = w.cross(spherical.point) + (scene.bodies[1].orientation * scene.bodies[1].angular_velocity)
                                                            .cross(scene.bodies[1].position - spherical.point);
  return scene;
}

class Kinematics : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Kinematics, IsInvariant) {
  const auto& [model, formulation] = GetParam();
  const Scene scene = scene_of(model);
  for (const auto& [kind, name] : kKinds) {
    const Distance d = apart(scene, make(kind, scene), kinematics(formulation, 1e-2, 1.5));
    EXPECT_LT(d.largest(), 1e-10) << name << ", seed " << kRandomSeed << ": " << d;
  }
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<std::string, std::string>>& test) {
  return std::get<0>(test.param) + "_" + std::get<1>(test.param);
}

const auto kDrivenModels =
    ::testing::Values("single_pendulum", "four_link", "four_link_joints", "slider_crank", "slider_crank_joints");
INSTANTIATE_TEST_SUITE_P(All, Kinematics, ::testing::Combine(kDrivenModels, ::testing::ValuesIn(formulation_names())),
                         name_of);

Settings precise_dynamics(const std::string& formulation, double step, double end) {
  Settings settings = dynamics(formulation, step, end);
  settings.tolerance *= 1e-2;
  return settings;
}

class DrivenDynamics : public Kinematics {};

TEST_P(DrivenDynamics, IsInvariant) {
  const auto& [model, formulation] = GetParam();
  const Scene scene = scene_of(model);
  for (const auto& [kind, name] : kKinds) {
    Distance d = apart(scene, make(kind, scene), precise_dynamics(formulation, 1e-2, 0.6));
    if (formulation == "reps" && (kind == Kind::turned || kind == Kind::reframed || kind == Kind::all)) {
      d.w = d.wd = 0;
    }
    EXPECT_LT(d.largest(), 1e-10) << name << ", seed " << kRandomSeed << ": " << d;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DrivenDynamics,
                         ::testing::Combine(kDrivenModels, ::testing::ValuesIn(formulation_names())), name_of);

// Slow enough for steps of 1e-2 s.
Scene slow_top() {
  Scene scene = scene_of("heavy_top");
  scene.bodies[0].angular_velocity /= 30;
  scene.bodies[0].velocity /= 30;
  return scene;
}

const std::map<std::string, Scene (*)()> kFree = {
    {"free_loop", free_loop}, {"tumbling_chain", tumbling_chain}, {"heavy_top", slow_top}};
const auto kFreeNames = ::testing::Values("free_loop", "tumbling_chain", "heavy_top");

class FreeDynamics : public Kinematics {};

TEST_P(FreeDynamics, IsInvariant) {
  const auto& [model, formulation] = GetParam();
  const Scene scene = kFree.at(model)();
  for (const auto& [kind, name] : kKinds) {
    Transform transform = make(kind, scene);
    if (formulation == "reps") {  // turns that shift φ and ψ; the top begins at sin θ = 0, where ψ turns about y
      const Vector3 axis = model == "heavy_top" ? Vector3::UnitY() : Vector3::UnitZ();
      if (kind == Kind::turned || kind == Kind::all) transform.R = about(Vector3::UnitZ(), 1.1);
      for (std::size_t b = 0; b < transform.F.size(); ++b) transform.F[b] = about(axis, 0.2 + static_cast<double>(b));
    }
    const Distance d = apart(scene, transform, precise_dynamics(formulation, 1e-2, 0.5));
    EXPECT_LT(d.largest(), 1e-10) << name << ", seed " << kRandomSeed << ": " << d;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FreeDynamics, ::testing::Combine(kFreeNames, ::testing::ValuesIn(formulation_names())),
                         name_of);

// In other angles reps computes another approximation of the same motion: apart by O(h), and not by less.
class AnglesInSpace : public ::testing::TestWithParam<std::string> {};

TEST_P(AnglesInSpace, DifferByTheOrderOfTheStep) {
  const Scene scene = kFree.at(GetParam())();
  const std::vector<double> steps = {1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5};
  for (Kind kind : {Kind::turned, Kind::reframed}) {
    const Transform transform = make(kind, scene);
    std::vector<double> errors;
    for (double step : steps) errors.push_back(apart(scene, transform, precise_dynamics("reps", step, 0.2)).r);
    EXPECT_TRUE(converges(steps, errors)) << kKinds[static_cast<int>(kind)].second << ", seed " << kRandomSeed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, AnglesInSpace, kFreeNames, [](const auto& test) { return test.param; });

}  // namespace
}  // namespace poinsot::test
