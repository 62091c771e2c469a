// From a scene to rows: how many rows of which type each joint has, and that they hold at the initial pose, whatever
// it is.
#include "core/model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <map>

#include "core/scene_reader.h"
#include "tests/support/random_model.h"
#include "tests/support/row_definitions.h"

namespace poinsot::test {
namespace {

std::vector<BodyState> initial_poses(const Model& model) {
  std::vector<BodyState> poses;
  for (const Body& body : model.bodies) {
    BodyState& pose = poses.emplace_back();
    pose.r = body.position;
    pose.A = body.orientation;
  }
  return poses;
}

Matrix3 turn(double angle, const Vector3& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Scene two_bodies(Random& random) {
  Scene scene;
  for (const char* name : {"a", "b"}) {
    Body& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    body.inertia = Matrix3::Identity();
    body.position = random.vector();
    body.orientation = random.rotation();
  }
  return scene;
}

// Of the rows' derivatives with respect to the motion of one body from the initial pose, by central differences.
Eigen::Index rank(const Model& model, std::size_t body) {
  const std::vector<BodyState> poses = initial_poses(model);
  Eigen::MatrixXd gradient(static_cast<Eigen::Index>(model.rows.size()), 6);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto at = [&](const Row& row, double step) {
      std::vector<BodyState> moved = poses;
      if (k < 3) moved[body].r[k] += step;
      if (k >= 3) moved[body].A *= turn(step, Vector3::Unit(k - 3));
      return asked(row, moved, 0);
    };
    constexpr double kStep = 1e-5;
    for (Eigen::Index r = 0; r < gradient.rows(); ++r) {
      const Row& row = model.rows[static_cast<std::size_t>(r)];
      gradient(r, k) = (at(row, kStep) - at(row, -kStep)) / (2 * kStep);
    }
  }
  return Eigen::FullPivLU<Eigen::MatrixXd>(gradient).setThreshold(1e-4).rank();
}

constexpr std::pair<int, int> kPairs[] = {{kGround, 0}, {0, kGround}, {0, 1}, {1, 0}};

struct JointCase {
  JointType type;
  const char* name;
  std::map<RowType, int> rows;  // the paper's Table 1
  int free_turns, free_slides;  // motions it allows about and along its axis
};
const JointCase kJoints[] = {
    {JointType::revolute, "revolute", {{RowType::CD, 3}, {RowType::DP1, 2}}, 1, 0},
    {JointType::spherical, "spherical", {{RowType::CD, 3}}, 1, 0},
    {JointType::universal, "universal", {{RowType::CD, 3}, {RowType::DP1, 1}}, 0, 0},
    {JointType::cylindrical, "cylindrical", {{RowType::DP1, 2}, {RowType::DP2, 2}}, 1, 1},
    {JointType::translational, "translational", {{RowType::DP1, 3}, {RowType::DP2, 2}}, 0, 1},
    {JointType::fixed, "fixed", {{RowType::CD, 3}, {RowType::DP1, 3}}, 0, 0},
};

TEST(Model, expands_joints_by_table_1) {
  constexpr unsigned kSeed = 11;
  Random random(kSeed);
  for (const JointCase& c : kJoints) {
    for (const auto& [i, j] : kPairs) {
      Scene scene = two_bodies(random);
      Joint& joint = scene.joints.emplace_back();
      joint.name = "it";
      joint.type = c.type;
      joint.i = i, joint.j = j;
      joint.point = random.vector();
      joint.axis = random.unit();
      joint.axis_i = random.unit();
      joint.axis_j = joint.axis_i.cross(random.unit()).normalized();
      const Model model = compile(scene);
      const std::string where = fmt::format("{} between {} and {}, seed {}", c.name, i, j, kSeed);

      std::map<RowType, int> rows;
      for (const Row& row : model.rows) ++rows[row.type];
      EXPECT_EQ(rows, c.rows) << where;
      ASSERT_EQ(model.groups.size(), 1U);
      EXPECT_EQ(model.groups[0].rows, static_cast<int>(model.rows.size()));
      EXPECT_EQ(model.groups[0].type, c.name);

      std::vector<BodyState> poses = initial_poses(model);
      for (const Row& row : model.rows) EXPECT_NEAR(asked(row, poses, 0), 0, 1e-14) << where;
      const BodyState on_j = j == kGround ? BodyState() : poses[static_cast<std::size_t>(j)];
      EXPECT_LT((on_j.r + on_j.A * model.groups[0].point_j - joint.point).norm(), 1e-14) << where;

      EXPECT_EQ(rank(model, static_cast<std::size_t>(i == kGround ? j : i)), model.groups[0].rows) << where;

      // The motions it allows: a body turns about, and slides along, the axis.
      BodyState& moved = poses[static_cast<std::size_t>(i == kGround ? j : i)];
      const BodyState initial = moved;
      const auto largest = [&](double angle, double distance) {
        const Matrix3 R = turn(angle, joint.axis);
        moved.r = joint.point + R * (initial.r - joint.point) + distance * joint.axis;
        moved.A = R * initial.A;
        double result = 0;
        for (const Row& row : model.rows) result = std::max(result, std::abs(asked(row, poses, 0)));
        return result;
      };
      if (c.type != JointType::universal) {
        EXPECT_EQ(largest(0.7, 0) < 1e-13, c.free_turns == 1) << where;
        EXPECT_EQ(largest(0, 0.7) < 1e-13, c.free_slides == 1) << where;
      }
    }
  }
}

TEST(Model, angle_driver_turns_body_j_about_an_axis_of_body_i) {
  constexpr unsigned kSeed = 12;
  Random random(kSeed);
  for (const auto& [i, j] : kPairs) {
    Scene scene = two_bodies(random);
    Driver& driver = scene.drivers.emplace_back();
    driver.type = DriverType::angle;
    driver.i = i, driver.j = j;
    driver.axis = random.unit();
    driver.value = Expression::parse("3*t");
    const Model model = compile(scene);
    ASSERT_EQ(model.rows.size(), 1U);
    const Row& row = model.rows[0];
    EXPECT_EQ(row.type, RowType::angle);
    EXPECT_NEAR((row.a_i.cross(row.b_i) - driver.axis).norm(), 0, 1e-15);

    std::vector<BodyState> poses = initial_poses(model);
    EXPECT_NEAR(asked(row, poses, 0), 0, 1e-14);
    const Matrix3 A_i = i == kGround ? Matrix3::Identity() : poses[static_cast<std::size_t>(i)].A;
    const Vector3 axis = A_i * driver.axis;
    for (const double t : {0.1, 0.5, 1.0, 2.0}) {
      std::vector<BodyState> turned = poses;
      // Turning i backwards about the axis is turning j forwards, seen from i.
      Matrix3& A = turned[static_cast<std::size_t>(j == kGround ? i : j)].A;
      A = turn(j == kGround ? -3 * t : 3 * t, axis) * A;
      EXPECT_NEAR(asked(row, turned, t), 0, 1e-14) << "seed " << kSeed;
      EXPECT_NEAR(asked(row, turned, t + 0.1), std::sin(-0.3), 1e-13) << "seed " << kSeed;
    }
  }
}

TEST(Model, distance_driver_is_a_squared_distance) {
  Random random(13);
  Scene scene = two_bodies(random);
  scene.bodies[0].position = {3, 4, 0};
  Driver& driver = scene.drivers.emplace_back();
  driver.type = DriverType::distance;
  driver.j = 0;
  driver.value = Expression::parse("5 + t");
  const Model model = compile(scene);
  EXPECT_EQ(model.rows.at(0).type, RowType::D);
  EXPECT_TRUE(model.rows[0].squared);
  EXPECT_NEAR(asked(model.rows[0], initial_poses(model), 0), 0, 1e-14);
}

TEST(Model, torsion_springs_start_at_angle_zero) {
  Random random(13);
  Scene scene = two_bodies(random);
  TorsionSpring spring;
  spring.i = 0, spring.j = 1;
  spring.axis = random.unit();
  scene.forces.emplace_back(spring);
  const Model model = compile(scene);
  const TorsionElement& torsion = model.torsions.at(0);
  const Vector3 c = scene.bodies[0].orientation.transpose() * scene.bodies[1].orientation * torsion.c_j;  // in i
  EXPECT_NEAR(c.dot(torsion.a_i), 1, 1e-15);
  EXPECT_NEAR(c.dot(torsion.b_i), 0, 1e-15);
  EXPECT_NEAR((torsion.a_i.cross(torsion.b_i) - spring.axis).norm(), 0, 1e-15);
}

TEST(Model, speaks_of_rows_as_the_scene_does) {
  const Model model = compile(parse_scene(
      R"({"scene": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1,1,1], "position": [0,0,0]}],
          "constraints": [{"type": "CD", "bodies": ["ground", "a"], "c": [1,0,0], "s_i": [0,0,0], "s_j": [0,0,0]}],
          "joints": [{"type": "revolute", "bodies": ["ground", "a"], "point": [0,0,0], "axis": [0,0,1]}],
          "drivers": [{"type": "angle", "name": "motor", "bodies": ["ground", "a"], "axis": [0,0,1], "angle": "t"}]})",
      "case.json"));
  EXPECT_EQ(describe_row(model, 0), "constraint 'CD1'");
  EXPECT_EQ(describe_row(model, 4), "joint 'revolute1' (its row 4 of 5)");
  EXPECT_EQ(describe_row(model, 6), "driver 'motor'");
  EXPECT_THROW((void)describe_row(model, 7), std::logic_error);
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Group& group = model.groups[static_cast<std::size_t>(model.rows[k].group)];
    EXPECT_GE(static_cast<int>(k), group.first_row);
    EXPECT_LT(static_cast<int>(k), group.first_row + group.rows);
  }
}

