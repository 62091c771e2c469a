// What a scene file says by name: parameters and their values from outside, tables in files, and that the text kept of
// a scene is that scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/input_error.h"
#include "core/printable.h"
#include "core/scene_reader.h"
#include "core/varied_scene.h"
#include "tests/support/without_place.h"

namespace poinsot {
namespace {

using testing::ElementsAre;
namespace fs = std::filesystem;

class SceneLanguage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("poinsot_scene_language_" + std::to_string(getpid()) +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  Scene read(const ParameterValues& set = {}) const { return read_scene(folder_ / "scene.json", set); }
  std::string error(const ParameterValues& set = {}) const {
    try {
      (void)read(set);
    } catch (const InputError& refused) {
      const std::string what = refused.what(), where = folder_.string() + "/";
      std::string text;
      for (std::size_t at = 0; at < what.size();) {
        const bool here = what.compare(at, where.size(), where) == 0;
        if (!here) text += what[at];
        at += here ? where.size() : 1;
      }
      return test::without_place(text);
    }
    return "";
  }
  // A pendulum with a driver: `angle` is an expression, `sections` stand before the bodies.
  void write_scene(const std::string& sections, const std::string& mass, const std::string& angle) const {
    write("scene.json", R"({"scene": 1, "gravity": [0, 0, -9.81], )" + sections +
                            R"("bodies": [{"name": "rod", "mass": ")" + mass +
                            R"(", "inertia": [1, 1, 0.1], "position": [1, 0, 0]}],
      "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [0, 0, 1], "angle": ")" +
                            angle + "\"}]}");
  }

  fs::path folder_;
};

TEST_F(SceneLanguage, parameters_use_one_another_in_any_order) {
  write_scene(R"("parameters": {"a": "2*b", "b": "c + 1", "c": 2},)", "a", "c*t");
  const Scene scene = read();
  EXPECT_EQ(scene.bodies[0].mass, 6);
  EXPECT_EQ(scene.drivers[0].value.at(2.0).f, 4);
  ASSERT_EQ(scene.parameters.size(), 3u);
  EXPECT_EQ(scene.parameters[0].value, 6);
  EXPECT_THAT(scene.notices, ElementsAre());
}

TEST_F(SceneLanguage, what_is_set_takes_the_place_of_what_the_file_says) {
  write_scene(R"("parameters": {"a": "2*b", "b": "c + 1", "c": 2},)", "a", "c*t");
  const Scene scene = read({{"b", "c*pi"}, {"c", "1/2"}});
  EXPECT_NEAR(scene.bodies[0].mass, M_PI, 1e-15);
  EXPECT_FALSE(scene.parameters[0].set);
  EXPECT_TRUE(scene.parameters[1].set);
  EXPECT_TRUE(scene.parameters[2].set);
  const Scene again = parse_scene(scene.source, "again.json");
  EXPECT_EQ(again.bodies[0].mass, scene.bodies[0].mass);
  EXPECT_NE(scene.source, read().source);  // what depends on the source depends on the values

  EXPECT_EQ(error({{"d", "1"}}), "scene.json: /: there is no parameter 'd' to set; the scene has a, b, c");
  EXPECT_EQ(
      error({{"c", "1 +"}}),
      "scene.json: /parameters/c: found \"1 +\" (expected a number, a name or '(' at character 4, found the end), "
      "expected a number or a string holding a constant expression");
  EXPECT_EQ(error({{"c", "a"}}),
            "scene.json: /parameters/a: found a circle, a needs b needs c needs a; expected a value that does not need "
            "itself");
  write_scene("", "1", "t");
  EXPECT_EQ(error({{"c", "1"}}), "scene.json: /: there is no parameter 'c' to set; the scene has none");
}

TEST_F(SceneLanguage, a_scene_is_varied_without_its_files) {
  write_scene(R"("parameters": {"a": 2, "b": "3*a", "scale": 1}, "tables": {"f": {"file": "f.csv"}},)", "b",
              "scale*f(t)");
  write("f.csv", "0,0\n1,1\n2,0\n");
  const Scene scene = read({{"scale", "2"}});
  fs::remove(folder_ / "f.csv");
  for (const double a : {0.1, 1.0, 1e-300}) {
    const Scene varied = with_parameters(scene, {{"a", a}});
    EXPECT_EQ(varied.bodies[0].mass, 3 * a);
    EXPECT_EQ(varied.drivers[0].value.at(1.0).f, 2);
    EXPECT_TRUE(varied.parameters[0].set);
    EXPECT_FALSE(varied.parameters[1].set);
    EXPECT_TRUE(varied.parameters[2].set);
  }
  EXPECT_THROW((void)with_parameters(scene, {{"m", 1}}), InputError);
  EXPECT_THROW((void)with_parameters(Scene(), {{"m", 1}}), InputError);
}

