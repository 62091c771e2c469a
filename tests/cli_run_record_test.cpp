// The record beside what `poinsot run` writes: how the numbers came to be, so that they can be made again.
#include <fmt/format.h>

#include "command_line.h"
#include "core/provenance.h"
#include "integrators/settings_reader.h"

namespace poinsot::test {
namespace {

using RunRecord = CommandLineWithPendulum;

// A door on three hinges that hold it too often.
TEST_F(RunRecord, TheRecordSaysWhichReactionsAreNotDetermined) {
  const std::string door = fmt::format("{}/models/door.json", POINSOT_SOURCE_DIR);
  const Result result = poinsot({"run", door, "--end", "0.01", "--out", "door.csv", "--reactions", "r.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json record = read_json("door.run.json");
  EXPECT_EQ(record["reactions_undetermined"], true);
  EXPECT_EQ(record["undetermined_reactions"], (std::vector<std::string>{"lower", "middle", "upper"}));
  // No hinge takes a moment about its axis.
  for (const char* hinge : {"lower", "middle", "upper"})
    EXPECT_EQ(record["undetermined_components"][hinge], (std::vector<std::string>{"fx", "fy", "fz", "nx", "ny"}))
        << hinge;
  // The table says it behind the reactions themselves, of every sample.
  const std::vector<std::string> table = lines(read("r.csv"));
  std::string header = "t", flags;
  for (const char* hinge : {"lower", "middle", "upper"}) {
    for (const char* component : {"fx", "fy", "fz", "nx", "ny", "nz"})
      header += fmt::format(",{}.{}", hinge, component);
  }
  for (const char* hinge : {"lower", "middle", "upper"}) {
    for (const char* component : {"fx", "fy", "fz", "nx", "ny", "nz"})
      header += fmt::format(",{}.{}.undetermined", hinge, component);
    flags += ",1,1,1,1,1,0";
  }
  ASSERT_GT(table.size(), 2u);
  EXPECT_EQ(table[0], header);
  for (std::size_t k = 1; k < table.size(); ++k) EXPECT_TRUE(table[k].ends_with(flags)) << table[k];
}

// A plate that hangs straight down on three rods of one length and swings: at the start one of its multipliers is the
// only one, later none is.
TEST_F(RunRecord, ReactionsThatAreUndeterminedLaterAreSaid) {
  write("plate.json", R"j({"scene": 1, "gravity": [0, -9.81, 0], "bodies": [{"name": "plate", "mass": 2,
      "inertia": [0.1, 0.2, 0.25], "position": [0, -1, 0], "velocity": [1.5, 0, 0]}], "constraints": [
    {"name": "c0", "type": "CD", "bodies": ["ground", "plate"], "c": [0, 0, 1], "s_i": [0, 0, 0], "s_j": [0, 0, 0]},
    {"name": "c1", "type": "DP1", "bodies": ["ground", "plate"], "a_i": [0, 0, 1], "a_j": [1, 0, 0]},
    {"name": "c2", "type": "DP1", "bodies": ["ground", "plate"], "a_i": [0, 0, 1], "a_j": [0, 1, 0]},
    {"name": "c3", "type": "D", "bodies": ["ground", "plate"], "s_i": [-0.4, 0, 0], "s_j": [-0.4, 0, 0], "f": 1},
    {"name": "c4", "type": "D", "bodies": ["ground", "plate"], "s_i": [0.3, 0, 0], "s_j": [0.3, 0, 0], "f": 1},
    {"name": "c5", "type": "D", "bodies": ["ground", "plate"], "s_i": [0.1, 0, 0.2], "s_j": [0.1, 0, 0.2], "f": 1}]})j");
  const Result result =
      poinsot({"run", "plate.json", "--end", "0.2", "--every", "0.1", "--out", "p.csv", "--reactions", "r.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> table = lines(read("r.csv"));
  std::string header = "t";
  for (const char* what : {"lambda", "lambda.undetermined"})
    for (int k = 0; k < 6; ++k) header += fmt::format(",c{}.{}", k, what);
  ASSERT_EQ(table.size(), 4u);
  EXPECT_EQ(table[0], header);
  EXPECT_TRUE(table[1].ends_with(",0,0,1,1,1,1")) << table[1];
  for (std::size_t later = 2; later < table.size(); ++later)
    EXPECT_TRUE(table[later].ends_with(",0,1,1,1,1,1")) << table[later];
  EXPECT_EQ(read_json("p.run.json")["undetermined_reactions"],
            (std::vector<std::string>{"c1", "c2", "c3", "c4", "c5"}));
}

TEST_F(RunRecord, TheRecordSaysWhereTheNumbersComeFrom) {
  const Result result = poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "0.1", "--out",
                                 "a.csv", "--reactions", "r.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"a.csv", "a.run.json", "pendulum.json", "r.csv"}));
  const nlohmann::json record = read_json("a.run.json");
  EXPECT_EQ(record["status"], "ok");
  EXPECT_EQ(record["incomplete"], false);
  EXPECT_EQ(record["message"], "");
  EXPECT_EQ(record["accuracy"], "not estimated");
  EXPECT_EQ(record["reactions_undetermined"], false);
  EXPECT_EQ(record["undetermined_reactions"], nlohmann::json::array());
  EXPECT_GT(record["statistics"]["largest_rotation"], 0);
  EXPECT_EQ(record["statistics"]["acceleration_error"]["index"], 3);  // steps of 1 ms are long enough for that
  EXPECT_GT(record["statistics"]["acceleration_error"]["acceleration"], 0);
  EXPECT_GT(record["statistics"]["acceleration_error"]["multiplier"], 0);
  EXPECT_FALSE(record.contains("verify"));
  EXPECT_EQ(record["scene"], nlohmann::json::parse(kPendulum, nullptr, true, true));
  EXPECT_EQ(record["scene_file"], "pendulum.json");
  const Provenance& origin = provenance();
  EXPECT_EQ(record["program"]["version"], origin.version);
  EXPECT_EQ(record["program"]["commit"], origin.commit);
  EXPECT_EQ(record["program"]["compiler"], origin.compiler);
  EXPECT_EQ(record["program"]["flags"], origin.flags);
  EXPECT_EQ(record["program"]["libraries"].size(), origin.libraries.size());
  EXPECT_EQ(record["processor"], processor());
  for (const SettingEntry& entry : setting_entries())
    EXPECT_EQ(record["configuration"].contains(entry.key),
              entry.key != "assemble" && !std::holds_alternative<const MethodParameter*>(entry.member))
        << entry.key;

  const nlohmann::json& statistics = record["statistics"];
  ASSERT_EQ(statistics["linear"].size(), 1);
  const nlohmann::json& linear = statistics["linear"][0];
  EXPECT_EQ(linear["solver"], "block");  // auto's pick
  EXPECT_EQ(linear["system"], "whole");
  EXPECT_EQ(linear["factorizations"].get<int>() + linear["refactorizations"].get<int>(), statistics["factorizations"]);
  EXPECT_EQ(linear["solves"], statistics["solves"]);
  EXPECT_EQ(linear["refinements"], 0);
  EXPECT_GT(linear["condition"], 1);
  EXPECT_FALSE(linear.contains("handed_over_by"));
  EXPECT_EQ(statistics["steps"], 100);
  for (const char* count : {"newton_iterations", "jacobian_evaluations", "factorizations", "solves"})
    EXPECT_GE(statistics[count], 100) << count;
  double sum = 0;
  for (const char* phase : {"assembly", "factor", "solve", "other"}) {
    EXPECT_GT(statistics["seconds"][phase], 0) << phase;
    sum += statistics["seconds"][phase].get<double>();
  }
  EXPECT_NEAR(sum, statistics["seconds"]["total"].get<double>(), 1e-9);
  EXPECT_LT(statistics["violation"]["position"], 1e-7);
  EXPECT_TRUE(statistics["violation"].contains("velocity"));
}

TEST_F(RunRecord, TheRecordedConfigurationRepeatsTheRun) {
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "2/3", "--step", "1/300",
                     "--formulation", "rp", "--no-assemble", "--out", "a.csv"})
                .status,
            0);
  write("again.json", read_json("a.run.json")["configuration"].dump());
  const Result again = poinsot({"run", "pendulum.json", "--config", "again.json", "--out", "b.csv"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(read("a.csv") == read("b.csv"));
}

}  // namespace
}  // namespace poinsot::test
