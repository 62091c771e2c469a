// The reader of scene files: what it makes of a good scene, and the exact sentence it answers to a bad one.
#include "core/scene_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/input_error.h"
#include "core/model.h"
#include "tests/scale.h"
#include "tests/support/without_place.h"

namespace poinsot {
namespace {

using Json = nlohmann::json;

std::string error_of(const std::string& text) {
  try {
    (void)parse_scene(text, "case.json");
  } catch (const InputError& error) {
    return test::without_place(error.what());
  }
  return "";
}

Json table() {
  std::ifstream in(POINSOT_SOURCE_DIR "/tests/scene_schema_test.json");
  return Json::parse(in);
}

// The table that also holds the JSON Schema to the reader.
TEST(SceneReader, answers_every_case_of_the_table) {
  const Json cases = table();
  for (const Json& c : cases["cases"]) {
    Json document = cases["base"];
    if (c.contains("set")) {
      for (const auto& [pointer, value] : c["set"].items()) document[Json::json_pointer(pointer)] = value;
    }
    if (c.contains("remove")) {
      for (const Json& pointer : c["remove"]) {
        const Json::json_pointer place(pointer.get<std::string>());
        document[place.parent_pointer()].erase(place.back());
      }
    }
    const std::string expected = c.contains("error") ? "case.json: " + c["error"].get<std::string>() : "";
    EXPECT_EQ(error_of(document.dump()), expected) << c["what"];
  }
}

// What no JSON document can hold: it is in the text.
TEST(SceneReader, answers_to_text_that_is_not_a_document) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "case.json: the file is empty"},
      {" \r\n\n", "case.json: the file is empty"},
      {"// nothing",
       "case.json: line 1, column 11: syntax error while parsing value - unexpected end of input; expected '[', "
       "'{', or a literal"},
      {"{\n  \"scene\": 1,\n  \"bodies\": [}\n}",
       "case.json: line 3, column 14: syntax error while parsing value - unexpected '}'; expected '[', '{', or a "
       "literal"},
      {"{\"scene\": 1} 2",
       "case.json: line 1, column 14: syntax error while parsing value - unexpected number literal; expected end of "
       "input"},
      {"{\"scene\": nothing}",
       "case.json: line 1, column 12: syntax error while parsing value - invalid literal; last "
       "read: '\"scene\": no'"},
      {"{\"scene\":\n NaN}", "case.json: /scene: found NaN, expected a finite number"},
      {"{\"x\": [1, {\"a\": -Infinity}]}", "case.json: /x/1/a: found -Infinity, expected a finite number"},
      {"{\"x\": [1, inf]}", "case.json: /x/1: found inf, expected a finite number"},
      {"nan", "case.json: /: found nan, expected a finite number"},
      {"{\"scene\": 1e999}", "case.json: /scene: found 1e999, expected a finite number"},
      {"{\"scene\": 1 /* not closed",
       "case.json: line 1, column 26: syntax error while parsing object - invalid "
       "comment; missing closing '*/'; last read: '1 /* not closed'; "
       "expected '}'"},
      {"{\"scene\": 1, \"scene\": 1}", "case.json: /scene: found the key twice, expected it once"},
      {"{\"scene\": 1, \"bodies\": [{}, {\"mass\": 1, \"name\": \"a\", \"mass\": 2}]}",
       "case.json: /bodies/1/mass: found the key twice, expected it once"},
      {"{\"x\": [[1, {\"a/b\": {\"k~\": 1, \"k~\": 1}}]]}",
       "case.json: /x/0/1/a~1b/k~0: found the key twice, expected it once"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(text), message);
}

TEST(SceneReader, names_the_line_of_a_number_that_is_none) {
  try {
    (void)parse_scene("{\"scene\":\n NaN}", "case.json");
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "case.json: /scene: found NaN, expected a finite number (line 2)");
  }
}

