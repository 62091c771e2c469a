// `poinsot check`: what it says of sound scenes, of redundant and of contradicting ones.
#include <fmt/format.h>

#include "command_line.h"

namespace poinsot::test {
namespace {

class Check : public CommandLine {
 protected:
  Result check_model(const char* name) const {
    return poinsot({"check", fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, name)});
  }
  // A rod between two points 2 m apart, held by more than it needs.
  std::string rod(const char* constraints) const {
    return fmt::format(R"({{"scene": 1, "name": "rod",
      "bodies": [{{"name": "rod", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}}],
      "constraints": [{}]}})",
                       constraints);
  }
  static void expect_says(const Result& result, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
  }
};

TEST_F(Check, SoundScenes) {
  const std::pair<const char*, int> degrees_of_freedom[] = {{"single_pendulum_joints", 0},
                                                            {"double_pendulum", 2},
                                                            {"four_link_haug", 0},
                                                            {"slider_crank_joints", 0},
                                                            {"heavy_top", 3},
                                                            {"free_body", 6},
                                                            {"knife_edge", 2}};
  for (const auto& [name, count] : degrees_of_freedom) {
    SCOPED_TRACE(name);
    const Result result = check_model(name);
    EXPECT_EQ(result.status, 0);
    // Of the four-link mechanism the study gives moments that no body has.
    const bool doubted = std::string(name) == "four_link_haug";
    EXPECT_EQ(result.err.find("principal moments 0, 2 and 4") != std::string::npos, doubted);
    EXPECT_EQ(result.err.empty(), !doubted) << result.err;
    expect_says(result,
                {fmt::format("degrees of freedom: {}\n", count), "redundant constraints: none\n",
                 "conflicting constraints: none\n", "initial pose: consistent", "initial velocities: consistent"});
    const std::size_t at = result.out.find("derivatives: ");
    ASSERT_NE(at, std::string::npos);
    // A body without constraints and forces has nothing to compare.
    EXPECT_EQ(std::stoi(result.out.substr(at + 13)) > 0, std::string(name) != "free_body") << result.out;
    expect_says(result, {" compared (rA, rp, reps), all right, largest relative difference "});
    EXPECT_TRUE(files().empty());
  }
}

