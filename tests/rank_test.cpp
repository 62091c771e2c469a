// Degrees of freedom, dependent rows with what they depend on, singular positions.
#include "integrators/start/rank.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/body_sizes.h"
#include "core/index.h"
#include "core/scene_generator.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/row_space.h"
#include "tests/support/hubs.h"
#include "tests/support/large_scenes.h"
#include "tests/support/scene_transform.h"

namespace poinsot::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

RankAnalysis analyze(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  return analyze_rank(model, given_state(*model), RankNames::all);
}

Scene free_bodies(int count) {
  Scene scene;
  for (int b = 0; b < count; ++b) {
    Body& body = scene.bodies.emplace_back();
    body.name = fmt::format("body {}", b);
    body.mass = 1 + b;
    body.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
    body.position = {0.3 * b, 1, -0.2 * b};
  }
  return scene;
}

Joint joint(JointType type, int i, int j, const Vector3& point, const Vector3& axis = Vector3::UnitZ()) {
  Joint x;
  x.type = type;
  x.i = i, x.j = j;
  x.point = point;
  x.axis = axis;
  x.axis_i = Vector3::UnitX(), x.axis_j = Vector3::UnitY();
  return x;
}

TEST(Rank, OfEveryModel) {
  const struct {
    const char* model;
    int freedoms, dependent;
  } expected[] = {
      {"single_pendulum", 0, 0},
      {"single_pendulum_joints", 0, 0},
      {"single_pendulum_free", 1, 0},
      {"double_pendulum", 2, 0},
      {"double_pendulum_joints", 2, 0},
      {"four_link", 0, 0},
      {"four_link_haug", 0, 0},
      {"four_link_joints", 0, 0},
      {"slider_crank", 0, 0},
      {"slider_crank_haug", 0, 0},
      {"slider_crank_joints", 0, 0},
      {"simple_pendulum", 1, 0},
      {"heavy_top", 3, 0},
      {"double_four_bar", 1, 6},
      {"andrews", 1, 9},
      {"free_body", 6, 0},
      {"knife_edge", 2, 0},
  };
  for (const auto& e : expected) {
    const RankAnalysis analysis = analyze(scene_of(e.model));
    EXPECT_EQ(analysis.degrees_of_freedom(), e.freedoms) << e.model;
    EXPECT_EQ(analysis.dependent.size(), static_cast<std::size_t>(e.dependent)) << e.model;
    EXPECT_FALSE(analysis.singular_position()) << e.model;
  }
}

TEST(Rank, OfEveryJointBetweenBodiesAndToGround) {
  constexpr std::pair<JointType, int> kRows[] = {{JointType::revolute, 5},      {JointType::spherical, 3},
                                                 {JointType::universal, 4},     {JointType::cylindrical, 4},
                                                 {JointType::translational, 5}, {JointType::fixed, 6}};
  for (const auto& [type, rows] : kRows) {
    for (int i : {kGround, 0}) {
      Scene scene = free_bodies(2);
      scene.joints = {joint(type, i, 1, {0.2, 0.1, 0.7})};
      const RankAnalysis analysis = analyze(scene);
      EXPECT_EQ(analysis.rank, rows) << static_cast<int>(type);
      EXPECT_EQ(analysis.degrees_of_freedom(), 12 - rows) << static_cast<int>(type);
    }
  }
}

TEST(Rank, WithoutRows) {
  const RankAnalysis analysis = analyze(free_bodies(3));
  EXPECT_EQ(analysis.variables, 18);
  EXPECT_EQ(analysis.rank, 0);
  EXPECT_EQ(analysis.degrees_of_freedom(), 18);
  EXPECT_THAT(analysis.dependent_rows(), IsEmpty());
}

TEST(Rank, VelocityRowsCount) {
  Scene scene = free_bodies(1);
  Constraint blade;
  blade.type = ConstraintType::pfaffian;
  blade.j = 0;
  blade.a_j = Vector3::UnitX();
  scene.constraints = {blade, blade};
  const RankAnalysis analysis = analyze(scene);
  EXPECT_EQ(analysis.degrees_of_freedom(), 5);
  EXPECT_THAT(analysis.dependent_rows(), ElementsAre(1));
}

Constraint coordinate(const Vector3& c) {
  Constraint row;
  row.type = ConstraintType::CD;
  row.j = 0;
  row.c = c;
  row.f = Expression(c.y());
  return row;
}

TEST(Rank, DependentRowsNameWhatTheyDependOn) {
  Scene scene = free_bodies(1);
  scene.constraints = {coordinate({1, 0, 0}), coordinate({0, 0, 1}), coordinate({0, 1, 0}), coordinate({2, -1, 0}),
                       coordinate({0, 0, -3})};
  const RankAnalysis analysis = analyze(scene);
  EXPECT_EQ(analysis.rank, 3);
  ASSERT_THAT(analysis.dependent_rows(), ElementsAre(3, 4));
  EXPECT_THAT(analysis.dependent[0].others, ElementsAre(0, 2));
  EXPECT_THAT(analysis.dependent[1].others, ElementsAre(1));
}

