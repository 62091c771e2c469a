// Every rule of core/scene_validation.h, broken one at a time in a scene built in C++ and, where a file can say it, in
// the file: the same sentence, with the file's name before it.
#include "core/scene_validation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/input_error.h"
#include "core/model.h"
#include "core/places.h"
#include "core/scene_reader.h"
#include "integrators/simulate.h"
#include "tests/support/without_place.h"

namespace poinsot {
namespace {

using Json = nlohmann::json;
using test::without_place;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

// Two bodies with every type of everything once.
const Json& everything() {
  static const Json base = [] {
    std::ifstream in(POINSOT_SOURCE_DIR "/tests/scene_schema_test.json");
    return Json(Json::parse(in)["base"]);
  }();
  return base;
}

template <class Do>
std::string refusal(Do act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

struct Case {
  std::function<void(Scene&)> breaks;
  std::string message;
  const char* pointer = nullptr;  // the same in a file: what is set there
  Json value = nullptr;
};

template <class F>
F& force(Scene& scene, std::size_t k) {
  return std::get<F>(scene.forces[k]);
}

const std::vector<Case>& refused_cases() {
  static const std::vector<Case> cases = {
      {[](Scene& s) { s.gravity[1] = kNan; }, "/gravity/1: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies.clear(); }, "/bodies: found an array of 0 values, expected at least one body", "/bodies",
       Json::array()},

      {[](Scene& s) { s.bodies[1].name = ""; }, "/bodies/1/name: found \"\", expected a name of one character or more",
       "/bodies/1/name", ""},
      {[](Scene& s) { s.bodies[1].name = "a\nb"; },
       "/bodies/1/name: found \"a\\nb\", expected a name without control characters", "/bodies/1/name", "a\nb"},
      {[](Scene& s) { s.bodies[1].name = "\xff"; }, "/bodies/1/name: found \"\xef\xbf\xbd\", expected a name in UTF-8"},
      {[](Scene& s) { s.bodies[1].name = "ground"; },
       "/bodies/1/name: found \"ground\", which is body 0 and never listed, expected another name", "/bodies/1/name",
       "ground"},
      {[](Scene& s) { s.bodies[1].name = "a"; },
       "/bodies/1/name: found \"a\", the name of /bodies/0 already, expected a name of its own", "/bodies/1/name", "a"},
      {[](Scene& s) { s.bodies[1].mass = -1; }, "/bodies/1/mass: found -1, expected a positive number",
       "/bodies/1/mass", "1 - 2"},
      {[](Scene& s) { s.bodies[1].mass = 0; }, "/bodies/1/mass: found 0, expected a positive number", "/bodies/1/mass",
       0},
      {[](Scene& s) { s.bodies[1].mass = 1e-320; },
       "/bodies/1/mass: found 1e-320, expected a number of at least 2.23e-308", "/bodies/1/mass", 1e-320},
      {[](Scene& s) { s.bodies[1].mass = kInf; }, "/bodies/1/mass: found inf, expected a finite number"},
      {[](Scene& s) { s.bodies[1].mass = kNan; }, "/bodies/1/mass: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies[0].inertia(1, 1) = -2; },
       "/bodies/0/inertia: found a principal moment of -2, expected none below zero",
       "/bodies/0/inertia",
       {4, -2, 0}},
      {[](Scene& s) { s.bodies[0].inertia << 1, 2, 0, 2, 1, 0, 0, 0, 1; },
       "/bodies/0/inertia: found a principal moment of -1, expected none below zero",
       "/bodies/0/inertia",
       {{1, 2, 0}, {2, 1, 0}, {0, 0, 1}}},
      {[](Scene& s) { s.bodies[0].inertia(0, 1) = 0.1; },
       "/bodies/0/inertia: found a matrix that is not symmetric, expected 3 principal moments or a symmetric 3x3 "
       "matrix",
       "/bodies/0/inertia",
       {{4, 0.1, 0}, {0, 2, 0}, {0, 0, 0}}},
      {[](Scene& s) { s.bodies[0].inertia(2, 1) = kNan; },
       "/bodies/0/inertia/2/1: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies[0].position[2] = -kInf; }, "/bodies/0/position/2: found -inf, expected a finite number"},
      {[](Scene& s) { s.bodies[0].velocity[0] = kNan; }, "/bodies/0/velocity/0: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies[0].angular_velocity[0] = kNan; },
       "/bodies/0/angular_velocity/0: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies[0].orientation(0, 2) = kNan; },
       "/bodies/0/orientation/matrix/0/2: found nan, expected a finite number"},
      {[](Scene& s) { s.bodies[0].orientation(0, 1) = 0.1; },
       "/bodies/0/orientation/matrix: found a matrix A with AᵀA off the identity by 0.1, expected a rotation to within "
       "0.0001",
       "/bodies/0/orientation/matrix",
       {{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}}},
      {[](Scene& s) { s.bodies[0].orientation(0, 0) = 1.0002; },
       "/bodies/0/orientation/matrix: found entries up to 0.0002 off the nearest rotation, expected at most 0.0001",
       "/bodies/0/orientation/matrix",
       {{1.0002, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {[](Scene& s) { s.bodies[0].orientation(2, 2) = -1; },
       "/bodies/0/orientation/matrix: found a reflection (its determinant is -1), expected a rotation",
       "/bodies/0/orientation/matrix",
       {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}},

      {[](Scene& s) { s.constraints[1].type = static_cast<ConstraintType>(9); },
       "/constraints/1/type: found 9, expected one of DP1, DP2, D, CD, pfaffian"},
      {[](Scene& s) { s.joints[0].type = static_cast<JointType>(-1); },
       "/joints/0/type: found -1, expected one of revolute, spherical, universal, cylindrical, translational, fixed"},
      {[](Scene& s) { s.drivers[0].type = static_cast<DriverType>(2); },
       "/drivers/0/type: found 2, expected one of angle, distance"},
      {[](Scene& s) { force<PointForce>(s, 0).frame = static_cast<Frame>(2); },
       "/forces/0/frame: found 2, expected one of global, body"},
      {[](Scene& s) { force<Torque>(s, 1).frame = static_cast<Frame>(2); },
       "/forces/1/frame: found 2, expected one of global, body"},

      {[](Scene& s) { s.constraints[1].j = 2; },
       "/constraints/1/bodies/1: found 2, expected the number of a body, less than 2, or -1 for the ground"},
      {[](Scene& s) { s.joints[1].i = -2; },
       "/joints/1/bodies/0: found -2, expected the number of a body, less than 2, or -1 for the ground"},
      {[](Scene& s) { s.drivers[0].j = 1000000; },
       "/drivers/0/bodies/1: found 1000000, expected the number of a body, less than 2, or -1 for the ground"},
      {[](Scene& s) { force<Spring>(s, 2).i = 2; },
       "/forces/2/bodies/0: found 2, expected the number of a body, less than 2, or -1 for the ground"},
      {[](Scene& s) { force<TorsionSpring>(s, 3).i = 2; },
       "/forces/3/bodies/0: found 2, expected the number of a body, less than 2, or -1 for the ground"},
      {[](Scene& s) { force<PointForce>(s, 0).body = 2; },
       "/forces/0/body: found 2, expected the number of a body, less than 2"},
      {[](Scene& s) { force<Torque>(s, 1).body = kGround; },
       "/forces/1/body: found \"ground\", expected the name of a body that can move: a, b", "/forces/1/body", "ground"},
      {[](Scene& s) { force<LinearDrag>(s, 4).body = -7; },
       "/forces/4/body: found -7, expected the number of a body, less than 2"},
      {[](Scene& s) { s.constraints[1].j = 0; },
       "/constraints/1/bodies: found \"a\" twice, expected two different bodies",
       "/constraints/1/bodies",
       {"a", "a"}},
      {[](Scene& s) { s.joints[0].j = kGround; },
       "/joints/0/bodies: found \"ground\" twice, expected two different bodies",
       "/joints/0/bodies",
       {"ground", "ground"}},
      {[](Scene& s) { force<Spring>(s, 2).i = 1; },
       "/forces/2/bodies: found \"b\" twice, expected two different bodies",
       "/forces/2/bodies",
       {"b", "b"}},

      {[](Scene& s) { s.constraints[0].a_j.setZero(); },
       "/constraints/0/a_j: found the zero vector, expected a direction",
       "/constraints/0/a_j",
       {0, 0, 0}},
      {[](Scene& s) { s.constraints[1].a_i.setZero(); },
       "/constraints/1/a_i: found the zero vector, expected a direction",
       "/constraints/1/a_i",
       {0, 0, 0}},
      {[](Scene& s) { s.constraints[3].c.setZero(); },
       "/constraints/3/c: found the zero vector, expected a direction",
       "/constraints/3/c",
       {0, 0, 0}},
      {[](Scene& s) { s.constraints[4].a_j.setZero(); },
       "/constraints/4/a_j: found the zero vector, expected a direction",
       "/constraints/4/a_j",
       {0, 0, 0}},
      {[](Scene& s) { s.constraints[0].alternate->a_i.setZero(); },
       "/constraints/0/alternate/a_i: found the zero vector, expected a direction",
       "/constraints/0/alternate/a_i",
       {0, 0, 0}},
      {[](Scene& s) { s.constraints[0].alternate->f = Expression(kNan); },
       "/constraints/0/alternate/f: found nan, expected a finite number"},
      {[](Scene& s) { s.constraints[2].alternate = s.constraints[0].alternate; },
       "/constraints/2/alternate: found one of a D, expected it of a DP1 only"},
      {[](Scene& s) { s.constraints[2].s_j[1] = kNan; }, "/constraints/2/s_j/1: found nan, expected a finite number"},
      {[](Scene& s) { s.constraints[2].f = Expression(kInf); },
       "/constraints/2/f: found inf, expected a finite number"},

      {[](Scene& s) { s.joints[0].axis.setZero(); },
       "/joints/0/axis: found the zero vector, expected a direction",
       "/joints/0/axis",
       {0, 0, 0}},
      {[](Scene& s) { s.joints[2].axis_i.setZero(); },
       "/joints/2/axis_i: found the zero vector, expected a direction",
       "/joints/2/axis_i",
       {0, 0, 0}},
      {[](Scene& s) { s.joints[2].axis_j = Vector3(1, 1, 0); },
       "/joints/2/axis_j: found an axis at 0.7854 rad to axis_i, expected one perpendicular to it",
       "/joints/2/axis_j",
       {1, 1, 0}},
      {[](Scene& s) { s.joints[1].point[0] = kNan; }, "/joints/1/point/0: found nan, expected a finite number"},

      {[](Scene& s) { s.drivers[0].axis.setZero(); },
       "/drivers/0/axis: found the zero vector, expected a direction",
       "/drivers/0/axis",
       {0, 0, 0}},
      {[](Scene& s) { s.drivers[0].value = Expression(kNan); },
       "/drivers/0/angle: found nan, expected a finite number"},
      {[](Scene& s) { s.drivers[1].value = Expression(kNan); },
       "/drivers/1/length: found nan, expected a finite number"},
      {[](Scene& s) { s.drivers[1].s_i[2] = kInf; }, "/drivers/1/s_i/2: found inf, expected a finite number"},

      {[](Scene& s) { force<PointForce>(s, 0).force[2] = Expression(kNan); },
       "/forces/0/force/2: found nan, expected a finite number"},
      {[](Scene& s) { force<Torque>(s, 1).torque[0] = Expression(kNan); },
       "/forces/1/torque/0: found nan, expected a finite number"},
      {[](Scene& s) { force<Spring>(s, 2).length = -1; },
       "/forces/2/length: found -1, expected a number that is not negative", "/forces/2/length", -1},
      {[](Scene& s) { force<Spring>(s, 2).stiffness = kInf; },
       "/forces/2/stiffness: found inf, expected a finite number"},
      {[](Scene& s) { force<TorsionSpring>(s, 3).axis.setZero(); },
       "/forces/3/axis: found the zero vector, expected a direction",
       "/forces/3/axis",
       {0, 0, 0}},
      {[](Scene& s) { force<TorsionSpring>(s, 3).angle = kNan; },
       "/forces/3/angle: found nan, expected a finite number"},
      {[](Scene& s) { force<LinearDrag>(s, 4).rotational = kNan; },
       "/forces/4/rotational: found nan, expected a finite number"},

      {[](Scene& s) { s.joints[0].name = "weld"; },
       "/joints/5/name: found \"weld\", the name of /joints/0 already, expected a name of its own", "/joints/0/name",
       "weld"},
      {[](Scene& s) { s.joints[0].name = "turn"; },
       "/joints/0/name: found \"turn\", the name of /constraints/0 already, expected a name of its own",
       "/joints/0/name", "turn"},
      {[](Scene& s) { s.joints[0].name = "spherical1"; },
       "/joints/1: found \"spherical1\" (its name by type and number), the name of /joints/0 already, expected a name "
       "of its own",
       "/joints/0/name", "spherical1"},
      {[](Scene& s) { force<PointForce>(s, 0).name = "motor"; },
       "/forces/1/name: found \"motor\", the name of /forces/0 already, expected a name of its own", "/forces/0/name",
       "motor"},
      {[](Scene& s) { s.joints[0].name = "\x7f"; },
       "/joints/0/name: found \"\\u007f\", expected a name without control characters", "/joints/0/name", "\x7f"},
  };
  return cases;
}

TEST(SceneValidation, answers_to_scenes_built_in_cpp) {
  const Scene sound = parse_scene(everything().dump(), "case.json");
  EXPECT_EQ(refusal([&] { validate(sound); }), "");
  for (const Case& c : refused_cases()) {
    Scene scene = sound;
    c.breaks(scene);
    EXPECT_EQ(refusal([&] { validate(scene); }), c.message);
    EXPECT_EQ(without_place(refusal([&] { (void)compile(scene); })), c.message);
    EXPECT_EQ(without_place(refusal([&] { (void)simulate(scene, {}, [](const Sample&) { FAIL() << "a sample"; }); })),
              c.message);
  }
}

TEST(SceneValidation, answers_the_same_to_files) {
  int in_files = 0;
  for (const Case& c : refused_cases()) {
    if (c.pointer == nullptr) continue;
    ++in_files;
    Json document = everything();
    document[Json::json_pointer(c.pointer)] = c.value;
    const std::string said = refusal([&] { (void)parse_scene(document.dump(1), "case.json"); });
    EXPECT_EQ(without_place(said), "case.json: " + c.message);
    EXPECT_EQ(refusal([&] { (void)parse_scene(document.dump() + "\n", "case.json"); }).find("line "), said.npos)
        << "of one line there is none to look for";
    const std::size_t line = said.rfind("line ");
    ASSERT_NE(line, said.npos) << said;
    EXPECT_GT(std::stoi(said.substr(line + 5)), 1) << said;
  }
  EXPECT_GT(in_files, 25);
}

TEST(SceneValidation, says_whose_it_is_and_on_which_line) {
  const auto said = [](const char* hinge) {
    const std::string text = fmt::format(R"j({{"scene": 1,
"bodies": [  // a comment
  {{"name": "upper arm", "mass": 1,
    "inertia": [1, 1, 1], "position": [0, 0, 0]}}
],
"joints": [
  {{"type": "revolute", "name": "hinge", "bodies": ["ground", "upper arm"],
    "point": [0, 0,
      0
    ],
    {}}}
]}})j",
                                         hinge);
    return refusal([&] { (void)parse_scene(text, "arm.json"); });
  };
  EXPECT_EQ(said(R"("axis": [0, 0, 1])"), "");
  EXPECT_EQ(said(R"("axis": [0, 0, 0])"),
            "arm.json: /joints/0/axis: found the zero vector, expected a direction (joint 'hinge', line 11)");
  EXPECT_EQ(said(R"("axis": [0,
 0, [1]])"),
            "arm.json: /joints/0/axis/2: found an array of 1 value, expected a number (joint 'hinge', line 12)");
  EXPECT_EQ(said(R"("axes": [0, 0, 1])").substr(0, 33), "arm.json: /joints/0/axes: unknown");
  EXPECT_TRUE(said(R"("axes": [0, 0, 1])").ends_with("(joint 'hinge', line 11)"));
  EXPECT_TRUE(said(R"("axis": [0, 0, 1], "axis": 1)").ends_with("expected it once (joint 'hinge', line 11)"));
  EXPECT_EQ(said(R"("name ": 1)").rfind("(joint 'hinge', line 11)"), said(R"("name ": 1)").size() - 24);
}

TEST(SceneValidation, names_are_given_key_paths_and_lines) {
  const std::string text = R"j({"scene": 1,
"bodies": [{"name": "it's", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]},
  {"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
"joints": [{"type": "spherical", "bodies": ["ground", "it's"], "point": [0, 0, 0]},
  {"type": "spherical", "name": "b",
   "bodies": ["ground", "b"], "point": [0, 0, 0]}],
"forces": [{"type": "torque", "name": "motor", "body": "b", "torque": [0, 0, 1]},
  {"type": "torque", "name": "on body 'b'", "body": "b", "torque": [0, 0, 1]}
]})j";
  const Scene scene = parse_scene(text, "two.json");
  const auto placed = [&](const char* message) { return with_lines(with_key_paths(message, scene), text); };
  EXPECT_EQ(placed("body 'it's' is far"), "body 'it's' (/bodies/0, line 2) is far");
  EXPECT_EQ(placed("joint 'spherical1' (its row 2 of 3) follows from joint 'b', joint 'spherical1'"),
            "joint 'spherical1' (/joints/0, line 4; its row 2 of 3) follows from joint 'b' (/joints/1, line 5), joint "
            "'spherical1'");
  EXPECT_EQ(placed("at t = 1 s force 'motor', component y: '1/t' is not finite"),
            "at t = 1 s force 'motor' (/forces/0, line 7), component y: '1/t' is not finite");
  EXPECT_EQ(placed("force 'on body 'b'' turns body 'b'"),
            "force 'on body 'b'' (/forces/1, line 8) turns body 'b' (/bodies/1, line 3)");
  EXPECT_EQ(placed(with_key_paths("of joint 'b'; its row", scene).c_str()),
            "of joint 'b' (/joints/1, line 5); its row");
  EXPECT_EQ(with_lines("body 'it's' (/bodies/0) is far", nlohmann::json::parse(text).dump()),
            "body 'it's' (/bodies/0) is far");
  EXPECT_EQ(placed("joint 'none', antibody 'b' and '/tmp (/x)'"), "joint 'none', antibody 'b' and '/tmp (/x)'");
  EXPECT_EQ(with_key_paths("/joints/0/axis: found 1 (joint 'b')", scene), "/joints/0/axis: found 1 (joint 'b')");
}

// What is allowed in a file is allowed here, and means the same.
TEST(SceneValidation, takes_what_files_may_hold) {
  Scene scene = parse_scene(everything().dump(), "case.json");
  scene.joints[0].axis = Vector3(0, 0, 1e200);
  scene.bodies[0].orientation << 0.7071, -0.7071, 0, 0.7071, 0.7071, 0, 0, 0, 1;
  force<Spring>(scene, 2).stiffness = -5;
  scene.bodies[1].name = "Körper";
  const Model model = compile(scene);
  const Matrix3& A = model.bodies[0].orientation;
  EXPECT_LT((A.transpose() * A - Matrix3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(A(0, 0), std::sqrt(0.5), 1e-15);
  for (const Row& row : model.rows) {
    if (model.groups[static_cast<std::size_t>(row.group)].name == "revolute1" && row.type == RowType::DP1) {
      EXPECT_NEAR(row.a_j.norm(), 1, 1e-15);
    }
  }
}

TEST(SceneValidation, leaves_a_function_behind_where_an_expression_was_moved_from) {
  Scene scene = parse_scene(everything().dump(), "case.json");
  scene.drivers[1].value = std::move(scene.drivers[0].value);
  EXPECT_EQ(scene.drivers[0].value.at(1.0).f, scene.drivers[1].value.at(1.0).f);
}

}  // namespace
}  // namespace poinsot