struct ModelCase {
  const char* file;
  int bodies, rows;
  double violation;  // of the initial pose: the study's own data have few digits
};
class ModelFiles : public testing::TestWithParam<ModelCase> {};

TEST_P(ModelFiles, hold_at_their_initial_pose) {
  const ModelCase& c = GetParam();
  const Model model = compile(read_scene(fmt::format(POINSOT_SOURCE_DIR "/models/{}.json", c.file)));
  EXPECT_EQ(static_cast<int>(model.bodies.size()), c.bodies);
  EXPECT_EQ(static_cast<int>(model.rows.size()), c.rows);
  const std::vector<BodyState> poses = initial_poses(model);
  double largest = 0;
  for (const Row& row : model.rows) {
    largest = std::max(largest, std::abs(asked(row, poses, 0)));
    if (row.alternate) {
      Row other = row;
      other.a_i = row.alternate->a_i, other.a_j = row.alternate->a_j, other.f = row.alternate->f;
      largest = std::max(largest, std::abs(asked(other, poses, 0)));
    }
  }
  EXPECT_LE(largest, c.violation);
}

INSTANTIATE_TEST_SUITE_P(
    Model, ModelFiles,
    testing::Values(ModelCase{"single_pendulum", 1, 6, 1e-8}, ModelCase{"single_pendulum_free", 1, 5, 1e-8},
                    ModelCase{"single_pendulum_joints", 1, 6, 1e-14}, ModelCase{"double_pendulum", 2, 10, 1e-14},
                    ModelCase{"double_pendulum_joints", 2, 10, 1e-14}, ModelCase{"four_link", 3, 18, 1e-2},
                    ModelCase{"four_link_haug", 3, 18, 1e-14}, ModelCase{"four_link_joints", 3, 18, 1e-14},
                    ModelCase{"slider_crank", 3, 18, 1e-6}, ModelCase{"slider_crank_haug", 3, 18, 1e-14},
                    ModelCase{"slider_crank_joints", 3, 18, 1e-14}, ModelCase{"heavy_top", 1, 3, 1e-14},
                    ModelCase{"free_body", 1, 0, 0}, ModelCase{"simple_pendulum", 1, 5, 1e-14},
                    ModelCase{"double_four_bar", 5, 35, 1e-14}, ModelCase{"andrews", 7, 50, 1e-14},
                    ModelCase{"knife_edge", 1, 4, 1e-14}),
    [](const auto& file) { return std::string(file.param.file); });

}  // namespace
}  // namespace poinsot::test