// A body on two hinges of one axis: the second adds nothing.
TEST(Rank, SecondHingeDependsOnTheFirst) {
  Scene scene = free_bodies(1);
  scene.joints = {joint(JointType::revolute, kGround, 0, {0, 0, 1}),
                  joint(JointType::revolute, kGround, 0, {0, 0, -1})};
  const RankAnalysis analysis = analyze(scene);
  EXPECT_EQ(analysis.degrees_of_freedom(), 1);
  EXPECT_THAT(analysis.dependent_rows(), ElementsAre(5, 6, 7, 8, 9));
  for (const Dependency& dependency : analysis.dependent) {
    EXPECT_THAT(dependency.others, Not(IsEmpty()));
    for (int other : dependency.others) EXPECT_LT(other, 5);
  }
}

// Two welded bodies: everything about the second weld is known from the first.
TEST(Rank, Grounded) {
  Scene scene = free_bodies(1);
  scene.joints = {joint(JointType::fixed, kGround, 0, {0, 0, 0}), joint(JointType::fixed, 0, kGround, {1, 2, 3})};
  const RankAnalysis analysis = analyze(scene);
  EXPECT_EQ(analysis.degrees_of_freedom(), 0);
  EXPECT_EQ(analysis.dependent.size(), 6u);
  EXPECT_FALSE(analysis.singular_position());
}

// Planar parallelogram: ground pivots (0, 0) and (2, 0), links of 1 m at the angle, coupler of 2 m. In space the plane
// is given thrice too often by four revolutes.
Scene planar_parallelogram(double angle) {
  Scene scene = free_bodies(3);
  const Vector3 link(std::cos(angle), std::sin(angle), 0), along(2, 0, 0), z = Vector3::UnitZ();
  scene.bodies[0].position = link / 2;
  scene.bodies[1].position = along + link / 2;
  scene.bodies[2].position = link + along / 2;
  scene.joints = {joint(JointType::revolute, kGround, 0, {0, 0, 0}, z),
                  joint(JointType::revolute, kGround, 1, along, z), joint(JointType::revolute, 0, 2, link, z),
                  joint(JointType::revolute, 1, 2, link + along, z)};
  return scene;
}

TEST(Rank, ParallelogramLyingFlatIsASingularPosition) {
  const RankAnalysis regular = analyze(planar_parallelogram(1));
  EXPECT_EQ(regular.degrees_of_freedom(), 1);
  EXPECT_EQ(regular.dependent.size(), 3u);
  EXPECT_FALSE(regular.singular_position());

  const RankAnalysis flat = analyze(planar_parallelogram(0));
  EXPECT_EQ(flat.rank_here, 16);
  EXPECT_EQ(flat.rank, 17);
  EXPECT_EQ(flat.degrees_of_freedom(), 1);
  EXPECT_EQ(flat.dependent.size(), 3u);
  EXPECT_TRUE(flat.singular_position());
}

// The bare DP1 driver where its directions are parallel: f = cos(angle) is stationary, its row vanishes.
TEST(Rank, ADriverWhoseRowVanishes) {
  Scene scene = scene_of("single_pendulum_joints");
  scene.drivers.clear();
  Constraint driver;
  driver.name = "driver";
  driver.i = 0;
  driver.a_i = Vector3::UnitX();
  driver.a_j = scene.bodies[0].orientation.col(0);
  driver.f = Expression(1);
  scene.constraints = {driver};
  const RankAnalysis analysis = analyze(scene);
  EXPECT_EQ(analysis.rank_here, 5);
  EXPECT_EQ(analysis.degrees_of_freedom(), 0);  // it holds the pendulum, if only to second order
  EXPECT_THAT(analysis.dependent_rows(), IsEmpty());
  ASSERT_EQ(analysis.singular.size(), 1u);
  EXPECT_EQ(analysis.singular[0].row, 0);
  EXPECT_THAT(analysis.singular[0].others, IsEmpty());
  EXPECT_FALSE(analysis.moves_on);
}

// The cost is that of the rows, not of their square or cube: seconds would become hours here.
TEST(Rank, OfManyBodies) {
  const RankAnalysis chain = analyze(find_scene_generator("chain")->make(3000));
  EXPECT_EQ(chain.degrees_of_freedom(), 3000);
  EXPECT_THAT(chain.dependent_rows(), IsEmpty());

  // Hinged to the ground at the far end as well: the plane is given once too often, and in the straight pose the length
  // is, too, which holds the chain to second order: singular there.
  Scene scene = find_scene_generator("chain")->make(1000);
  scene.joints.push_back(joint(JointType::revolute, 999, kGround, {0, 1000, 0}, Vector3::UnitX()));
  const RankAnalysis loop = analyze(scene);
  EXPECT_THAT(loop.dependent_rows(), ElementsAre(5000, 5003, 5004));
  for (const Dependency& dependency : loop.dependent) EXPECT_GE(dependency.others.size(), 1000u);
  ASSERT_EQ(loop.singular.size(), 1u);
  EXPECT_EQ(loop.singular[0].row, 5001);
}

