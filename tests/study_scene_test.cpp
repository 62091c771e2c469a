// What a scene is told of itself: whether it is sound, and what in it costs without mattering.
#include <gmock/gmock.h>

#include "bench/study/scene_check.h"
#include "bench/study/scene_check_text.h"
#include "bench/study/scene_waste.h"
#include "bench/study/startable_scene.h"
#include "core/input_error.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Scene scene_with(const std::string& rest, const std::string& body = {}) {
  return parse_scene(R"json({"scene": 1, "name": "test", "gravity": [0, 0, -9.81], "bodies": [
    {"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]})json" +
                         body + "], " + rest + "}",
                     "test");
}

const std::string kHeld =
    R"json("constraints": [
      {"type": "CD", "name": "first", "bodies": ["ground", "ball"], "c": [1, 0, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": 1},
      {"type": "CD", "name": "second", "bodies": ["ground", "ball"], "c": [2, 0, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": FFF}])json";

Scene held(const std::string& f) {
  std::string text = kHeld;
  return scene_with(text.replace(text.find("FFF"), 3, f));
}

TEST(SceneCheck, of_the_papers_mechanisms_finds_them_sound) {
  const std::vector<std::pair<std::string, int>> freedom{
      {"single_pendulum", 0}, {"double_pendulum", 2}, {"four_link", 0}, {"slider_crank", 0}};
  for (const auto& [model, degrees] : freedom) {
    const study::SceneCheck found = study::check_scene(scene_of(model));
    EXPECT_TRUE(found.sound()) << model << found.refusal << found.start.status.message;
    EXPECT_EQ(found.rank.degrees_of_freedom(), degrees) << model;
    EXPECT_GE(found.derivatives, formulations().size()) << model;
    EXPECT_LT(found.derivative_error, 1e-9) << model;
  }
}

TEST(SceneCheck, tells_a_redundant_row_from_one_that_contradicts) {
  const study::SceneCheck redundant = study::check_scene(held("2"));
  EXPECT_TRUE(redundant.sound());
  EXPECT_THAT(redundant.rank.dependent_rows(), ElementsAre(1));

  const study::SceneCheck position = study::check_scene(held("2.5"));
  EXPECT_FALSE(position.sound());
  ASSERT_EQ(position.rank.conflicts.size(), 1u);
  EXPECT_EQ(position.rank.conflicts[0].row, 1);
  EXPECT_EQ(position.rank.conflicts[0].level, Conflict::Level::position);
  EXPECT_NEAR(position.rank.conflicts[0].by, 0.25, 1e-12);  // m: the row's direction is 2 long
  EXPECT_EQ(position.derivatives, 0u);                      // nothing further is checked

  const study::SceneCheck velocity = study::check_scene(held("\"2 + 3*t\""));
  ASSERT_EQ(velocity.rank.conflicts.size(), 1u);
  EXPECT_EQ(velocity.rank.conflicts[0].level, Conflict::Level::velocity);
  EXPECT_NEAR(velocity.rank.conflicts[0].by, 1.5, 1e-12);
}

TEST(SceneCheck, says_of_a_row_that_nothing_satisfies_near_that_it_has_no_gradient) {
  const study::SceneCheck found = study::check_scene(parse_scene(R"j({"scene": 1, "bodies": [
      {"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}], "constraints": [
      {"type": "D", "name": "rod", "bodies": ["ground", "a"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": 0.04}]})j",
                                                                 "rod.json"));
  EXPECT_FALSE(found.sound());
  EXPECT_THAT(study::check_text(found), HasSubstr("constraint 'rod' is violated and has no "
                                                  "gradient here: no way leads to where it holds\n"));
}

// Undefined as its direction is, the derivatives of its force are not compared; that is told.
TEST(SceneCheck, tells_of_a_spring_without_direction) {
  const study::SceneCheck found = study::check_scene(parse_scene(R"j({"scene": 1, "bodies": [
      {"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}], "forces": [
      {"type": "spring", "name": "strut", "bodies": ["ground", "a"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "length": 0.5,
       "stiffness": 100}]})j",
                                                                 "strut.json"));
  EXPECT_TRUE(found.sound());
  EXPECT_EQ(found.derivatives, 0u);
  EXPECT_THAT(found.notices,
              Contains(HasSubstr("force 'strut' (/forces/0) is 50 N between ends that are at one point")));
}

TEST(SceneCheck, keeps_why_no_run_can_start) {
  Scene scene = scene_of("four_link");
  scene.bodies[1].position += Vector3(5, 0, 0);
  const study::SceneCheck found = study::check_scene(scene);
  EXPECT_NE(found.refusal, "");
  EXPECT_FALSE(found.sound());
  EXPECT_FALSE(found.consistent());
  EXPECT_GT(found.violation.position, 1);
}

TEST(StartableScene, is_refused_with_its_file) {
  const std::string four_link = fmt::format("{}/models/four_link.json", POINSOT_SOURCE_DIR);
  EXPECT_EQ(study::read_startable_scene(four_link).bodies.size(), 3u);
  EXPECT_THROW((void)study::read_startable_scene("nowhere.json"), InputError);
}

std::vector<std::string> waste(const Scene& scene) {
  Settings settings;
  settings.integrator = "dopri5";
  settings.end = 0.5;
  settings.every = 0.05;
  const study::MotionRun run = study::run_motion(scene, settings);
  EXPECT_TRUE(run.outcome.status.ok()) << run.outcome.status.message;
  return study::scene_waste(scene, run.motion);
}

TEST(SceneWaste, is_none_where_everything_matters) {
  EXPECT_THAT(waste(scene_of("double_pendulum")), ElementsAre());
}

TEST(SceneWaste, names_rows_that_follow_from_others) {
  EXPECT_THAT(waste(held("2")), testing::Contains(HasSubstr("1 of 2 constraint rows follow from the others")));
}

TEST(SceneWaste, names_bodies_that_stand_still_or_never_turn) {
  const std::string second = R"json(, {"name": "rail", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]})json";
  const Scene scene = scene_with(R"json("joints": [
      {"type": "fixed", "name": "foot", "bodies": ["ground", "rail"], "point": [0, 0, 0]},
      {"type": "translational", "name": "slide", "bodies": ["rail", "ball"], "point": [1, 0, 0], "axis": [0, 0, 1]}])json",
                                 second);
  EXPECT_THAT(waste(scene), ElementsAre(HasSubstr("not moving: 'rail'"), HasSubstr("never turning: 'ball'"),
                                        HasSubstr("joint 'foot' makes one body of two")));
}

}  // namespace
}  // namespace poinsot::test