// What calls no parameter is not read again, and the rest is as if everything were.
TEST_F(SceneLanguage, many_values_read_again_what_calls_them) {
  write_scene(
      R"("parameters": {"a": 2, "b": "3*a", "scale": 1}, "tables": {"f": {"points": [[0, 0], [1, "a"], [2, 0]]}},)",
      "b", "scale*f(t)");
  const Scene scene = read();
  VariedScene varied(scene);
  for (const double a : {0.5, 7.0, 1e-3}) {
    const Scene &one = varied.with({{"a", a}}), other = with_parameters(scene, {{"a", a}});
    EXPECT_EQ(one.bodies[0].mass, 3 * a);
    EXPECT_EQ(one.drivers[0].value.at(1.0).f, a);
    EXPECT_EQ(one.notices, other.notices);
    EXPECT_EQ(varied.source(), other.source);
    ASSERT_EQ(one.parameters.size(), other.parameters.size());
    for (std::size_t k = 0; k < one.parameters.size(); ++k) {
      EXPECT_EQ(one.parameters[k].value, other.parameters[k].value);
      EXPECT_EQ(one.parameters[k].set, other.parameters[k].set);
    }
  }
  try {
    (void)varied.with({{"a", -1}});
    ADD_FAILURE() << "a mass below zero";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/bodies/0/mass: found -3, expected a positive number (body '"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(varied.with({{"a", 1}}).bodies[0].mass, 3);
}

TEST_F(SceneLanguage, tables_come_from_columns_of_files) {
  write_scene(R"("tables": {"f": {"file": "data/f.csv", "columns": [0, 2]}},)", "1", "f(t)");
  fs::create_directory(folder_ / "data");
  write("data/f.csv", "\xef\xbb\xbftime; angle; angle\r\n# s; deg; rad\r\n\r\n0;0;0\r\n1;9;+0.5\r\n3;9; 1e0 \r\n");
  const Scene scene = read();
  EXPECT_EQ(scene.drivers[0].value.at(1.0).f, 0.5);
  EXPECT_NEAR(scene.drivers[0].value.at(3.0).f, 1, 1e-15);
  EXPECT_TRUE(std::isnan(scene.drivers[0].value.at(3.1).f));
  fs::remove_all(folder_ / "data");
  EXPECT_EQ(parse_scene(scene.source, "again.json").drivers[0].value.at(1.7).f, scene.drivers[0].value.at(1.7).f);
}

TEST_F(SceneLanguage, what_is_wrong_in_a_file_is_told_with_its_line) {
  write_scene(R"("tables": {"f": {"file": "f.csv"}},)", "1", "f(t)");
  const auto refused = [&](const std::string& text) {
    write("f.csv", text);
    return error();
  };
  const std::string where = "scene.json: /tables/f/file: f.csv: ";
  EXPECT_EQ(refused("t,x\n0,0\n1,one\n"), where + "line 3: column 1 holds 'one', expected a number");
  EXPECT_EQ(refused("0,zero\n1,1\n"), where + "line 1: column 1 holds 'zero', expected a number");
  EXPECT_EQ(refused("0,0\n1\n"), where + "line 2: there is no column 1; columns are counted from 0");
  EXPECT_EQ(refused("0,0\n2,1\n\n2,3\n"), where + "line 4: column 0 holds 2, expected more than 2, the x before it");
  EXPECT_EQ(refused("0,0\n1,nan\n"), where + "line 2: column 1 holds 'nan', expected a number");
  EXPECT_EQ(refused("0,0\n1,\x1b[31m\n"), where + "line 2: column 1 holds '\\u001b[31m', expected a number");
  EXPECT_EQ(refused("t,x\n"), where + "found no line with numbers in columns 0 and 1, expected at least 2 lines");
  EXPECT_EQ(refused("0,0\n"), where + "found 1 line with numbers in columns 0 and 1, expected at least 2 lines");
}

TEST_F(SceneLanguage, names_that_nothing_uses_are_told) {
  write_scene(R"("parameters": {"a": 1, "b": "a"}, "tables": {"f": {"points": [[0, 0], [1, 1]]}},)", "1", "t");
  EXPECT_THAT(read().notices, ElementsAre("parameter 'b' is used nowhere", "table 'f' is used nowhere"));
}

TEST_F(SceneLanguage, joints_without_a_word_of_gravity_are_told) {
  const std::string rest = R"("bodies": [{"name": "rod", "mass": 1, "inertia": [1, 1, 0.1], "position": [1, 0, 0]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "rod"], "point": [0, 0, 0]}]})";
  EXPECT_THAT(parse_scene(R"({"scene": 1, )" + rest, "a.json").notices,
              ElementsAre(testing::StartsWith("the scene has joints and says nothing of gravity")));
  EXPECT_THAT(parse_scene(R"({"scene": 1, "gravity": [0, 0, 0], )" + rest, "a.json").notices, ElementsAre());
}

TEST(Printable, writes_control_characters_out) {
  EXPECT_EQ(printable("a\x1b[31m\n\x7f"), "a\\u001b[31m\\u000a\\u007f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m \xc3\xa9 \xe2\x82\xac \\"),
            "\\u009b31m \xc3\xa9 \xe2\x82\xac \\");
  EXPECT_EQ(printable("\xff\xc2"), "\xff\xc2");
}

}  // namespace
}  // namespace poinsot
