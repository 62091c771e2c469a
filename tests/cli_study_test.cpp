// `poinsot study`: one table, byte by byte, however it was computed: by threads, shards, ranks, in one go or after
// kills.
#include <fmt/format.h>

#include <chrono>
#include <csignal>

#include "command_line.h"
#include "tests/scale.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

const int kMany = std::max(400, scaled(800));  // samples, of two cases each, which take a while and much room

class CliStudy : public CommandLine {
 protected:
  CliStudy() {
    write("pendulum.json", R"({"scene": 1, "name": "pendulum", "parameters": {"l": 1}, "gravity": [0, 0, -9.81],
      "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, "l", 0]}],
      "joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})");
    write_study(40, 0.02);
  }

  void write_study(int samples, double end, const std::string& more = "") const {
    write("study.json", fmt::format(R"({{"study": 1, "seed": 7, "scenes": ["pendulum.json"],
      "settings": {{"integrator": "implicit_euler", "step": 1e-3, "end": {}}},
      "vary": [{{"samples": {}, "parameters": {{"l": {{"uniform": [0.5, 2]}}}}}},
               {{"setting": "formulation", "values": ["rA", "rp"]}}],
      "keep": [{{"column": "rod.y", "take": ["min", "range"], "at": [0.01]}}, {{"column": "hinge.fz"}},
               {{"column": "hinge.angle"}}, "violation", "energy_drift", "counts"]{}}})",
                                    end, samples, more));
  }
  Result study(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"study", "study.json", "--quiet"});
    return poinsot(arguments);
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& why) const {
    const Result result = study(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  }
  std::string reference() const {
    const Result result = study({"--threads", "1", "--out", "reference"});
    EXPECT_EQ(result.status, 0) << result.err;
    return read("reference/cases.csv");
  }
};

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

TEST_F(CliStudy, ThreadsShardsAndRanksGiveTheSameBytes) {
  const std::string expected = reference();
  ASSERT_EQ(study({"--threads", "2", "--out", "two"}).status, 0);
  EXPECT_EQ(read("two/cases.csv"), expected);
  for (const char* shard : {"3/3", "1/3", "2/3"})
    ASSERT_EQ(study({"--threads", "1", "--shard", shard, "--out", fmt::format("of_{}", shard[0])}).status, 0);
  ASSERT_EQ(study({"--merge", "of_2", "--merge", "of_3", "--merge", "of_1", "--out", "merged"}).status, 0);
  EXPECT_EQ(read("merged/cases.csv"), expected);
  // In one folder the parts of shards are merged in place.
  for (const char* shard : {"2/2", "1/2"}) ASSERT_EQ(study({"--shard", shard, "--out", "both"}).status, 0);
  EXPECT_FALSE(fs::exists(folder() / "both/cases.csv"));
  ASSERT_EQ(study({"--merge", "both", "--out", "both"}).status, 0);
  EXPECT_EQ(read("both/cases.csv"), expected);
}

TEST_F(CliStudy, MissingAndRepeatedShardsAreTold) {
  for (const char* shard : {"1/3", "3/3"}) ASSERT_EQ(study({"--shard", shard, "--out", "parts"}).status, 0);
  expect_refused({"--merge", "parts", "--out", "m"},
                 "27 of 80 cases have no row, the first is case 1; of 3 shards 2 is not among the parts given");
  expect_refused({"--merge", "parts", "--merge", "parts/shard-1-of-3.part", "--out", "m"}, "is given twice");
  fs::copy(folder() / "parts/shard-1-of-3.part", folder() / "again.part");
  expect_refused({"--merge", "parts", "--merge", "again.part", "--out", "m"},
                 " stands in parts/shard-1-of-3.part and in again.part; expected each shard once");
  expect_refused({"--merge", "none", "--out", "m"}, "there is no such file");
  expect_refused({"--shard", "4/3", "--out", "m"}, "--shard: found \"4/3\", expected I/N");
  write_study(40, 0.03);
  expect_refused({"--merge", "parts/shard-1-of-3.part", "--out", "m"},
                 "80 of 80 cases have no row, the first is case 0; 27 rows are of cases that the study does not have: "
                 "it or a scene was changed since");
  EXPECT_FALSE(fs::exists(folder() / "m"));
}

TEST_F(CliStudy, ASceneThatIsThereTwiceIsToldOnce) {
  write("study.json", R"({"study": 1, "scenes": ["pendulum.json", "pendulum.json"], "keep": ["counts"]})");
  EXPECT_EQ(study({"--out", "out"}).err,
            "poinsot: study.json: /scenes/1: there is a scene 'pendulum' already, expected another name\n");
}

