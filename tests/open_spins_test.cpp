// Bodies without moment about an axis that nothing holds are refused by name; others run.
#include "core/open_spins.h"

#include <gmock/gmock.h>

#include "core/input_error.h"
#include "tests/support/momentary_spin.h"
#include "tests/support/random_model.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Slender, without moment along its axis, which is turned by A in its frame.
Scene rod(const Matrix3& A = Matrix3::Identity()) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body body;
  body.name = "rod", body.mass = 1, body.position = {0.5, 0, 0}, body.orientation = A.transpose();
  body.inertia = A * Vector3(0, 1.0 / 12, 1.0 / 12).asDiagonal() * A.transpose();
  scene.bodies.push_back(body);
  return scene;
}
Scene held(Scene scene, JointType type, const Vector3& point, const Vector3& axis = Vector3::UnitY()) {
  Joint joint;
  joint.type = type, joint.j = 0, joint.point = point, joint.axis = joint.axis_i = axis;
  joint.axis_j = axis.unitOrthogonal();
  scene.joints.push_back(joint);
  return scene;
}
std::string found(const Scene& scene) {
  return open_spin(compile(scene));
}

TEST(OpenSpins, of_rods_on_balls_are_found_and_refused) {
  Random random(41);
  for (const Matrix3& A : {Matrix3(Matrix3::Identity()), random.rotation(), random.rotation()}) {
    EXPECT_THAT(found(rod(A)), HasSubstr("body 'rod' has no moment of inertia about the axis"));
    const Scene ball = held(rod(A), JointType::spherical, {0, 0, 0});
    EXPECT_THAT(found(ball), HasSubstr("no constraint holds it about that"));
    EXPECT_THROW((void)run(ball, controlled("dop853", "rA", 1e-8, 0.1, 0.1)), InputError);
    EXPECT_THAT(found(held(ball, JointType::spherical, {1, 0, 0})), HasSubstr("give it a small moment there"));
    EXPECT_THAT(found(held(rod(A), JointType::revolute, {0, 0, 0}, {1, 0, 0})), HasSubstr("no moment"));
  }
}

// However its frame is turned: a rounded orientation makes of what does not hold it 1e-17 that does.
TEST(OpenSpins, at_the_start_alone_are_refused_in_every_formulation) {
  Random random(43);
  for (const Matrix3& A : {Matrix3(Matrix3::Identity()), random.rotation(), random.rotation()})
    for (const FormulationEntry& formulation : formulations()) {
      SCOPED_TRACE(formulation.name);
      Scene scene = rod();
      spin_at_the_start(scene, 0);
      Body& body = scene.bodies[0];
      Constraint& rope = scene.constraints[0];
      body.orientation = A.transpose(), body.inertia = (A * body.inertia * A.transpose()).eval();
      rope.s_j = A * rope.s_j;
      const Settings settings = controlled("dop853", std::string(formulation.name), 1e-8, 0.1, 0.1);
      const Recorded refused = run(scene, settings);
      EXPECT_EQ(refused.outcome.status.failure, Failure::singular_matrix);
      EXPECT_THAT(refused.outcome.status.message, HasSubstr("; give it a small moment there"));
      body.inertia += 1e-3 * Matrix3::Identity();
      EXPECT_TRUE(run(scene, settings).outcome.status.ok());
    }
}

// Point masses that are fixed to one another on the axis of a hinge: none of them spins by itself.
TEST(OpenSpins, of_several_bodies_together_are_refused_and_named) {
  Random random(44);
  for (const Matrix3& A : {Matrix3(Matrix3::Identity()), random.rotation()}) {
    Scene points = rod(A);
    points.bodies[0].position.setZero();
    for (const double at : {1.0, 2.0}) {
      Body body = points.bodies[0];
      body.name = fmt::format("point {}", at), body.position = {0, at, 0};
      points.bodies.push_back(body);
    }
    for (Body& body : points.bodies) body.inertia.setZero();
    points = held(points, JointType::revolute, {0, 0, 0});
    for (int i = 0; i < 2; ++i) {
      Joint joint;
      joint.type = JointType::fixed, joint.i = i, joint.j = i + 1, joint.point = points.bodies[index(i + 1)].position;
      points.joints.push_back(joint);
    }
    for (const FormulationEntry& formulation : formulations()) {
      SCOPED_TRACE(formulation.name);
      const Settings settings = controlled("dop853", std::string(formulation.name), 1e-8, 0.1, 0.1);
      const Recorded refused = run(points, settings);
      EXPECT_EQ(refused.outcome.status.message,
                "at t = 0 s the linear system is singular: body 'rod' (/bodies/0) and body 'point 1' (/bodies/1) and 1 "
                "more have no moment of inertia along a turn of theirs that the constraints leave free in the initial "
                "pose; give one of them a small moment there, or start from another pose");
      Scene heavy = points;
      heavy.bodies[2].inertia = 1e-3 * Matrix3::Identity();
      EXPECT_TRUE(run(heavy, settings).outcome.status.ok());
    }
  }
}

TEST(OpenSpins, of_point_masses_are_found) {
  Scene point = rod();
  point.bodies[0].inertia.setZero();
  EXPECT_THAT(found(held(point, JointType::spherical, {0, 0, 0})), HasSubstr("no moment"));
  EXPECT_THAT(found(held(point, JointType::fixed, {0, 0, 0})), IsEmpty());
}

TEST(OpenSpins, that_are_held_are_not) {
  Random random(42);
  for (const Matrix3& A : {Matrix3(Matrix3::Identity()), random.rotation()})
    for (const Scene& scene : {held(rod(A), JointType::revolute, {0, 0, 0}), held(rod(A), JointType::fixed, {0, 0, 0}),
                               held(rod(A), JointType::spherical, {0, 0.1, 0})}) {
      EXPECT_THAT(found(scene), IsEmpty());
      EXPECT_TRUE(run(scene, controlled("dop853", "rA", 1e-8, 0.1, 0.1)).outcome.status.ok());
    }
}

}  // namespace
}  // namespace poinsot::test
