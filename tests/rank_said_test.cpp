// What runs and checks say of rank: one definition for both, relative to the bodies in a row, and whatever lies between
// dependent and independent is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bench/study/scene_check.h"
#include "bench/study/scene_check_text.h"
#include "core/input_error.h"
#include "tests/support/loops.h"
#include "tests/support/passages.h"
#include "tests/support/simulation.h"
#include "tests/support/twice_driven.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

constexpr const char* kStays = "the mechanism has no degree of freedom and no driver: it cannot move";

Outcome a_step(const Scene& scene, const FormulationEntry& formulation) {
  return simulate(scene, dynamics(formulation.name, 1e-3, 1e-3), {});
}

std::string refused(const Scene& scene, std::string_view formulation) {
  try {
    return "accepted: " + simulate(scene, dynamics(formulation, 1e-3, 1e-3), {}).status.message;
  } catch (const InputError& error) {
    return error.what();
  }
}

// Bricard's linkage moves by its proportions alone.
Scene tilted_bricard(double tilt) {
  Scene scene = scene_of("bricard");
  Vector3& axis = scene.joints.back().axis;
  axis = (axis.normalized() + tilt * axis.unitOrthogonal()).normalized();
  return scene;
}

TEST(RankSaid, AnAxisTiltedByNothingLeavesALinkageMobileForAll) {
  for (const double tilt : {0.0, 1e-12, 1e-10}) {
    const Scene scene = tilted_bricard(tilt);
    const study::SceneCheck found = study::check_scene(scene);
    EXPECT_TRUE(found.sound()) << tilt;
    EXPECT_EQ(found.rank.degrees_of_freedom(), 1) << tilt;
    EXPECT_EQ(found.rank.undetermined.size(), scene.joints.size()) << tilt;
    for (const FormulationEntry& formulation : formulations()) {
      const Outcome run = a_step(scene, formulation);
      EXPECT_TRUE(run.status.ok()) << run.status.message;
      EXPECT_THAT(run.notices, ElementsAre(HasSubstr("1 of 30 constraint rows are redundant"))) << tilt;
      EXPECT_EQ(run.undetermined_reactions.size(), scene.joints.size()) << tilt;
    }
  }
}

TEST(RankSaid, AnAxisTiltedByLittleLocksItAndByHowLittleIsSaid) {
  for (const auto& [tilt, said] : {std::pair(1e-8, "1e-08"), {1e-6, "1e-06"}}) {
    const Scene scene = tilted_bricard(tilt);
    const study::SceneCheck found = study::check_scene(scene);
    EXPECT_EQ(found.rank.degrees_of_freedom(), 0) << tilt;
    EXPECT_THAT(found.rank.undetermined, IsEmpty()) << tilt;
    EXPECT_THAT(study::check_text(found),
                HasSubstr(fmt::format("neither dependent nor clearly independent: joint 'P5' (its row 3 of "
                                      "5), of which {} is left beside the others",
                                      said)));
    for (const FormulationEntry& formulation : formulations())
      EXPECT_THAT(a_step(scene, formulation).notices,
                  ElementsAre(HasSubstr(fmt::format("is a combination of the other constraints but for {} of its "
                                                    "length",
                                                    said)),
                              kStays))
          << tilt;
  }
}

TEST(RankSaid, WhatCannotMoveIsTold) {
  for (const FormulationEntry& formulation : formulations()) {
    EXPECT_THAT(a_step(tilted_bricard(1e-2), formulation).notices, ElementsAre(kStays));
    EXPECT_THAT(a_step(loop({3, Frames::random, false, true}), formulation).notices, Contains(kStays));
    EXPECT_THAT(a_step(loop({4, Frames::random, false, true}), formulation).notices, Not(Contains(kStays)));
    EXPECT_THAT(a_step(scene_of("single_pendulum"), formulation).notices, Not(Contains(kStays)));  // driven
  }
}

// A pendulum asked to be elsewhere than its hinge allows, by half a length of its rod.
Scene torn(double length) {
  Scene scene = scene_of("single_pendulum_free");
  for (Body& body : scene.bodies) body.position *= length;
  for (Joint& joint : scene.joints) joint.point *= length;
  for (Constraint& row : scene.constraints) row.s_i *= length, row.s_j *= length;
  Constraint& again = scene.constraints.emplace_back();
  again.name = "again";
  again.type = ConstraintType::D;
  again.j = 0;
  const double far = 1.5 * scene.bodies[0].position.norm();
  again.f = Expression(far * far);
  return scene;
}