// As PowerShell and some editors write it; the mark that others put before UTF-8 means nothing.
TEST(SceneReader, says_that_a_text_is_in_utf16) {
  const std::string scene = R"({"scene": 1, "bodies": []})", expected =
                                                                 "case.json: found a text in UTF-16, expected "
                                                                 "UTF-8; save it as that";
  std::string little, big;
  for (const char c : scene) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  for (const std::string& text : {"\xff\xfe" + little, little, "\xfe\xff" + big, big})
    EXPECT_EQ(error_of(text), expected);
  EXPECT_EQ(error_of("\xef\xbb\xbf" + scene), error_of(scene));
}

TEST(SceneReader, survives_documents_nested_a_million_deep) {
  const auto depth = static_cast<std::size_t>(scaled(1'000'000));
  EXPECT_EQ(error_of(std::string(depth, '[') + std::string(depth, ']')),
            "case.json: /: found an array of 1 value, expected a scene as an object");
  EXPECT_NE(error_of(std::string(depth, '[')), "");
}

TEST(SceneReader, shortens_what_it_quotes) {
  std::string text;
  for (int k = 0; k < 60; ++k) text += "é";
  const std::string message = error_of("{\"scene\": \"" + text + "\"}");
  std::string quoted = "\"";
  for (int k = 0; k < 29; ++k) quoted += "é";
  EXPECT_EQ(message, "case.json: /scene: found " + quoted + "..., expected 1, the version of the format");
}

TEST(SceneReader, names_files_it_cannot_read) {
  const auto error = [](const char* file) -> std::string {
    try {
      (void)read_scene(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error("no/such/scene.json"), "no/such/scene.json: cannot be read: No such file or directory");
  EXPECT_EQ(error(POINSOT_SOURCE_DIR), POINSOT_SOURCE_DIR ": found a directory, expected a file");
}

TEST(SceneReader, reads_values_and_defaults) {
  const Scene scene = parse_scene(R"({ // comments of both kinds
    "scene": 1, /* are allowed */
    "bodies": [{"name": "a", "mass": "2*pi", "inertia": [4, 2, 0], "position": ["-4.61538", 1e-3, "sqrt(2)/2"]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 3, 4]},
               {"type": "revolute", "name": "hinge", "bodies": ["a", "ground"], "point": [0, 0, 0], "axis": [0, 0, 1]},
               {"type": "spherical", "bodies": ["ground", "a"], "point": [0, 0, 0]},
               {"type": "revolute", "bodies": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "forces": [{"type": "torque", "body": "a", "torque": [1, "t", "2*t^2"]}]})",
                                  "case.json");
  const Body& body = scene.bodies.at(0);
  EXPECT_EQ(body.mass, 2 * std::numbers::pi);
  EXPECT_EQ(body.position, Vector3(-4.61538, 1e-3, std::sqrt(2.0) / 2));
  EXPECT_EQ(body.inertia, Matrix3(Vector3(4, 2, 0).asDiagonal()));
  EXPECT_EQ(body.orientation, Matrix3::Identity());
  EXPECT_EQ(body.velocity, Vector3::Zero());
  EXPECT_EQ(scene.gravity, Vector3::Zero());
  EXPECT_EQ(scene.joints[0].axis, Vector3(0, 3, 4));
  EXPECT_EQ(scene.joints[0].i, kGround);
  EXPECT_EQ(scene.joints[0].j, 0);
  const Model model = compile(scene);
  EXPECT_TRUE(model.rows[3].a_j.isApprox(Vector3(0, 0.6, 0.8), 1e-15));
  const char* names[] = {"revolute1", "hinge", "spherical1", "revolute3"};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(model.groups[k].name, names[k]);
  EXPECT_EQ(model.torques[0].name, "torque1");
  const Torque& torque = std::get<Torque>(scene.forces[0]);
  EXPECT_EQ(torque.frame, Frame::body);
  EXPECT_EQ(torque.torque[2].at(3.0).f, 18);
}

// All four spellings of one rotation.
TEST(SceneReader, reads_orientations) {
  const double angle = 2 * std::numbers::pi / 3;  // about (1,1,1): x to y to z
  Matrix3 expected;
  expected << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_TRUE(Eigen::AngleAxisd(angle, Vector3::Ones().normalized()).toRotationMatrix().isApprox(expected, 1e-15));
  for (const char* spelling :
       {R"({"matrix": [[0,0,1],[1,0,0],[0,1,0]]})", R"({"euler_parameters": [0.5, 0.5, 0.5, 0.5]})",
        R"({"axis": [2, 2, 2], "angle": "2*pi/3"})", R"({"zxz": ["pi/2", "pi/2", 0]})"}) {
    const Scene scene = parse_scene(
        fmt::format(R"({{"scene": 1, "bodies": [{{"name": "a", "mass": 1, "inertia": [1,1,1], "position": [0,0,0],
                    "orientation": {}}}]}})",
                    spelling),
        "case.json");
    EXPECT_TRUE(scene.bodies[0].orientation.isApprox(expected, 1e-15)) << spelling;
  }
}

