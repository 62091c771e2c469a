// `poinsot advise`: what it recommends runs as it stands and is as accurate as it says; not how fast anything is.
#include <cmath>

#include "command_line.h"

namespace poinsot::test {
namespace {

class Advise : public CommandLine {
 protected:
  Result advise(const std::string& scene, std::vector<std::string> more) const {
    more.insert(more.begin(), {"advise", scene, "--cache", "cache"});
    return poinsot(more);
  }

  // The words of the command in the advice, without the program's name.
  static std::vector<std::string> command(const std::string& advice) {
    for (const std::string& line : lines(advice)) {
      if (!line.starts_with("  poinsot ")) continue;
      std::vector<std::string> words;
      std::stringstream stream(line.substr(10));
      for (std::string word; stream >> word;) words.push_back(word);
      return words;
    }
    return {};
  }

  // The largest difference of the rod's position from the reference, m.
  double error(std::vector<std::string> run, const std::string& scene) const {
    run.insert(run.end(), {"--out", "advised.csv"});
    EXPECT_EQ(poinsot(run).status, 0);
    EXPECT_EQ(
        poinsot({"reference", scene, "--end", "1", "--every", "1/20", "--cache", "cache", "--out", "exact.csv"}).status,
        0);
    const auto ours = lines(read("advised.csv")), exact = lines(read("exact.csv"));
    EXPECT_EQ(ours.size(), exact.size());
    double largest = 0;
    for (std::size_t row = 1; row < std::min(ours.size(), exact.size()); ++row)
      for (std::size_t column = 1; column < 4; ++column)
        largest =
            std::max(largest, std::abs(std::stod(fields(ours[row])[column]) - std::stod(fields(exact[row])[column])));
    return largest;
  }
};

TEST_F(Advise, WhatItRecommendsIsAsAccurateAsAsked) {
  write("pendulum.json", kPendulum);  // its positions are of size 1
  for (const char* accuracy : {"1e-3", "1e-9"}) {
    const Result result = advise("pendulum.json", {"--accuracy", accuracy, "--end", "1"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_LE(error(command(result.out), "pendulum.json"), std::stod(accuracy)) << result.out;
  }
}

TEST_F(Advise, TakesKinematicsWhereNothingIsFree) {
  std::string scene = kPendulum;
  scene.insert(scene.rfind('}'), R"--(, "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [1, 0, 0],
      "angle": "sin(t)"}])--");
  write("driven.json", scene);
  const Result result = advise("driven.json", {"--end", "1"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("kinematics in "), std::string::npos) << result.out;
  EXPECT_LE(error(command(result.out), "driven.json"), 1e-6);
}

TEST_F(Advise, SaysSoWhereNothingReachesIt) {
  write("pendulum.json", kPendulum);
  const Result result = advise("pendulum.json", {"--accuracy", "1e-18", "--end", "1"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("poinsot: note: 1e-18 cannot be checked: in position the reference resolves "),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.out.find("nothing reaches 1e-18 in position to t = 1 s; the most accurate was "), std::string::npos);
}

TEST_F(Advise, NamesWhatCostsWithoutMattering) {
  std::string scene = kPendulum;
  scene.replace(scene.find("\"bodies\": [{\"name\": \"rod\""), 11, R"("bodies": [
    {"name": "rail", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]},
    {"name": "stone", "mass": 1, "inertia": [1, 1, 1], "position": [5, 0, 0]}, )");
  scene.insert(scene.rfind(']'),
               R"(, {"type": "fixed", "name": "weld", "bodies": ["ground", "rail"], "point": [0, 0, 0]},
    {"type": "spherical", "name": "again", "bodies": ["ground", "rod"], "point": [0, 0, 0]})");
  write("scene.json", scene);
  const Result result = advise("scene.json", {"--accuracy", "1e-3", "--end", "0.5"});
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* sentence : {"not moving: 'rail'", "never turning: 'stone'", "3 of 14 constraint rows follow",
                               "joint 'weld' makes one body of two"})
    EXPECT_NE(result.out.find(std::string("costs without mattering: ") + sentence), std::string::npos)
        << sentence << "\n"
        << result.out;
}

// It is at the same place and at rest at each of the times compared.
TEST_F(Advise, DoesNotTakeAShakenBodyForAStillOne) {
  std::string scene = kPendulum;
  scene.insert(scene.find("{\"name\": \"rod\""), R"({"name": "stone", "mass": 1, "inertia": [1, 2, 3],
      "position": [5, 0, 0], "angular_velocity": [1, 1, 1]}, )");
  scene.insert(scene.rfind('}'), R"--(, "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [1, 0, 0],
      "angle": "0.3*sin(20*pi*t)*sin(20*pi*t)"}])--");
  write("shaken.json", scene);
  const Result result = advise("shaken.json", {"--accuracy", "1e-3", "--end", "1"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.find("costs without mattering"), std::string::npos) << result.out;
}

TEST_F(Advise, SaysWhatIsWrong) {
  write("pendulum.json", kPendulum);
  const auto says = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const Result result = advise("pendulum.json", arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, "poinsot: " + message + "\n");
  };
  says({"--accuracy", "2"}, "--accuracy: found \"2\", expected a number between 0 and 0.01");
  says({"--of", "speed"},
       "--of: found \"speed\", expected one or more of position, velocity, acceleration, multiplier, with commas "
       "between");
  says({"--of", "position,velocity,position"}, "--of: found \"position\" twice, expected each name once");
  std::string free_body = kPendulum;
  free_body.erase(free_body.find("\"joints\"") - 4, free_body.rfind(']') + 1 - (free_body.find("\"joints\"") - 4));
  write("conflicting.json", kConflicting);
  const Result wrong = advise("conflicting.json", {});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(wrong.err.starts_with("poinsot: conflicting.json: the constraints conflict: ")) << wrong.err;
  write("pendulum.json", free_body);
  says({"--of", "position,multiplier"}, "--of: found \"multiplier\", but the scene has no constraints");
}

}  // namespace
}  // namespace poinsot::test
