// `poinsot make` and `poinsot scale`: generated scene files, and the files of the scaling study; not how fast anything
// is.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "command_line.h"
#include "core/scene_generator.h"
#include "integrators/settings_reader.h"

namespace poinsot::test {
namespace {

using Make = CommandLine;
using Scale = CommandLine;

TEST_F(Make, WritesScenesThatRun) {
  for (const SceneGenerator& generator : scene_generators()) {
    const std::string name(generator.name);
    ASSERT_EQ(poinsot({"make", name, "--bodies", "6", "--out", name + ".json"}).status, 0);
    const Result run = poinsot({"run", name + ".json", "--end", "0.01", "--out", name + "_motion.csv"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "") << "a generated scene starts on its constraints";
  }
}

TEST_F(Make, WritesToTheStandardOutputUnlessToldWhere) {
  const Result result = poinsot({"make", "chain", "--bodies", "1"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(result.out.starts_with("{\n  \"scene\": 1,\n  \"name\": \"chain of 1 bodies\""));
}

TEST_F(Make, SaysWhatItCannotMake) {
  const Result structure = poinsot({"make", "web", "--out", "a.json"});
  EXPECT_EQ(structure.status, 2);
  EXPECT_EQ(structure.err, "poinsot: STRUCTURE: found \"web\", expected one of chain, tree, ladder, four_bars\n");
  const Result bodies = poinsot({"make", "chain", "--bodies", "0", "--out", "a.json"});
  EXPECT_EQ(bodies.status, 2);
  EXPECT_EQ(bodies.err, "poinsot: --bodies: found 0, expected a whole number from 1 to 10000000\n");
  EXPECT_TRUE(files().empty());
}

TEST_F(Scale, MeasuresEverySizeOfEveryStructure) {
  const Result result = poinsot({"scale", "--bodies", "100", "--formulations", "rA,rp", "--linear-solvers", "block,klu",
                                 "--repetitions", "1", "--out", "results"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::size_t rows = 0;
  for (const std::string& line : lines(read("results/scaling.csv"))) {
    if (line.starts_with("#") || line.starts_with("structure")) continue;
    ++rows;
    const auto f = fields(line);
    ASSERT_EQ(f.size(), 11u) << line;
    const double phases = std::stod(f[5]) + std::stod(f[6]) + std::stod(f[7]) + std::stod(f[8]);
    EXPECT_NEAR(phases, std::stod(f[4]), 0.003 + 1e-3 * std::abs(phases)) << line;
  }
  EXPECT_EQ(rows, scene_generators().size() * 2 * 2 * 3);
  EXPECT_NE(read("results/scaling.md").find("processor: "), std::string::npos);
}

TEST_F(Scale, ExponentsFollowFromTheTable) {
  const Result result = poinsot({"scale", "--bodies", "1000", "--formulations", "rA", "--linear-solvers", "block",
                                 "--repetitions", "1", "--out", "results"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(read("results/scaling_plot.png").starts_with("\x89PNG"));
  EXPECT_NE(read("results/scaling_plot.svg").find("memory, kB per body"), std::string::npos);
  struct Cell {
    double bodies, us;  // of an iteration, by body
  };
  std::map<std::string, std::vector<Cell>> cells;  // by structure
  for (const std::string& line : lines(read("results/scaling.csv"))) {
    if (line.starts_with('#') || line.starts_with("structure,")) continue;
    const auto f = fields(line);
    if (std::stod(f[3]) < 100) continue;
    cells[f[0]].push_back({std::stod(f[3]), std::stod(f[4])});
  }
  EXPECT_EQ(cells.size(), scene_generators().size());
  std::size_t rows = 0;
  for (const std::string& line : lines(read("results/growth.csv"))) {
    if (line.starts_with('#') || line.starts_with("structure,")) continue;
    const auto f = fields(line);
    const auto& two = cells.at(f[0]);
    ASSERT_EQ(two.size(), 2u);
    const double decade = std::log(two[1].bodies / two[0].bodies);
    const double rounding = 5e-4 + 5e-4 * (1 / two[0].us + 1 / two[1].us) / decade;  // three digits behind the point
    EXPECT_NEAR(std::stod(f[3]), 1 + std::log(two[1].us / two[0].us) / decade, 1.5 * rounding) << line;
    EXPECT_EQ(f[8], "-") << "memory takes two scenes of 1000 bodies and more";
    ++rows;
  }
  // Times are differences of two runs, and nothing is fitted to those that other work on the machine has made negative.
  const auto measured = [](const auto& of) {
    return std::ranges::all_of(of.second, [](const Cell& c) { return c.us > 0; });
  };
  EXPECT_EQ(rows, static_cast<std::size_t>(std::ranges::count_if(cells, measured)));
  EXPECT_GT(rows, 0u);
}

TEST_F(Scale, WhatAnInterruptionLeftIsGoneWhenAllIsMeasured) {
  std::filesystem::create_directories(folder() / "results/interrupted");
  for (const char* file : {"scaling.md", "scaling.csv", "growth.csv", "tables.md"})  // the last is of another command
    write(fmt::format("results/interrupted/{}", file), "a part\n");
  const auto measure = [&] {
    const Result result = poinsot(
        {"scale", "--bodies", "10", "--formulations", "rA", "--repetitions", "1", "--quiet", "--out", "results"});
    expect_drawn(result);
  };
  measure();
  EXPECT_FALSE(std::filesystem::exists(folder() / "results/interrupted/scaling.md"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "results/interrupted/scaling.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "results/interrupted/growth.csv"));
  EXPECT_EQ(read("results/interrupted/tables.md"), "a part\n");
  std::filesystem::rename(folder() / "results/interrupted/tables.md", folder() / "results/interrupted/scaling.md");
  measure();
  EXPECT_FALSE(std::filesystem::exists(folder() / "results/interrupted"));
}

TEST_F(Scale, SaysWhatItDoesNotKnow) {
  const Result result = poinsot({"scale", "--linear-solvers", "block,magic", "--out", "results"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err,
            fmt::format("poinsot: --linear-solvers: found \"magic\", expected one or more of {}, with commas "
                        "between\n",
                        fmt::join(find_setting("linear_solver")->names(), ", ")));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace poinsot::test