// The program begins anew for it (app/large_pages.h), with the same arguments and in the same folder.
TEST_F(Check, ALargeFile) {
  write("rod.json", rod("") + std::string(5 << 20, ' '));
  const Result result = poinsot({"check", "rod.json"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  write("small.json", rod(""));
  EXPECT_EQ(result.out, poinsot({"check", "small.json"}).out);
  EXPECT_NE(result.out, "");
}

TEST_F(Check, ADerivativeThatIsNotFinite) {
  write("root.json", rod(R"({"type": "DP1", "name": "root", "bodies": ["ground", "rod"], "a_i": [1,0,0], "a_j": [0,1,0],
                             "f": "t^1.5"})"));
  const Result result = poinsot({"check", "root.json"});
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.err,
            "poinsot: root.json: at t = 0 s constraint 'root' (/constraints/0, line 3): the second derivative of "
            "'t^1.5' is not finite; the run begins there: change the function, or write (t + T) for t to begin at T\n");
  expect_says(result, {"  rA: constraint 'root' (/constraints/0, line 3): gamma is off by "});
}

TEST_F(Check, AStateOffTheConstraints) {
  const Result result = check_model("four_link");
  EXPECT_EQ(result.status, 0);
  expect_says(result, {"degrees of freedom: 0\n", "initial pose: violates constraint 'revD-CD-i' (/constraints/",
                       ") by 0.0087 m,", "initial velocities: violates constraint 'univ-CD-j' (/constraints/",
                       ") by 6.28 m/s,", "'link 3' most"});
}

TEST_F(Check, RedundantConstraintsByName) {
  const Result planar = check_model("double_four_bar");
  EXPECT_EQ(planar.status, 0);
  expect_says(planar, {"joint 'revolute7' (/joints/6, line 38) leaves free: turning about its axis\n",
                       "degrees of freedom: 1\n", "redundant constraints: 6 rows\n",
                       "joint 'revolute7' (its row 3 of 5) follows from", "conflicting constraints: none\n"});

  write("twice.json",
        rod(R"({"type": "D", "name": "first", "bodies": ["ground", "rod"], "s_i": [-1,0,0], "s_j": [0,0,0], "f": 4},
                             {"type": "D", "name": "again", "bodies": ["ground", "rod"], "s_i": [-1,0,0], "s_j": [0,0,0], "f": 4})"));
  const Result twice = poinsot({"check", "twice.json"});
  EXPECT_EQ(twice.status, 0) << twice.err;
  expect_says(
      twice,
      {"degrees of freedom: 5\n", "redundant constraints: 1 row\n",
       "constraint 'again' (/constraints/1, line 4) follows from constraint 'first' (/constraints/0, line 3)\n"});
}

TEST_F(Check, ConflictingConstraintsByName) {
  write("torn.json",
        rod(R"({"type": "D", "name": "first", "bodies": ["ground", "rod"], "s_i": [-1,0,0], "s_j": [0,0,0], "f": 4},
                            {"type": "D", "name": "other", "bodies": ["ground", "rod"], "s_i": [-1,0,0], "s_j": [0,0,0], "f": 9})"));
  const Result torn = poinsot({"check", "torn.json"});
  EXPECT_EQ(torn.status, 2);
  EXPECT_EQ(torn.err, "poinsot: torn.json: the constraints conflict; remove or correct one of those named\n");
  expect_says(torn, {"redundant constraints: none\n", "conflicting constraints: 1 row\n",
                     "constraint 'other' (/constraints/1, line 4) contradicts constraint 'first' (/constraints/0, line "
                     "3): off by 1.25 m (position) where those hold\n"});

  write(
      "pulled.json",
      rod(R"({"type": "CD", "name": "still", "bodies": ["ground", "rod"], "c": [1,0,0], "s_i": [1,0,0], "s_j": [0,0,0]},
                              {"type": "CD", "name": "pull", "bodies": ["ground", "rod"], "c": [1,0,0], "s_i": [1,0,0], "s_j": [0,0,0], "f": "t"})"));
  const Result pulled = poinsot({"check", "pulled.json"});
  EXPECT_EQ(pulled.status, 2);
  expect_says(pulled, {"constraint 'pull' (/constraints/1, line 4) contradicts constraint 'still' (/constraints/0, "
                       "line 3): off by 1 m/s (velocity) where those hold\n"});
}

// Sound, but nobody would mean it: told by check and by run, with what it is about, where it stands and by how much.
TEST_F(Check, WhatNobodyWouldMean) {
  const auto scene = [](const std::string& body, const std::string& more, const char* gravity = "[0, 0, -9.81]") {
    return fmt::format(R"({{"scene": 1, "name": "odd", "gravity": {},
"bodies": [{{"name": "rod", "mass": 1, "inertia": [1, 1, 1], "position": [0.35, 0, 0]}},
{}],
{}}})",
                       gravity, body, more);
  };
  const std::string arm = R"({"name": "arm", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]})";
  const std::string held = R"("joints": [{"type": "spherical", "bodies": ["ground", "rod"], "point": [0, 0, 0]},
{"type": "spherical", "name": "upper arm", "bodies": ["rod", "arm"], "point": [)";
  std::string ungoverned = scene(arm, held + "0.7, 0, 0]}]");
  ungoverned.erase(ungoverned.find("\"gravity\""), 25);
  const std::pair<std::string, std::string> cases[] = {
      {scene(R"({"name": "disk", "mass": 1, "inertia": [1, 1, 5], "position": [1, 0, 0]})", R"("forces": [])"),
       "body 'disk' (/bodies/1, line 3) has the principal moments 1, 1 and 5, and no body has one that exceeds"},
      {scene(R"({"name": "ship", "mass": 1e7, "inertia": [1, 1, 1], "position": [1, 0, 0]})", R"("forces": [])"),
       "masses are six orders of magnitude apart: 1 kg of 'rod', 1e+07 kg of 'ship'"},
      {scene(arm, R"("joints": [{"type": "spherical", "bodies": ["rod", "arm"], "point": [0.3500001, 0, 0]}])"),
       "lengths are six orders of magnitude apart: 'rod' is held 1e-07 m from its centre of mass, 'arm' 0.65 m"},
      {scene(arm, held + "7.0, 0, 0]}]"),
       "joint 'upper arm' (/joints/1, line 5) is far from its bodies: 6.65 m from 'rod' and 6 m from 'arm', where the "
       "mechanism without it measures 0.65 m; is its point meant?"},
      {ungoverned, "the scene has joints and says nothing of gravity, so there is none"},
      {scene(arm, R"("forces": [{"type": "force", "name": "push", "body": "rod", "point": [0, 0, 0],
"force": ["1e200*t + 1e200", 0, 0]}])"),
       "force 'push' (/forces/0, line 4) has a component of 1e+200, whose square is beyond the numbers of a computer"}};
  for (const auto& [text, sentence] : cases) {
    SCOPED_TRACE(sentence);
    write("odd.json", text);
    const Result checked = poinsot({"check", "odd.json"}), ran = poinsot({"run", "odd.json", "--end", "0.01"});
    EXPECT_EQ(checked.status, 0);
    EXPECT_NE((checked.err + checked.out).find(sentence), std::string::npos) << checked.err << checked.out;
    EXPECT_NE(ran.err.find(sentence), std::string::npos) << ran.err;
    EXPECT_EQ(ran.err.find("smaller step"), std::string::npos) << ran.err;
  }
  expect_says(poinsot({"check", "odd.json"}), {"mass: 2 kg; extent: 0.65 x 0 x 0 m; gravity: [0, 0, -9.81] m/s2\n"});
  write("odd.json", scene(arm, held + "0.7, 0, 0]}]"));
  expect_says(poinsot({"check", "odd.json"}),
              {"joint 'upper arm' (/joints/1, line 5) leaves free: turning about every"});
}

