// `poinsot study`: the table, its rows and what is said of them, and the pictures of it.
#include <fmt/format.h>

#include "support/study_command.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

TEST_F(CliStudy, OneRowForEachCaseWithWhatIsKept) {
  const std::vector<std::string> rows = lines(reference());
  ASSERT_EQ(rows.size(), 81u);
  EXPECT_EQ(rows[0],
            "case,scene,bodies,l,formulation,status,rod.y.min,rod.y.range,rod.y@0.01,hinge.fz.final,hinge.angle.final,"
            "violation_position,violation_velocity,energy_drift,steps,newton_iterations,factorizations,message");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::vector<std::string> f = fields(rows[k]);
    ASSERT_GE(f.size(), 17u);
    EXPECT_EQ(f[0], std::to_string(k - 1));
    EXPECT_EQ(f[4], k % 2 == 1 ? "rA" : "rp");
    EXPECT_EQ(f[5], "ok");
    EXPECT_EQ(f[14], "20");
    // The rod begins at y = l; it falls by half of α t², α = m g l/(m l² + J).
    const double l = std::stod(f[3]), alpha = 3 * 9.81 * l / (3 * l * l + 1);
    EXPECT_NEAR(std::stod(f[10]), -alpha * 0.02 * 0.02 / 2, 0.06 * alpha * 0.02 * 0.02 / 2);
    EXPECT_LT(std::stod(f[8]), l);
  }
  const nlohmann::json record = read_json("reference/cases.run.json");
  EXPECT_EQ(record["incomplete"], false);
  EXPECT_EQ(record["cases"]["computed"], 80);
  EXPECT_TRUE(record["program"].contains("commit"));
  // The case alone gives the same numbers.
  const std::vector<std::string> third = fields(rows[3]);
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--set", "l=" + third[3], "--integrator", "implicit_euler", "--step",
                     "1e-3", "--end", "0.02", "--out", "a.csv"})
                .status,
            0);
  EXPECT_EQ(std::stod(fields(lines(read("a.csv"))[11])[2]), std::stod(third[8]));
}

TEST_F(CliStudy, ASceneThatIsThereTwiceIsToldOnce) {
  write("study.json", R"({"study": 1, "scenes": ["pendulum.json", "pendulum.json"], "keep": ["counts"]})");
  EXPECT_EQ(study({"--out", "out"}).err,
            "poinsot: study.json: /scenes/1: there is a scene 'pendulum' already, expected another name\n");
}

TEST_F(CliStudy, ATenthIsPartOfTheWholeAndAChangedStudyKeepsWhatItStillAsksFor) {
  const std::vector<std::string> expected = lines(reference());
  ASSERT_EQ(study({"--quick", "--out", "out"}).status, 0);
  const std::vector<std::string> quick = lines(read("out/cases.csv"));
  ASSERT_EQ(quick.size(), 9u);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(quick[k + 1], expected[1 + k / 2 * 22 + k % 2]);
  ASSERT_EQ(study({"--out", "out"}).status, 0);
  EXPECT_EQ(lines(read("out/cases.csv")), expected);
  const auto rows = [&] { return lines(read("out/cases.part")).size(); };
  const std::size_t before = rows();
  write_study(50, 0.02);  // ten samples more
  ASSERT_EQ(study({"--out", "out"}).status, 0);
  EXPECT_EQ(rows(), before + 20);
  EXPECT_EQ(lines(read("out/cases.csv")).size(), 101u);
  write_study(50, 0.03);
  ASSERT_EQ(study({"--out", "out"}).status, 0);
  EXPECT_EQ(rows(), before + 120);
}

TEST_F(CliStudy, TellsWhatNoCaseLooksAt) {
  const auto told = [&](const std::string& settings, const std::string& vary) {
    write("study.json", fmt::format(R"({{"study": 1, "scenes": ["pendulum.json"], "settings": {{"end": 0.01{}}},
      "vary": [{{"setting": "formulation", "values": ["rA", "rp"]}}{}], "keep": ["counts"]}})",
                                    settings, vary));
    const Result result = poinsot({"study", "study.json", "--fresh", "--out", "out"});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  const std::string note = "poinsot: note: study.json: ", by = "which controls its error by rtol and atol";
  EXPECT_EQ(told(R"(, "step": 1e-3, "retry": false)", ""),
            note + "/settings/step, /settings/retry mean nothing to integrator auto, " + by + "\n");
  EXPECT_EQ(read_json("out/cases.run.json")["notices"].size(), 1u);
  EXPECT_EQ(told(R"(, "step": 1e-3)", R"(, {"setting": "integrator", "values": ["dop853", "radau5"]})"),
            note + "/settings/step means nothing to integrator dop853, " + by + "; integrator radau5, " + by + "\n");
  EXPECT_EQ(told(R"(, "step": 1e-3)", R"(, {"setting": "integrator", "values": ["dop853", "rattle"]})"), "");
  EXPECT_EQ(told(R"(, "integrator": "rattle")", R"(, {"setting": "rtol", "values": [1e-6, 1e-8]})"),
            note + "/vary/1 means nothing to integrator rattle, whose accuracy follows from its step\n");
  EXPECT_EQ(told(R"(, "rtol": 1e-6)", R"(, {"setting": "rtol", "values": [1e-6, 1e-8]})"),
            note + "/settings/rtol means nothing to the cases, as /vary/1 varies it\n");
}

