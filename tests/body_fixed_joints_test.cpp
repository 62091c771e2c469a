// Joints in the frames of their bodies: the mechanism they make is that of the same joints given globally at a pose
// that fits, and is found again from poses that do not.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/input_error.h"
#include "core/joint_frames.h"
#include "core/scene_types.h"
#include "core/scene_writer.h"
#include "integrators/start/closure.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rough_pose.h"
#include "tests/support/loops.h"
#include "tests/support/random_model.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

constexpr std::pair<int, int> kBodyPairs[] = {{kGround, 0}, {0, kGround}, {0, 1}, {1, 0}};

Scene two_loose_bodies(Random& random) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (const char* name : {"a", "b"}) {
    Body& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    body.inertia = Vector3(1, 2, 2.5).asDiagonal();
    body.position = random.vector();
    body.orientation = random.rotation();
    body.angular_velocity = random.vector();
  }
  return scene;
}

Joint random_joint(JointType type, int i, int j, Random& random) {
  Joint joint;
  joint.type = type;
  joint.i = i, joint.j = j;
  joint.point = random.vector();
  joint.axis = joint.axis_i = random.unit();
  joint.axis_j = joint.axis_i.cross(random.unit()).normalized();
  return joint;
}

// With the frames, of some other length, in the place of point and axes.
Scene body_fixed(Scene scene) {
  for (Joint& joint : scene.joints) {
    Joint fixed;
    fixed.name = joint.name, fixed.type = joint.type, fixed.i = joint.i, fixed.j = joint.j;
    fixed.frames = complete_frames(joint, scene.bodies);
    if (joint.type != JointType::spherical) {
      fixed.frames->axis_i *= 3, fixed.frames->axis_j *= 0.2;
      fixed.frames->a_i *= 2, fixed.frames->a_j *= 5;
    }
    joint = fixed;
  }
  for (Driver& driver : scene.drivers) {
    if (driver.type != DriverType::angle) continue;
    const AngleFrame frame = angle_frame(driver, scene.bodies, Vector3::Zero());
    driver.a_i = 2 * frame.a_i, driver.a_j = 3 * frame.a_j;
  }
  return scene;
}

InitialState start_of(const Scene& scene, Assembly assembly = Assembly::small) {
  Settings settings;
  settings.assembly = assembly;
  return find_initial_state(std::make_shared<const Model>(compile(scene)), settings);
}