// A rotation written to 17 digits comes through to the last bit; one written to 4 digits is projected to the nearest.
TEST(SceneReader, projects_only_what_is_off) {
  const Matrix3 exact = (Eigen::AngleAxisd(0.3, Vector3::UnitZ()) * Eigen::AngleAxisd(1.1, Vector3::UnitX()) *
                         Eigen::AngleAxisd(-2.0, Vector3::UnitZ()))
                            .toRotationMatrix();
  const auto read = [&](int digits) {
    std::string rows;
    for (int r = 0; r < 3; ++r) {
      rows += fmt::format("{}[{:.{}f},{:.{}f},{:.{}f}]", r ? "," : "", exact(r, 0), digits, exact(r, 1), digits,
                          exact(r, 2), digits);
    }
    return compile(parse_scene(fmt::format(R"({{"scene": 1, "bodies": [{{"name": "a", "mass": 1, "inertia": [1,1,1],
                                           "position": [0,0,0], "orientation": {{"matrix": [{}]}}}}]}})",
                                           rows),
                               "case.json"))
        .bodies[0]
        .orientation;
  };
  EXPECT_EQ(read(20), exact);
  const Matrix3 projected = read(4);
  EXPECT_LT((projected - exact).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((projected.transpose() * projected - Matrix3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  // Nearest: the polar factor, whose product with what was given is symmetric.
  Matrix3 given;
  for (int k = 0; k < 9; ++k) given(k / 3, k % 3) = std::round(exact(k / 3, k % 3) * 1e4) / 1e4;
  const Matrix3 stretch = projected.transpose() * given;
  EXPECT_LT((stretch - stretch.transpose()).cwiseAbs().maxCoeff(), 1e-15);
}

// Nothing grows faster than the scene: 100 000 bodies and joints take seconds, quadratic work would take minutes.
TEST(SceneReader, reads_a_long_chain) {
  const int n = scaled(100'000);
  std::string bodies, joints;
  for (int k = 0; k < n; ++k) {
    bodies += fmt::format(R"({}{{"name":"rod{}","mass":1,"inertia":[1e-3,"1/12","1/12"],"position":[0,{},0]}})",
                          k ? "," : "", k, k + 0.5);
    joints += fmt::format(R"({}{{"type":"revolute","bodies":["{}","rod{}"],"point":[0,{},0],"axis":[1,0,0]}})",
                          k ? "," : "", k ? fmt::format("rod{}", k - 1) : "ground", k, k);
  }
  const std::string text = fmt::format(R"({{"scene": 1, "bodies": [{}], "joints": [{}]}})", bodies, joints);
  const auto start = std::chrono::steady_clock::now();
  const Model model = compile(parse_scene(text, "chain.json"));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(model.rows.size(), 5 * static_cast<std::size_t>(n));
  EXPECT_EQ(model.groups.back().name, fmt::format("revolute{}", n));
  EXPECT_LT(seconds.count(), 30) << "generous: it takes one second when optimized";
}

}  // namespace
}  // namespace poinsot