TEST_F(CliStudy, RanksGiveTheSameBytes) {
  if (shell("mpirun --version > .said.mpi 2>&1") != 0)
    GTEST_SKIP() << "mpirun was not found: studies across processes are not looked at";
  const std::string expected = reference();
  // MPI itself leaves memory behind, and mpirun of Open MPI 4.1 can wait for one of its own threads for good once all
  // ranks have ended: it is then started again.
  const auto run = [&](int ranks, const std::string& out) {
    int status = 0;
    for (int tries = 0; tries < 3; ++tries) {
      status = shell(
          fmt::format("ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                      "timeout 120 mpirun --oversubscribe -n {} '{}' study study.json --quiet --out {} 2> .said.mpi",
                      ranks, POINSOT_PROGRAM, out));
      if (status != 124) break;
    }
    return status;
  };
  for (const int ranks : {1, 4}) {
    const std::string out = fmt::format("ranks_{}", ranks);
    const int status = run(ranks, out);
    const std::string said = read(".said.mpi");
    if (said.find("built without MPI") != std::string::npos) GTEST_SKIP() << said;
    ASSERT_EQ(status, 0) << said;
    EXPECT_EQ(read(out + "/cases.csv"), expected);
  }
  // Wrong input ends all of them.
  write("study.json", "{}");
  const int status = run(3, "wrong");
  EXPECT_NE(status, 0);
  EXPECT_NE(status, 124);
  EXPECT_NE(read(".said.mpi").find("study.json: /study: found nothing"), std::string::npos);
}

TEST_F(CliStudy, AKillLosesTheCasesUnderWayAndNoMore) {
  write_study(kMany, 0.02);
  const std::string expected = reference();
  std::uintmax_t before = 0;
  for (int kills = 0; kills < 3; ++kills) {
    const pid_t child = start({"study", "study.json", "--threads", "2", "--quiet", "--out", "killed"});
    const fs::path part = folder() / "killed/cases.part";
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while ((!fs::exists(part) || fs::file_size(part) < before + 20'000) && std::chrono::steady_clock::now() < deadline)
      usleep(500);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_FALSE(fs::exists(folder() / "killed/cases.csv"));
    EXPECT_EQ(read_json("killed/cases.run.json")["status"], "running");
    ASSERT_GT(fs::file_size(part), before);
    before = fs::file_size(part);
    if (kills == 1) {  // as a disk leaves it that lost its power: a torn row, and a row that is damaged
      fs::resize_file(part, before - 11);
      std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(1000);
      file.put('#');
    }
  }
  const std::size_t rows = lines(read("killed/cases.part")).size();
  ASSERT_EQ(study({"--threads", "2", "--out", "killed"}).status, 0);
  EXPECT_EQ(read("killed/cases.csv"), expected);
  EXPECT_GE(lines(read("killed/cases.part")).size(), static_cast<std::size_t>(2 * kMany + 2));
  EXPECT_GT(rows, 100u);
  // What is there is not computed again.
  const auto size = fs::file_size(folder() / "killed/cases.part");
  ASSERT_EQ(study({"--out", "killed"}).status, 0);
  EXPECT_EQ(fs::file_size(folder() / "killed/cases.part"), size);
}

TEST_F(CliStudy, AnInterruptedStudyEndsTidilyAndGoesOn) {
  write_study(kMany, 0.02);
  const pid_t child = start({"study", "study.json", "--threads", "1", "--out", "out"});
  const fs::path part = folder() / "out/cases.part";
  while (!fs::exists(part) || fs::file_size(part) < 20'000) usleep(500);
  EXPECT_EQ(study({"--out", "out"}).status, 2);  // one at a time
  kill(child, SIGINT);
  const Result result = finish(child);
  EXPECT_EQ(result.status, 130);
  EXPECT_TRUE(result.err.starts_with("poinsot: interrupted by SIGINT: ")) << result.err;
  const nlohmann::json record = read_json("out/cases.run.json");
  EXPECT_EQ(record["incomplete"], true);
  const std::string message = record["message"];
  EXPECT_TRUE(message.starts_with("interrupted by SIGINT: ") &&
              message.find(fmt::format(" of {} cases are there", 2 * kMany)) != std::string::npos)
      << message;
  EXPECT_NE(result.err.find("poinsot: " + message + "\n"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(folder() / "out/cases.csv"));
  ASSERT_EQ(study({"--out", "out"}).status, 0);
  EXPECT_EQ(read("out/cases.csv"), reference());
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

// As the user of the tests, and where that is root as nobody, too.
TEST_F(CliStudy, AFullDiskKeepsTheRowsThereWasRoomFor) {
  write_study(kMany, 0.02);
  const std::string expected = reference();
  do {
    SCOPED_TRACE(program());
    fs::remove_all(folder() / "out");
    EXPECT_EQ(shell("trap '' XFSZ; ulimit -f 64; poinsot study study.json --quiet --out out 2> .said.full"), 3);
    const std::string said = read(".said.full");
    EXPECT_NE(said.find("out/cases.part: cannot be written: "), std::string::npos) << said;
    const nlohmann::json record = read_json("out/cases.run.json");
    EXPECT_EQ(record["status"], "interrupted");
    EXPECT_EQ(record["incomplete"], true);
    EXPECT_EQ("poinsot: " + record["message"].get<std::string>() + "\n", said);
    const std::size_t rows = record["cases"]["computed"];
    EXPECT_GT(rows, 100u);
    EXPECT_EQ(lines(read("out/cases.part")).size(), rows + 2);  // and its head
    ASSERT_EQ(study({"--out", "out"}).status, 0);
    EXPECT_EQ(read("out/cases.csv"), expected);
    EXPECT_EQ(read_json("out/cases.run.json")["status"], "ok");
  } while (program() == POINSOT_PROGRAM && become_nobody());
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