TEST_F(CliStudy, AFailingCaseIsARow) {
  write("study.json", R"({"study": 1, "scenes": ["pendulum.json"],
    "settings": {"step": 1e-3, "end": 0.01, "max_iterations": 1, "tolerance": 1e-13, "retry": false},
    "vary": [{"setting": "formulation", "values": ["rA", "reps"]},
             {"setting": "integrator", "values": ["implicit_euler", "dopri5", "generalized_alpha"]}],
    "keep": [{"column": "rod.y"}]})");
  const Result result = poinsot({"study", "study.json", "--out", "out"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("6 cases, ")) << result.out;
  const std::vector<std::string> rows = lines(read("out/cases.csv"));
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_NE(rows[1].find(",not_converged,,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[1].find("try"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find(",ok,"), std::string::npos) << rows[2];
  EXPECT_GE(read_json("out/cases.run.json")["cases"]["failed"], 2);
  // A parameter that makes no scene.
  write("bad.json", R"({"study": 1, "scenes": ["m.json"], "settings": {"end": 0.01},
    "vary": [{"parameter": "m", "values": [1, -1, 2]}], "keep": [{"column": "b.z"}]})");
  write("m.json", R"({"scene": 1, "parameters": {"m": 1}, "gravity": [0, 0, -1],
    "bodies": [{"name": "b", "mass": "m", "inertia": [1, 1, 1], "position": [0, 0, 0]}],
    "forces": [{"type": "force", "name": "pull", "body": "b", "point": [0, 0, 0], "force": ["2*sqrt(2.005 - m - t)*m", 0, 0]
}]
})");
  ASSERT_EQ(poinsot({"study", "bad.json", "--quiet", "--out", "bad"}).status, 0);
  const std::vector<std::string> bad = lines(read("bad/cases.csv"));
  EXPECT_NE(bad[2].find(",input_error,,"), std::string::npos) << bad[2];
  EXPECT_TRUE(bad[2].ends_with("expected a positive number (body 'b', line 2)\"")) << bad[2];
  // Of those asked for, whatever the folder holds of others.
  EXPECT_TRUE(poinsot({"study", "bad.json", "--quick", "--out", "bad"}).out.starts_with("1 case, 0 failed\n"));
  EXPECT_EQ(read_json("bad/cases.run.json")["cases"]["failed"], 0);
  const std::string picture = R"(, "pictures": [{"file": "p", "points": {"x": "m", "y": "b.z.final"}}]})";
  const std::string text = read("bad.json");
  write("bad.json", text.substr(0, text.rfind('}')) + picture);
  poinsot({"study", "bad.json", "--quiet", "--out", "bad"});
  EXPECT_NE(read("bad/study.md").find("\nOf 3 cases 2 failed: numbers and pictures are of the others.\n"),
            std::string::npos)
      << read("bad/study.md");
  EXPECT_NE(bad[3].find("force 'pull' (/forces/0, line 3), component x"), std::string::npos) << bad[3];
  // And what is wrong in the study itself.
  write("bad.json", "{\"study\": 1, \"scenes\": [\"m.json\"],\n \"keep\": [{\"column\": \"c.z\"}]}");
  EXPECT_TRUE(poinsot({"study", "bad.json"}).err.ends_with("line 2)\n")) << poinsot({"study", "bad.json"}).err;
}

TEST_F(CliStudy, TimesAreMeasuredAloneAndSaidToBe) {
  write_study(2, 0.02, R"(, "repetitions": 3)");
  std::string text = read("study.json");
  text.replace(text.find("\"counts\""), 8, "\"seconds\", \"errors\"");
  write("study.json", text);
  expect_refused({"--threads", "2", "--out", "out"}, "--threads: found 2, expected 1: the study measures time");
  expect_refused({"--shard", "1/2", "--out", "out"}, "--shard: expected none: the study measures time");
  EXPECT_FALSE(fs::exists(folder() / "out"));
  ASSERT_EQ(study({"--out", "out", "--cache", "cache"}).status, 0);
  const std::vector<std::string> names = fields(lines(read("out/cases.csv"))[0]);
  for (const std::string& row : lines(read("out/cases.csv"))) {
    if (row.starts_with("case")) continue;
    const std::vector<std::string> f = fields(row);
    const auto of = [&](const std::string& name) {
      return std::stod(f[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())]);
    };
    EXPECT_GT(of("seconds"), 0);
    EXPECT_LT(of("seconds_assembly") + of("seconds_factor") + of("seconds_solve"), 2 * of("seconds"));
    EXPECT_GT(of("error_position"), 1e-9);
    EXPECT_LT(of("error_position"), 1e-2);
  }
  const nlohmann::json record = read_json("out/cases.run.json");
  EXPECT_EQ(record["timing"]["repetitions"], 3);
  EXPECT_EQ(record["timing"]["one_at_a_time"], true);
}

