// Initial states: those on the constraints stay as they are to the last bit, those beside them are projected and told,
// and what cannot be is refused by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/input_error.h"
#include "integrators/start/initial_state.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

InitialState assemble_scene(const Scene& scene, Assembly assembly = Assembly::small) {
  Settings settings;
  settings.assembly = assembly;
  return find_initial_state(std::make_shared<const Model>(compile(scene)), settings);
}

std::string refusal(const Scene& scene, Assembly assembly = Assembly::small) {
  try {
    const InitialState start = assemble_scene(scene, assembly);
    ADD_FAILURE() << "accepted: " << start.status.message;
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

template <class M>
bool same_bits(const M& x, const M& y) {
  return std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
}

void expect_untouched(const Scene& scene, const std::vector<BodyState>& bodies) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    EXPECT_TRUE(same_bits(bodies[b].r, body.position)) << scene.name << ", " << body.name;
    EXPECT_TRUE(same_bits(bodies[b].A, body.orientation)) << scene.name << ", " << body.name;
    EXPECT_TRUE(same_bits(bodies[b].rd, body.velocity)) << scene.name << ", " << body.name;
    EXPECT_TRUE(same_bits(bodies[b].w, body.angular_velocity)) << scene.name << ", " << body.name;
  }
}

Scene with_state(Scene scene, const std::vector<BodyState>& bodies) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    scene.bodies[b].position = bodies[b].r;
    scene.bodies[b].orientation = bodies[b].A;
    scene.bodies[b].velocity = bodies[b].rd;
    scene.bodies[b].angular_velocity = bodies[b].w;
  }
  return scene;
}

TEST(Assembly, LeavesConsistentStatesToTheLastBit) {
  for (const char* model : {"single_pendulum_joints", "double_pendulum", "double_pendulum_joints", "four_link_haug",
                            "four_link_joints", "slider_crank_haug", "slider_crank_joints", "heavy_top", "andrews",
                            "simple_pendulum", "free_body", "knife_edge", "double_four_bar"}) {
    const Scene scene = scene_of(model);
    for (Assembly assembly : {Assembly::small, Assembly::always, Assembly::never}) {
      const InitialState start = assemble_scene(scene, assembly);
      EXPECT_TRUE(start.status.ok()) << start.status.message;
      expect_untouched(scene, start.bodies);
      for (const std::string& notice : start.notices) EXPECT_THAT(notice, Not(::testing::HasSubstr("assembled")));
    }
  }
}

TEST(Assembly, TheRunBeginsThere) {
  const Scene scene = scene_of("four_link_joints");
  expect_untouched(scene, motion(scene, dynamics("rA", 1e-3, 1e-3)).front().bodies);
}

TEST(Assembly, ProjectedStatesAreLeftThen) {
  for (const char* model : {"single_pendulum", "four_link", "slider_crank"}) {
    const Scene scene = scene_of(model);
    const InitialState start = assemble_scene(scene);
    ASSERT_TRUE(start.status.ok()) << start.status.message;
    const Scene projected = with_state(scene, start.bodies);
    const InitialState again = assemble_scene(projected);
    expect_untouched(projected, again.bodies);
    EXPECT_THAT(again.notices, IsEmpty());
  }
}

InitialState expect_reference_state(const char* model) {
  const InitialState start = assemble_scene(scene_of(model));
  EXPECT_TRUE(start.status.ok()) << start.status.message;
  std::vector<Snapshot> reference = reference_motion(std::string("kin_") + model);
  reference.resize(1);
  const Distance d = distance({{0, start.bodies, {}}}, reference);
  EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), 1e-12) << d;
  return start;
}

TEST(Assembly, FindsTheReferenceStateAndTellsHowFarItMoved) {
  EXPECT_THAT(
      expect_reference_state("four_link").notices,
      ElementsAre("initial pose assembled: constraint 'revD-CD-i' was violated by 0.0087 m; the bodies moved by "
                  "up to 2.43e-09 m and turned by up to 0.00267 rad, 'link 3' most",
                  "initial velocities assembled: constraint 'univ-CD-j' was violated by 6.28 m/s; the velocities "
                  "changed by up to 5.19e-09 m/s and 3.14 rad/s"));
  EXPECT_THAT(
      expect_reference_state("slider_crank").notices,
      ElementsAre(MatchesRegex("initial pose assembled: constraint 'trans_D' was violated by 6.93e-07 m²; the "
                               "bodies moved by up to .* m and turned by up to 3.36e-06 rad, 'connecting rod' "
                               "most"),  // moved by rounding only
                  "initial velocities assembled: constraint 'rev_cyl_C_DP1_1' was violated by 6.24e-06 rad/s; the "
                  "velocities changed by up to 2.29e-09 m/s and 6e-09 rad/s"));
}