TEST_F(Check, QuantitiesWithUnitsAndPlaces) {
  write("tie.json", rod(R"({"type": "D", "name": "tie_rod", "bodies": ["ground", "rod"], "s_i": [0,0,0],
    "s_j": [0,0,0], "f": 1.242})"));
  const Result tie = poinsot({"check", "tie.json"});
  EXPECT_EQ(tie.status, 2);
  expect_says(tie, {"initial pose: violates constraint 'tie_rod' (/constraints/0, line 3) by 0.242 m², the most"});
  EXPECT_EQ(tie.err,
            "poinsot: tie.json: the initial pose violates constraint 'tie_rod' (/constraints/0, line 3) by 0.114 m, "
            "more than the 0.01 m that is put right unasked; correct the scene, or have it projected onto the "
            "constraints with `poinsot run --assemble`, whose --save-state keeps it\n");
  // And what it says helps where a command has no such option.
  const std::vector<std::string> reference{"reference", "tie.json", "--end", "0.01", "--cache", "cache", "--quiet"};
  EXPECT_EQ(poinsot(reference).err, tie.err);
  ASSERT_EQ(poinsot({"run", "tie.json", "--assemble", "--end", "1e-9", "--save-state", "kept.json", "--quiet"}).status,
            0);
  write("tie.json", read("kept.json"));
  EXPECT_EQ(poinsot(reference).status, 0);
  // The eighteenth joint.
  std::string joints, bodies;
  for (int k = 0; k < 18; ++k) {
    bodies += fmt::format("{}\n{{\"name\": \"b{}\", \"mass\": 1, \"inertia\": [1, 1, 1], \"position\": [{}, 0, 0]}}",
                          k == 0 ? "" : ",", k, k);
    joints += fmt::format("{}\n{{\"type\": \"spherical\", {}\"bodies\": [\"ground\", \"b{}\"], \"point\": [{}, 0, 0]}}",
                          k == 0 ? "" : ",", k == 17 ? "\"name\": \"upper arm\", " : "", k, k == 17 ? 500 : k);
  }
  write("long.json",
        fmt::format("{{\"scene\": 1, \"gravity\": [0, 0, 0], \"bodies\": [{}],\n\"joints\": [{}]}}", bodies, joints));
  EXPECT_NE(poinsot({"run", "long.json", "--end", "0.01"}).err.find("joint 'upper arm' (/joints/17, line 38)"),
            std::string::npos);
  write("empty.json", "");
  EXPECT_EQ(poinsot({"check", "empty.json"}).err, "poinsot: empty.json: the file is empty\n");
}

TEST_F(Check, ASceneWithoutANameIsCalledByItsFile) {
  std::string nameless = kPendulum;
  nameless.erase(nameless.find("\"name\": \"pendulum\","), 19);
  write("swing.json", nameless);
  const Result checked = poinsot({"check", "swing.json"}), ran = poinsot({"run", "swing.json", "--end", "0.01"});
  EXPECT_TRUE(checked.out.starts_with("swing.json: 1 body, ")) << checked.out;
  EXPECT_TRUE(ran.out.starts_with("swing.json: dynamics, ")) << ran.out;
  EXPECT_EQ(shell("poinsot check - < swing.json > said"), 0);
  EXPECT_TRUE(read("said").starts_with("standard input: 1 body, ")) << read("said");
}

// What comes but once has lines, too.
TEST_F(Check, LinesOfTheStandardInputAndOfPipes) {
  write("off.json", rod(R"({"type": "D", "name": "tie", "bodies": ["ground", "rod"], "s_i": [-1,0,0], "s_j": [0,0,0],
                             "f": "4 - t"})"));
  const std::string expected = "constraint 'tie' (/constraints/0, line 3) by 1 m²/s";
  for (const char* command : {"poinsot check - < off.json > said", "cat off.json | poinsot check - > said",
                              "mkfifo pipe; (cat off.json > pipe & poinsot check pipe > said)"}) {
    EXPECT_EQ(shell(command), 0) << command;
    EXPECT_NE(read("said").find(expected), std::string::npos) << command << '\n' << read("said");
  }
}

}  // namespace
}  // namespace poinsot::test