TEST(RankSaid, AConflictIsOneInMicronsAndBesideABodyFarAway) {
  for (const double length : {1e-6, 1.0, 1e6}) {
    for (const bool beside : {false, true}) {
      Scene scene = torn(length);
      if (beside) {
        Body& far = scene.bodies.emplace_back(scene.bodies[0]);
        far.name = "far";
        far.position = {1e6 * length, 0, 0};
      }
      SCOPED_TRACE(fmt::format("{} {}", length, beside));
      const study::SceneCheck found = study::check_scene(scene);
      ASSERT_EQ(found.rank.conflicts.size(), 1u) << study::check_text(found);
      EXPECT_EQ(found.model
                    ->groups[static_cast<std::size_t>(
                        found.model->rows[static_cast<std::size_t>(found.rank.conflicts[0].row)].group)]
                    .name,
                "again");
      EXPECT_EQ(found.rank.conflicts[0].level, Conflict::Level::position);
      for (const FormulationEntry& formulation : formulations())
        EXPECT_THAT(refused(scene, formulation.name), HasSubstr("constraint 'again'"));
    }
  }
}

// Two drivers of one hinge that agree in angle and speed where they start.
TEST(RankSaid, DriversThatPartAfterTheStartContradict) {
  const Scene scene = twice_driven("t", "t + 20*t^2");
  const study::SceneCheck found = study::check_scene(scene);
  ASSERT_EQ(found.rank.conflicts.size(), 1u);
  EXPECT_EQ(found.rank.conflicts[0].level, Conflict::Level::later);
  EXPECT_FALSE(found.sound());
  EXPECT_THAT(study::check_text(found), HasSubstr("driver 't + 20*t^2' contradicts driver 't': off by "));
  for (const FormulationEntry& formulation : formulations())
    EXPECT_THAT(refused(scene, formulation.name), HasSubstr("driver 't + 20*t^2'"));
}

// From rest, but for the rounding of sin(2*pi), and they agree again a second later: where one would look that takes it
// for a motion.
TEST(RankSaid, DriversThatPartFromRestContradict) {
  const Scene scene = twice_driven("0.1*(1 - cos(2*pi*(t + 1)))", "0.2*(1 - cos(2*pi*(t + 1)))");
  const study::SceneCheck found = study::check_scene(scene);
  ASSERT_EQ(found.rank.conflicts.size(), 1u);
  EXPECT_EQ(found.rank.conflicts[0].level, Conflict::Level::later);
}

// Told apart in words, and for programs.
TEST(RankSaid, ASingularRowIsNoRedundantOne) {
  const study::SceneCheck flat = study::check_scene(posts(1, 0, kSpin, true));
  EXPECT_TRUE(flat.rank.singular_position());
  const std::string text = study::check_text(flat);
  EXPECT_THAT(text, HasSubstr("the initial pose is a singular position: "));
  EXPECT_THAT(text, HasSubstr("joint 'joint4' (its row 1 of 5) is singular here: it follows from"));
  EXPECT_THAT(text, HasSubstr("redundant constraints: 3 rows\n"));
  const auto json = study::check_json(flat);
  EXPECT_TRUE(json["singular_position"]);
  EXPECT_EQ(json["singular"].size(), 1u);
  EXPECT_EQ(json["redundant"].size(), 3u);
  for (const FormulationEntry& formulation : formulations()) {
    const std::vector<std::string> notices = a_step(posts(1, 0, kSpin, true), formulation).notices;
    EXPECT_THAT(notices, Contains(HasSubstr("constraint rows are redundant, they follow from the others")));
    EXPECT_THAT(notices, Contains(HasSubstr("singular position of the mechanism: singular here: joint 'joint4'")));
  }

  const study::SceneCheck bent = study::check_scene(posts(1, 0.5, kSpin, true));
  EXPECT_FALSE(bent.rank.singular_position());
  EXPECT_THAT(study::check_text(bent), Not(HasSubstr("singular")));
  EXPECT_FALSE(study::check_json(bent)["singular_position"]);
}

TEST(RankSaid, WhichReactionsAreUniqueIsSaidJointByJoint) {
  // In the plane of the loop forces are unique, and the moment across it is nothing.
  Scene scene = loop({4, Frames::random, false, true});
  Body& pendulum = scene.bodies.emplace_back(scene.bodies[0]);
  pendulum.name = "pendulum";
  pendulum.position = {5, 0, 0};
  Joint& hinge = scene.joints.emplace_back(scene.joints[0]);
  hinge.name = "hinge";
  hinge.i = kGround, hinge.j = 3;
  hinge.point = {5, 1, 0};
  const study::SceneCheck found = study::check_scene(scene);
  EXPECT_THAT(study::check_text(found),
              HasSubstr("reactions that redundant rows leave undetermined: joint 'joint1' (fz nx ny), joint 'joint2' "
                        "(fz nx ny), joint 'joint3' (fz nx ny), joint 'joint4' (fz nx ny)\n"));
  const auto json = study::check_json(found);
  for (const auto& components : json["undetermined_components"]) EXPECT_THAT(components, ElementsAre("fz", "nx", "ny"));
  EXPECT_THAT(study::check_json(found)["undetermined_reactions"],
              ElementsAre("joint 'joint1'", "joint 'joint2'", "joint 'joint3'", "joint 'joint4'"));
}

}  // namespace
}  // namespace poinsot::test