// Two free masses on a rod that is a little too long: they move along it as 3 : 1, the least motion weighed by mass.
TEST(Assembly, MovesHeavyBodiesLess) {
  Scene scene;
  for (int b = 0; b < 2; ++b) {
    Body body;
    body.name = b ? "heavy" : "light";
    body.mass = b ? 3 : 1;
    body.inertia = Matrix3::Identity();
    body.position = {b ? 1.004 : 0, 0, 0};
    scene.bodies.push_back(body);
  }
  Constraint rod;
  rod.name = "rod";
  rod.type = ConstraintType::D;
  rod.i = 0, rod.j = 1;
  rod.f = Expression(1);
  scene.constraints = {rod};
  const InitialState start = assemble_scene(scene);
  EXPECT_NEAR(start.bodies[0].r.x(), 0.003, 1e-12);
  EXPECT_NEAR(start.bodies[1].r.x(), 1.003, 1e-12);
  EXPECT_THAT(
      start.notices,
      ElementsAre("initial pose assembled: constraint 'rod' was violated by 0.00802 m²; the bodies moved by up to "
                  "0.003 m and turned by up to 0 rad, 'light' most"));
}

// A body on a revolute joint about x through the origin.
Scene pendulum() {
  return scene_of("single_pendulum_joints");
}

TEST(Assembly, RefusesPosesFarFromTheConstraints) {
  Scene scene = scene_of("single_pendulum_free");
  scene.bodies[0].position.x() = 0.25;
  EXPECT_EQ(refusal(scene),
            "the initial pose violates constraint 'revJoint_CD_1' by 0.25 m, more than the 0.0141 m that is put right "
            "unasked; correct the scene, or have it projected onto the constraints with `poinsot run --assemble`, "
            "whose --save-state keeps it");
  const InitialState start = assemble_scene(scene, Assembly::always);
  ASSERT_TRUE(start.status.ok()) << start.status.message;
  EXPECT_LT(violation(std::make_shared<const Model>(compile(scene)), start.bodies).position, 1e-12);
}

TEST(Assembly, NeverMeansNever) {
  Scene scene = scene_of("single_pendulum_free");
  EXPECT_EQ(refusal(scene, Assembly::never),
            "the initial pose violates constraint 'revJoint_CD_2' by 2.37e-09 m; allowed with --no-assemble: 1e-10");
  scene = pendulum();
  scene.bodies[0].velocity.x() = 1e-3;
  EXPECT_EQ(refusal(scene, Assembly::never),
            "the initial velocity violates joint 'revolute1' (its row 1 of 5) by 0.001 m/s; allowed with "
            "--no-assemble: 1e-10");
}

Constraint row_of_x(const char* name, const char* f) {
  Constraint row;
  row.name = name;
  row.type = ConstraintType::CD;
  row.j = 0;
  row.c = Vector3::UnitX();
  row.f = Expression::parse(f);
  return row;
}

TEST(Assembly, NamesConflictingPositions) {
  Scene scene = scene_of("free_body");
  scene.constraints = {row_of_x("at", "0"), row_of_x("elsewhere", "0.002")};
  EXPECT_EQ(refusal(scene),
            "the constraints conflict: with the others satisfied, constraint 'elsewhere' is still violated by 0.002 m "
            "(position); `poinsot check` names what it depends on");
}

TEST(Assembly, NamesConflictingVelocities) {
  Scene scene = scene_of("free_body");
  scene.constraints = {row_of_x("still", "0"), row_of_x("moving", "0.5*t")};
  EXPECT_EQ(refusal(scene),
            "the constraints conflict: with the others satisfied, constraint 'moving' is still violated by 0.5 m/s "
            "(velocity); `poinsot check` names what it depends on");
}

TEST(Assembly, NamesADriverOfWhatCannotMove) {
  Scene scene = pendulum();
  Joint weld;
  weld.name = "weld";
  weld.type = JointType::fixed;
  weld.j = 0;
  scene.joints = {weld};
  scene.drivers[0].name = "motor";
  scene.drivers[0].value = Expression::parse("2*t");
  EXPECT_EQ(
      refusal(scene),
      "the constraints conflict: with the others satisfied, driver 'motor' is still violated by 4 m/s (velocity); "
      "`poinsot check` names what it depends on");
}

// A pendulum of 2 m asked to be 5 m away from a point of the ground.
Scene too_far(const Vector3& point) {
  Scene scene = scene_of("single_pendulum_free");
  Constraint far;
  far.name = "far";
  far.type = ConstraintType::D;
  far.j = 0;
  far.s_i = point;
  far.f = Expression(25);
  scene.constraints.push_back(far);
  return scene;
}

// From its pivot: the row depends on the joint's, and conflicts.
TEST(Assembly, NamesAConflictOfIndependentTypes) {
  EXPECT_EQ(
      refusal(too_far({0, 0, 0}), Assembly::always),
      "the constraints conflict: with the others satisfied, constraint 'far' is still violated by 5.25 m (position); "
      "`poinsot check` names what it depends on");
}

// The same from a point beside the pivot, where the rows are independent and have no common solution.
TEST(Assembly, RefusesWhatHasNoSolution) {
  EXPECT_THAT(
      refusal(too_far({0, 1, 0}), Assembly::always),
      MatchesRegex("no position near the given pose closes the mechanism: constraint '.*' stays open by .* m, at "
                   "the given pose constraint 'far' is by .* m; correct it, or start from a pose nearer to the "
                   "one meant; `poinsot check` names conflicting constraints"));
}

}  // namespace
}  // namespace poinsot::test
