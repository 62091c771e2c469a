// `poinsot tables`, `figures` and `scale` when they are interrupted: what was measured is kept beside what stands
// there, until it is measured whole.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>

#include "support/interrupted.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

using InterruptedMeasuring = Interrupted;

// Processes that work in the folder.
std::size_t processes(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::error_code other;
    count += fs::read_symlink(entry.path() / "cwd", other) == folder;
  }
  return count;
}

TEST_P(InterruptedMeasuring, TablesFiguresAndScaleLeaveNothingHalf) {
  for (const char* command : {"tables", "figures", "scale"}) {
    SCOPED_TRACE(command);
    fs::remove_all(folder() / "out");
    const pid_t child = start({command, "--out", "out"});
    ASSERT_TRUE(wait_for([&] { return exists("out"); }));
    usleep(200000);
    kill(child, SIGTERM);
    const Result result = finish(child);
    EXPECT_EQ(result.status, 143);
    EXPECT_TRUE(result.err.starts_with("poinsot: interrupted by SIGTERM")) << result.err;
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
    EXPECT_TRUE(wait_for([&] { return processes(folder()) == 0; })) << "something goes on by itself";
  }
}

TEST_P(InterruptedMeasuring, TablesAndScaleKeepWhatWasMeasuredBesideWhatStandsThere) {
  const std::tuple<const char*, std::string, std::string> commands[] = {
      {"tables", "tables.md", "kinematics_phases.csv"}, {"scale", "scaling.md", "scaling.csv"}};
  for (const auto& [command, page, table] : commands) {
    SCOPED_TRACE(command);
    fs::remove_all(folder() / "out");
    ASSERT_EQ(shell("mkdir out; echo whole > out/" + page), 0);
    Result result;
    for (int seconds = 1; !exists("out/interrupted") && seconds < 60; seconds *= 3) {  // on a machine that is busy
      const pid_t child = start({command, "--out", "out"});
      sleep(static_cast<unsigned>(seconds));
      kill(child, SIGINT);
      result = finish(child);
      EXPECT_EQ(result.status, 130);
    }
    ASSERT_TRUE(exists("out/interrupted"));
    EXPECT_EQ(result.err, "poinsot: interrupted by SIGINT; what was measured up to there is kept in out/interrupted\n");
    EXPECT_NE(read("out/interrupted/" + page).find("Incomplete, interrupted by SIGINT"), std::string::npos);
    const std::vector<std::string> rows = lines(read("out/interrupted/" + table));
    EXPECT_GT(rows.size(), 7u);
    EXPECT_EQ(std::ranges::count(rows, "# incomplete: interrupted by SIGINT"), 1);
    EXPECT_EQ(read("out/" + page), "whole\n");
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
    EXPECT_TRUE(wait_for([&] { return processes(folder()) == 0; })) << "something goes on by itself";
  }
}

// A signal that is sent to the program alone, as `kill` does, not to all that a terminal runs.
TEST_P(InterruptedMeasuring, WhatDrawsEndsWithTheProgram) {
  fs::create_directory(folder() / "bin");
  write("bin/python3", "#!/bin/sh\n: > drawing\nexec sleep 90\n");
  fs::permissions(folder() / "bin/python3", fs::perms(0755));
  const std::string path = std::getenv("PATH");
  setenv("PATH", fmt::format("{}:{}", (folder() / "bin").string(), path).c_str(), 1);
  const pid_t child = start({"figures", "solution_deltas", "--quick", "--out", "out"});
  setenv("PATH", path.c_str(), 1);
  ASSERT_TRUE(wait_for([&] { return exists("drawing"); }));
  EXPECT_EQ(processes(folder()), 2u);
  kill(child, SIGINT);
  EXPECT_EQ(finish(child).status, 130);
  EXPECT_TRUE(wait_for([&] { return processes(folder()) == 0; })) << "the drawing goes on by itself";
}

INSTANTIATE_TEST_SUITE_P(As, InterruptedMeasuring, testing::ValuesIn(kUsers), name_of_user);

}  // namespace
}  // namespace poinsot::test