// The hub is one by bodies that constrain nothing too often, and without its rows 204 of the others would be dependent,
// with them 199: above and below the 200 that null vectors are found for.
TEST(Rank, OfAHubBesideTheMostThatIsChosen) {
  constexpr int kTriangles = 52, kCouples = 60, kBodies = kTriangles + 2 * kCouples;
  Scene scene = hub(Hub::triangles, kTriangles - 1);
  const Scene free = free_bodies(kBodies);
  for (int b = kTriangles; b < kBodies; ++b)
    scene.bodies.emplace_back(free.bodies[index(b)]).position = {0.1 * b, 3, 1};
  for (int b = kTriangles; b < kBodies; b += 2) {
    scene.joints.push_back(joint(JointType::spherical, 0, b, {0.1 * b, 2, 0.5}));
    scene.joints.push_back(joint(JointType::spherical, 0, b + 1, {0.1 * b + 0.1, 2, 0.4}));
    scene.joints.push_back(joint(JointType::spherical, b, b + 1, {0.1 * b + 0.05, 3.2, 1.1}));
  }
  const auto model = std::make_shared<const Model>(compile(scene));
  const RankAnalysis found = analyze_rank(model, given_state(*model), RankNames::none);
  EXPECT_EQ(found.aside.size(), 199u);
  EXPECT_EQ(found.rank, 6 * kTriangles - 1 + 9 * kCouples);
  EXPECT_THAT(found.singular, IsEmpty());
}

// Rank does not depend on units, frames or place.
TEST(Rank, IsInvariant) {
  const Scene scene = scene_of("double_four_bar");
  Transform transform;
  transform.R = Eigen::AngleAxisd(1.2, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  transform.t = {10, -20, 30};
  transform.shuffle = 7;
  for (double scale : {1e-3, 1.0, 1e3}) {
    Scene scaled = transform.apply(scene);
    for (Body& body : scaled.bodies) body.position *= scale;
    for (Joint& j : scaled.joints) j.point *= scale;
    const RankAnalysis analysis = analyze(scaled);
    EXPECT_EQ(analysis.rank, 29) << scale;
    EXPECT_EQ(analysis.degrees_of_freedom(), 1) << scale;
  }
}

// The same slider, its centre of mass at the joints' points but for a rounding of these.
TEST(Rank, OfABodyWithAllButNoArms) {
  for (const double off : {0.0, 1e-17, 1e-12, 1e-9, 1e-7}) {
    Scene scene = free_bodies(3);
    scene.bodies[0].position = {0, 0, 0}, scene.bodies[1].position = {0.025, 0.025, 0.1};
    scene.bodies[2].position = {0.05, 0, 0.2};
    const Vector3 middle = scene.bodies[1].position + Vector3(off, -off, 0);
    scene.joints = {joint(JointType::revolute, kGround, 0, {0, 0, 0}),
                    joint(JointType::revolute, kGround, 2, {0.05, 0, 0.2}),
                    joint(JointType::translational, 0, 1, middle, {1, 1, 0}),
                    joint(JointType::translational, 1, 2, middle, {1, -1, 0})};
    const RankAnalysis rank = analyze(scene);
    EXPECT_EQ(rank.aside.size(), 3u) << off;
    EXPECT_EQ(rank.doubt.row, -1) << off;
    EXPECT_GT(body_sizes(compile(scene))[1], 0.01) << off;
  }
}

// Each of them as if it were alone, however many stand in one scene: of straight toggles the one row that meets the
// others without crossing them.
TEST(Rank, OfManyMechanismsIsThatOfEach) {
  for (const int count : {1, 300, 1400}) {  // of the last 21 000 rows
    Rods made;
    for (int k = 0; k < count; ++k) {
      const Vector3 p(0, 3.0 * k, 0), q = p + Vector3::UnitX(), r = q + Vector3::UnitX();
      const int first = made.rod(p, q), second = made.rod(q, r);
      made.join(kGround, first, p);
      made.join(first, second, q);
      made.join(second, kGround, r);
    }
    const auto model = std::make_shared<const Model>(compile(made.scene));
    const RankAnalysis rank = analyze_rank(model, given_state(*model), RankNames::none);
    EXPECT_EQ(rank.degrees_of_freedom(), 0) << count;
    EXPECT_EQ(rank.singular.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(rank.aside.size(), 3u * static_cast<std::size_t>(count));
  }
}

}  // namespace
}  // namespace poinsot::test
