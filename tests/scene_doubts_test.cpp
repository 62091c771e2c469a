// What is told of a scene though it is sound, and what is not.
#include "core/scene_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <variant>

#include "core/input_error.h"
#include "core/so3.h"
#include "integrators/simulate.h"

namespace poinsot {
namespace {

using testing::ElementsAre;

Scene two_rods() {
  Scene scene;
  for (const char* name : {"a", "b"}) {
    Body body;
    body.name = name;
    body.mass = 1;
    body.inertia = Vector3(1e-3, 0.083, 0.083).asDiagonal();
    body.position = {scene.bodies.empty() ? 0.5 : 1.5, 0, 0};
    scene.bodies.push_back(body);
  }
  Joint hinge;
  hinge.i = 0, hinge.j = 1;
  hinge.point = {1, 0, 0}, hinge.axis = {0, 1, 0};
  scene.joints.push_back(hinge);
  return scene;
}

std::vector<std::string> doubts(const Scene& scene) {
  return scene_doubts(compile(scene));
}

TEST(SceneDoubts, are_none_of_rods_and_planar_bodies) {
  Scene scene = two_rods();
  scene.bodies[0].inertia = Vector3(0, 2, 2).asDiagonal();
  scene.bodies[1].inertia = Vector3(0.3333, 0.6667, 1).asDiagonal();
  EXPECT_THAT(doubts(scene), ElementsAre());
}

TEST(SceneDoubts, are_moments_that_no_body_has) {
  Scene scene = two_rods();
  scene.bodies[1].inertia << 2, 0.5, 0, 0.5, 2, 0, 0, 0, 5;
  EXPECT_THAT(doubts(scene), ElementsAre("body 'b' has the principal moments 1.5, 2.5 and 5, and no body has one that "
                                         "exceeds the sum of the others"));
  scene.bodies[0].inertia = Vector3(4, 2, 0).asDiagonal();
  EXPECT_THAT(doubts(scene), ElementsAre(testing::MatchesRegex("body 'a' .*; 1 more like it")));
}

TEST(SceneDoubts, are_springs_that_push_from_one_point) {
  Scene scene = two_rods();
  Spring spring;
  spring.name = "strut", spring.i = 0, spring.j = 1, spring.s_i = {0.5, 0, 0}, spring.s_j = {-0.5, 0, 0};
  spring.stiffness = 100;
  scene.forces = {spring};
  EXPECT_THAT(doubts(scene), ElementsAre());
  spring.length = 0.5;
  scene.forces = {spring};
  EXPECT_THAT(doubts(scene), ElementsAre("force 'strut' is 50 N between ends that are at one point, where it has no "
                                         "direction: it acts in none there; start with its ends apart"));
  spring.s_j.y() = 1e-6;
  scene.forces = {spring};
  EXPECT_THAT(doubts(scene), ElementsAre());
}

TEST(SceneDoubts, are_masses_and_lengths_far_apart) {
  Scene scene = two_rods();
  scene.bodies[1].mass = 1e6;
  EXPECT_THAT(doubts(scene), ElementsAre("masses are six orders of magnitude apart: 1 kg of 'a', 1e+06 kg of 'b'"));
  scene = two_rods();
  scene.bodies[1].position[0] = 1 + 0.4e-6;
  EXPECT_THAT(doubts(scene),
              ElementsAre("lengths are six orders of magnitude apart: 'b' is held 4e-07 m from its centre "
                          "of mass, 'a' 0.5 m"));
  scene.bodies[1].position[0] = 1 + 1e-15;  // the rounding of a joint at the centre of mass
  EXPECT_THAT(doubts(scene), ElementsAre());
}

TEST(SceneDoubts, are_axes_in_another_frame_than_their_hinge) {
  using std::numbers::pi;
  Scene scene = two_rods();
  for (Body& body : scene.bodies) body.orientation = exp_so3<double>({pi / 2, 0, 0});
  Driver motor;
  motor.type = DriverType::angle;
  motor.name = "motor";
  motor.i = 0, motor.j = 1;
  motor.axis = {0, 1, 0};  // that of the hinge, which is global
  scene.drivers.push_back(motor);
  const std::string said =
      "driver 'motor' turns about an axis 1.57 rad from that of joint 'revolute1' on the same bodies: it is taken in "
      "the frame of 'a', where a joint's \"axis\" is global";
  EXPECT_THAT(doubts(scene), ElementsAre(said));
  TorsionSpring spring;
  spring.i = 1, spring.j = 0;
  spring.axis = {0, 2, 0.5};
  scene.forces.emplace_back(spring);
  EXPECT_THAT(doubts(scene), ElementsAre(said + "; 1 more like it"));
  scene.drivers[0].axis = std::get<TorsionSpring>(scene.forces[0]).axis = {0, 1e-4, -1};  // where the axis is
  EXPECT_THAT(doubts(scene), ElementsAre());
  scene.joints[0].type = JointType::spherical;
  scene.drivers[0].axis = {1, 1, 1};
  EXPECT_THAT(doubts(scene), ElementsAre());
}

TEST(SceneDoubts, are_numbers_whose_squares_overflow) {
  Scene scene = two_rods();
  scene.gravity[2] = -1e200;
  const Model model = compile(scene);
  EXPECT_EQ(overflowing(model), "the scene has a gravity of 1e+200, whose square is beyond the numbers of a computer");
  EXPECT_THAT(scene_doubts(model), ElementsAre(overflowing(model)));
  scene.gravity[2] = -1e150;
  EXPECT_EQ(overflowing(compile(scene)), "");
  PointForce push;
  push.name = "push", push.body = 0;
  push.force[1] = Expression::parse("exp(500*t)");
  scene.forces.emplace_back(push);
  EXPECT_EQ(overflowing(compile(scene), 0.7), "");
  EXPECT_EQ(overflowing(compile(scene), 0.8),
            "force 'push' has a component of 5.22e+173, whose square is beyond the numbers of a computer");
}

// A hinge so far off turned its rod about another axis than its own, and bore moments that are no numbers, in runs that
// ended well: rows are compared by squares.
TEST(SceneDoubts, lengths_whose_squares_overflow_are_refused) {
  Scene scene = two_rods();
  EXPECT_EQ(overflowing_length(compile(scene)), "");
  scene.joints[0].i = kGround, scene.joints[0].name = "hinge";
  Torque push;
  push.body = 1;
  push.torque[0] = Expression(1);
  scene.forces.emplace_back(push);
  Settings settings;
  settings.end = 0.1;
  const auto refusal = [&]() -> std::string {
    try {
      (void)simulate(scene, settings, [](const Sample&) {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const char* method : {"auto", "rattle"}) {
    settings.integrator = method;
    scene.joints[0].point[0] = 1e150;
    EXPECT_EQ(refusal(), "");
    for (const double far : {1e160, 1e308}) {
      scene.joints[0].point[0] = far;
      EXPECT_NE(refusal().find("joint 'hinge' (/joints/0; its row 1 of 5) has a length of 1e+"), std::string::npos)
          << refusal();
    }
  }
  scene.joints.clear();
  scene.bodies[0].position[1] = 1e160;  // whom nothing holds
  EXPECT_EQ(refusal(), "");
}

TEST(SceneDoubts, directions_whose_products_overflow_are_refused) {
  for (const double length : {1e-12, 1.0, 1e12, 1e155, 1e308, 1e-160}) {
    Scene scene = two_rods();
    scene.joints.clear();
    Constraint& row = scene.constraints.emplace_back();
    row.name = "row", row.type = ConstraintType::DP1, row.j = 0, row.a_i = {1, 0, 0}, row.a_j = {0, length, 0};
    Settings settings;
    settings.end = 1e-3;
    if (length > 1e-75 && length < 1e75) {
      EXPECT_TRUE(simulate(scene, settings, [](const Sample&) {}).status.ok()) << length;
      continue;
    }
    try {
      (void)simulate(scene, settings, [](const Sample&) {});
      ADD_FAILURE() << length << " is not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("constraint 'row' (/constraints/0) has a direction of length 1e"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace poinsot