// Of a scene that says no name, too: it is called by its file.
TEST_F(CliStudy, AnUnknownColumnIsToldWithItsPlaceAndTheScene) {
  write("bare.json",
        R"({"scene": 1, "bodies": [{"name": "rod", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}]})");
  write("study.json", R"({"study": 1, "scenes": ["bare.json"], "keep": ["violation", {"column": "rod.y"},
    {"column": "wheel.y"}]})");
  expect_refused({"--out", "out"},
                 "poinsot: study.json: /keep/2/column: scene 'bare' has no column 'wheel.y', expected one of the "
                 "trajectory, the reactions or the signals of a run (line 2)\n");
}

// Samples are a cloud, and so are several values in one place; counts stand on zero.
TEST_F(CliStudy, WhatDoesNotFollowAlongXIsNotJoined) {
  write("study.json", R"({"study": 1, "seed": 7, "scenes": ["pendulum.json"],
    "settings": {"integrator": "implicit_euler", "step": 1e-3, "end": 0.01},
    "vary": [{"parameter": "l", "values": [1, 2]}, {"setting": "formulation", "values": ["rA", "rp"]}],
    "keep": [{"column": "rod.y"}],
    "pictures": [{"file": "sweep", "points": {"x": "l", "y": "rod.y.final", "series": "formulation"}},
                 {"file": "both", "points": {"x": "l", "y": "rod.y.final"}},
                 {"file": "results", "points": {"x": "rod.y.final", "y": "l", "series": "formulation"}},
                 {"file": "counts", "histogram": "rod.y.final", "bins": 2}]})");
  study({"--out", "out"});
  const auto joined = [&](const std::string& file) {
    const std::string text = read(file), key = "\n# joined: ";
    const std::size_t at = text.find(key);
    return at == text.npos ? "" : text.substr(at + key.size(), text.find('\n', at + 1) - at - key.size());
  };
  EXPECT_EQ(joined("out/sweep.csv"), "yes");
  EXPECT_EQ(joined("out/both.csv"), "no");
  EXPECT_EQ(joined("out/results.csv"), "no");
  const std::vector<std::string> counts = lines(read("out/counts.csv"));
  ASSERT_GT(counts.size(), 6u);
  EXPECT_EQ(fields(counts[1])[4], "0");
  EXPECT_EQ(fields(counts[2])[4], "2");
  EXPECT_EQ(fields(counts[6])[4], "0");
  write_study(3, 0.01, R"(, "pictures": [{"file": "drawn", "points": {"x": "l", "y": "rod.y.min",
    "series": "formulation"}}])");
  study({"--out", "samples"});
  EXPECT_EQ(joined("samples/drawn.csv"), "no");
}

TEST_F(CliStudy, APictureThatIsNotDrawnIsNoSuccess) {
  write_study(4, 0.02, R"(, "pictures": [{"file": "lengths", "title": "l", "histogram": "rod.y.min"}])");
  fs::create_directories(folder() / "out" / "lengths.svg");  // in its place
  const Result result = study({"--out", "out"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("picture was drawn"), std::string::npos) << result.err;
  EXPECT_EQ(lines(read("out/cases.csv")).size(), 9u);
}

TEST_F(CliStudy, TheExamplesRunInTheirQuickForm) {
  const fs::path studies = fs::path(POINSOT_SOURCE_DIR) / "bench/studies";
  const std::pair<const char*, std::size_t> examples[] = {{"tolerances", 1000}, {"coupler_curve", 15}};
  for (const auto& [name, cases] : examples) {
    const Result result =
        poinsot({"study", (studies / fmt::format("{}.json", name)).string(), "--quick", "--quiet", "--out", name});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::vector<std::string> rows = lines(read(fmt::format("{}/cases.csv", name)));
    EXPECT_EQ(rows.size(), cases + 1);
    for (std::size_t k = 1; k < rows.size(); ++k) ASSERT_NE(rows[k].find(",ok,"), std::string::npos) << rows[k];
    EXPECT_TRUE(fs::exists(folder() / name / "study.md"));
  }
}

}  // namespace
}  // namespace poinsot::test