std::string refused(const Scene& scene, Assembly assembly = Assembly::small) {
  try {
    (void)start_of(scene, assembly);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BodyFixedJoints, MoveAsGlobalOnesDo) {
  constexpr unsigned kSeed = 21;
  Random random(kSeed);
  for (const auto& [name, type] : kJointTypes) {
    for (const auto& [i, j] : kBodyPairs) {
      Scene scene = two_loose_bodies(random);
      scene.joints = {random_joint(type, i, j, random)};
      const Settings settings = controlled("dop853", "rA", 1e-6, 0.2, 0.1);
      const Distance d = distance(motion(body_fixed(scene), settings), motion(scene, settings));
      EXPECT_LT(d.largest(), 1e-12) << fmt::format("{} between {} and {}, seed {}: ", name, i, j, kSeed) << d;
    }
  }
}

TEST(BodyFixedJoints, AreWrittenAsTheyAreRead) {
  Random random(26);
  Scene scene = two_loose_bodies(random);
  for (const auto& [name, type] : kJointTypes) {
    scene.joints.push_back(random_joint(type, 0, 1, random));
    scene.joints.back().name = name;
  }
  scene = body_fixed(scene);
  const Scene read = parse_scene(to_json(scene), "written");
  ASSERT_EQ(read.joints.size(), scene.joints.size());
  for (std::size_t k = 0; k < read.joints.size(); ++k) {
    const JointFrames &x = read.joints[k].frames.value(), &y = scene.joints[k].frames.value();
    for (const auto member : {&JointFrames::s_i, &JointFrames::s_j, &JointFrames::axis_i, &JointFrames::axis_j,
                              &JointFrames::a_i, &JointFrames::a_j})
      EXPECT_EQ(x.*member, y.*member) << scene.joints[k].name;
  }
}

TEST(BodyFixedJoints, AngleDriversAndTorsionSpringsStartWhereTheirDirectionsSay) {
  Random random(22);
  Scene scene = two_loose_bodies(random);
  scene.joints = {random_joint(JointType::revolute, 0, 1, random)};
  const Vector3 axis = scene.bodies[0].orientation.transpose() * scene.joints[0].axis;
  TorsionSpring spring;
  spring.i = 0, spring.j = 1, spring.axis = axis, spring.stiffness = 3, spring.angle = 0.3;
  scene.forces = {spring};
  Scene other = scene;
  const AngleFrame frame = angle_frame(spring, scene.bodies, Vector3::Zero());
  constexpr double kZero = 0.7;  // the angle at the initial pose
  spring.a_i = std::cos(kZero) * frame.a_i - std::sin(kZero) * frame.b_i, spring.a_j = frame.a_j, spring.angle += kZero;
  other.forces = {spring};
  const Settings settings = controlled("dop853", "rA", 1e-6, 0.2, 0.1);
  EXPECT_LT(distance(motion(other, settings), motion(scene, settings)).largest(), 1e-12);

  Driver driver;
  driver.i = 0, driver.j = 1, driver.axis = axis, driver.value = Expression::parse("sin(t)");
  scene.drivers = other.drivers = {driver};
  other.drivers[0].a_i = spring.a_i, other.drivers[0].a_j = spring.a_j;
  other.drivers[0].value = Expression::parse("0.7 + sin(t)");
  EXPECT_LT(distance(motion(other, settings), motion(scene, settings)).largest(), 1e-12);
}

// Bodies thrown about: joints close the right way round, from almost half a turn off, with the reference directions
// where they belong.
TEST(BodyFixedJoints, CloseTheRightWayRound) {
  Random random(23);
  for (const auto& [name, type] : kJointTypes) {
    for (const auto& [i, j] : kBodyPairs) {
      for (const double angle : {0.5, 1.8, 3.0}) {
        Scene scene = two_loose_bodies(random);
        scene.joints = {random_joint(type, i, j, random)};
        scene = body_fixed(scene);
        Body& body = scene.bodies[static_cast<std::size_t>(std::max(i, j))];
        body.orientation = body.orientation * Eigen::AngleAxisd(angle, random.unit()).toRotationMatrix();
        body.position += random.vector();
        const InitialState start = start_of(scene);
        const std::string where = fmt::format("{} between {} and {}, {} rad off", name, i, j, angle);
        ASSERT_TRUE(start.status.ok()) << where << ": " << start.status.message;
        const Model model = compile(scene);
        const Gap gap = gaps(model, start.bodies).at(0);
        EXPECT_LT(std::max(gap.metres, gap.radians), 1e-11) << where;
        EXPECT_THAT(start.notices.at(0), HasSubstr("initial pose assembled: joint '" + std::string(name) + "1'"));
      }
    }
  }
}

// The gradients that lead there, against differences.
TEST(BodyFixedJoints, OpenPartsVaryAsTheySay) {
  Random random(24);
  for (const auto& [name, type] : kJointTypes) {
    Scene scene = two_loose_bodies(random);
    scene.joints = {random_joint(type, 0, 1, random)};
    Driver angle;
    angle.i = 0, angle.j = 1, angle.axis = random.unit(), angle.value = Expression(0.4);
    Driver length;
    length.type = DriverType::distance, length.i = 1, length.j = 0, length.s_i = random.vector();
    length.value = Expression(0.3);
    scene.drivers = {angle, length};
    const Model model = compile(body_fixed(scene));
    std::vector<BodyState> states = given_state(model);
    for (BodyState& state : states) {
      state.r += random.vector();
      state.A = Eigen::AngleAxisd(0.8, random.unit()).toRotationMatrix() * state.A;
    }
    const std::vector<OpenPart> parts = open_parts(model, states);
    for (std::size_t b = 0; b < 2; ++b) {
      for (int k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-6;
        const auto moved = [&](double by) {
          std::vector<BodyState> at = states;
          if (k < 3) at[b].r[k] += by;
          if (k >= 3) at[b].A = Eigen::AngleAxisd(by, Vector3::Unit(k - 3)).toRotationMatrix() * at[b].A;
          return open_parts(model, at);
        };
        const std::vector<OpenPart> ahead = moved(kStep), behind = moved(-kStep);
        for (std::size_t p = 0; p < parts.size(); ++p) {
          const Group& group = model.groups[static_cast<std::size_t>(parts[p].group)];
          const bool on_i = group.i == static_cast<int>(b);
          const double told =
              k < 3 ? (on_i ? -parts[p].g : parts[p].g)[k] : (on_i ? parts[p].on_i : parts[p].on_j)[k - 3];
          EXPECT_NEAR(told, (ahead[p].value - behind[p].value) / (2 * kStep), 1e-8) << name << ", part " << p;
        }
      }
    }
  }
}

// A mechanism without degrees of freedom has one pose near the one that is meant, from wherever it is sought.
TEST(BodyFixedJoints, AMechanismIsTheSameFromARoughPose) {
  const Scene scene = body_fixed(scene_of("four_link_joints"));
  Random random(25);
  for (int k = 0; k < 5; ++k) {
    Scene rough = scene;
    for (Body& body : rough.bodies) {
      body.position += 0.3 * random.vector();
      body.orientation = body.orientation * Eigen::AngleAxisd(0.3, random.unit()).toRotationMatrix();
    }
    const InitialState start = start_of(rough);
    ASSERT_TRUE(start.status.ok()) << start.status.message;
    const Distance d = distance({{0, start.bodies, {}}}, {{0, start_of(scene).bodies, {}}});
    EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), 1e-10) << d;
  }
}

// A pose given to a few digits leaves redundant rows open; they are redundant all the same.
TEST(BodyFixedJoints, RedundantRowsAreSoFromPosesThatAreOffByLittle) {
  Random random(27);
  for (const int links : {4, 5})
    for (const double off : {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
      const Scene scene = body_fixed(loop({.links = links}));
      const InitialState exact = start_of(scene);
      Scene given = scene;
      for (Body& body : given.bodies) {
        body.position += off * random.vector();
        body.orientation = body.orientation * Eigen::AngleAxisd(off, random.unit()).toRotationMatrix();
      }
      const InitialState start = start_of(given);
      ASSERT_TRUE(start.status.ok()) << start.status.message;
      EXPECT_EQ(start.rank.aside.size(), exact.rank.aside.size()) << links << ' ' << off;
      EXPECT_EQ(start.rank.doubt.row, -1) << links << ' ' << off;
      const Distance d = distance({{0, start.bodies, {}}}, {{0, exact.bodies, {}}});
      EXPECT_LT(std::max(d.r, d.A), 100 * off) << links;
      EXPECT_LT(violation(std::make_shared<const Model>(compile(scene)), start.bodies).position, 1e-13) << off;
    }
}

Scene driven_pendulum(const char* angle) {
  Scene scene = scene_of("single_pendulum_joints");
  Driver motor;
  motor.name = "motor";
  motor.j = 0, motor.axis = Vector3::UnitX(), motor.value = Expression::parse(angle);
  scene.drivers = {motor};
  return scene;
}

TEST(BodyFixedJoints, ADriverHalfATurnOffIsRefusedOrTurned) {
  const Scene scene = driven_pendulum("pi + t");
  EXPECT_EQ(refused(scene),
            "driver 'motor' asks for an angle of 3.14159 rad at t = 0, where the initial pose has 0 rad; correct the "
            "scene, or have it turned there with `poinsot run --assemble`, whose --save-state keeps it");
  EXPECT_THAT(refused(scene, Assembly::never), HasSubstr("driver 'motor' asks for an angle of 3.14159 rad"));
  const InitialState start = start_of(scene, Assembly::always);
  ASSERT_TRUE(start.status.ok()) << start.status.message;
  const Matrix3 turned = Eigen::AngleAxisd(M_PI, Vector3::UnitX()).toRotationMatrix() * scene.bodies[0].orientation;
  EXPECT_LT((start.bodies[0].A - turned).norm(), 1e-12);
  EXPECT_THAT(start.notices, ::testing::Contains(HasSubstr("had to turn by 3.14 rad")));
  EXPECT_EQ(refused(driven_pendulum("2*pi + t")), "accepted");
}

TEST(BodyFixedJoints, WhatCannotCloseIsNamedWithWhatIsLeft) {
  Scene scene = body_fixed(scene_of("single_pendulum_joints"));
  scene.drivers.clear();
  Constraint far;
  far.name = "far";
  far.type = ConstraintType::D;
  far.j = 0;
  far.s_i = {0, 1, 0};
  far.f = Expression(25);
  scene.constraints = {far};
  EXPECT_THAT(refused(scene), ::testing::MatchesRegex("no position near the given pose closes the mechanism: .* stays "
                                                      "open by [0-9.]* m.*, at the given pose constraint 'far' is by "
                                                      ".* m; .*"));
}

TEST(BodyFixedJoints, AJointFarFromItsBodiesIsTold) {
  Scene scene = scene_of("double_pendulum_joints");
  EXPECT_THAT(start_of(scene).notices, Not(::testing::Contains(HasSubstr("far from its bodies"))));
  scene.joints[1].point *= 10;
  EXPECT_THAT(start_of(scene).notices, ::testing::Contains(HasSubstr("is far from its bodies: ")));
  scene = scene_of("single_pendulum_joints");
  scene.drivers.clear();
  EXPECT_THAT(start_of(scene).notices, Not(::testing::Contains(HasSubstr("far from its bodies"))));
  scene.joints[0].point += 10 * scene.bodies[0].position;
  EXPECT_THAT(start_of(scene).notices,
              ::testing::Contains(HasSubstr("the body's size and its way from the origin are at "
                                            "most")));
}

// 1 m at 1e8 m, where a position is known to 2e-8 of it.
TEST(BodyFixedJoints, AMechanismFarFromTheOriginIsTold) {
  for (const double away : {1e6, 1e8}) {
    Scene scene = scene_of("double_pendulum_joints");
    for (Body& body : scene.bodies) body.position.x() += away;
    for (Joint& joint : scene.joints) joint.point.x() += away;
    const auto told = ::testing::Contains(HasSubstr("from the origin and"));
    if (away < 1e7)
      EXPECT_THAT(start_of(scene).notices, Not(told));
    else
      EXPECT_THAT(start_of(scene).notices, told);
  }
  Scene free;  // whose rounding reaches no other
  free.bodies.emplace_back().position = {1e12, 0, 0};
  free.bodies[0].name = "stone", free.bodies[0].mass = 1;
  free.bodies[0].inertia = Matrix3::Identity();
  EXPECT_THAT(start_of(free).notices, ::testing::IsEmpty());
}

}  // namespace
}  // namespace poinsot::test
