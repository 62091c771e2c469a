// Interrupted and killed: what was computed is kept in complete rows and marked, nothing half-written remains, and the
// exit status says by which signal. As the user of the tests, and where that is root as nobody, too.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>

#include "support/interrupted.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

const std::vector<std::string> kLongRun{"run", "pendulum.json", "--end", "1e6",         "--every",
                                        "1",   "--out",         "a.csv", "--reactions", "r.csv"};

TEST_P(Interrupted, ARunKeepsWhatWasComputed) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"},
                                     {SIGTERM, "SIGTERM"},
                                     {SIGQUIT, "SIGQUIT"},
                                     {SIGHUP, "SIGHUP"},
                                     {SIGXCPU, "SIGXCPU"},
                                     {SIGUSR1, "SIGUSR1"}}) {
    SCOPED_TRACE(name);
    for (const char* file : {"a.csv", "r.csv", "a.run.json"}) fs::remove(folder() / file);
    const pid_t child = start(kLongRun);
    ASSERT_TRUE(wait_for([&] { return exists("a.run.json") && exists("r.csv") && size("a.csv") > 0; }));
    kill(child, signal);
    const Result result = finish(child);
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_TRUE(result.err.starts_with(fmt::format("poinsot: interrupted by {}", name))) << result.err;
    EXPECT_NE(result.err.find("; what was computed up to there is kept\n"), std::string::npos) << result.err;
    EXPECT_EQ(files(), (std::vector<std::string>{"a.csv", "a.run.json", "pendulum.json", "r.csv"}));
    expect_complete_rows("a.csv");
    expect_complete_rows("r.csv");
    EXPECT_EQ(lines(read("a.csv")).size(), lines(read("r.csv")).size());
    const nlohmann::json record = read_json("a.run.json");
    EXPECT_EQ(record["status"], "interrupted");
    EXPECT_EQ(record["incomplete"], true);
    EXPECT_EQ("poinsot: " + record["message"].get<std::string>() + "\n", result.err);
    EXPECT_GT(record["statistics"]["steps"], 0);
    EXPECT_LT(std::stod(fields(lines(read("a.csv")).back())[0]), record["failure_time"].get<double>() + 1e-9);
  }
}

TEST_P(Interrupted, TheFileGrowsWhileTheRunGoesOnAndTheRecordSaysSo) {
  const pid_t child = start(kLongRun);
  ASSERT_TRUE(wait_for([&] { return size("a.csv") > 0 && exists("a.run.json"); }));
  EXPECT_EQ(read_json("a.run.json")["status"], "running");
  EXPECT_EQ(read_json("a.run.json")["incomplete"], true);
  for (int n = 0; n < 3; ++n) {
    const auto before = size("a.csv"), of_reactions = size("r.csv");
    const auto began = std::chrono::steady_clock::now();
    EXPECT_TRUE(wait_for([&] { return size("a.csv") > before && size("r.csv") > of_reactions; }));
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));  // on a machine that is busy
  }
  kill(child, SIGKILL);  // nothing can be done then; what stands there says so
  waitpid(child, nullptr, 0);
  EXPECT_EQ(read_json("a.run.json")["status"], "running");
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_P(Interrupted, EveryIntegratorAsksOnceAStep) {
  for (const char* integrator : {"implicit_euler", "dop853", "radau5", "ida"}) {
    const pid_t child = start({"run", "pendulum.json", "--integrator", integrator, "--formulation", "rp", "--end",
                               "1e6", "--every", "1e5", "--out", "a.csv"});
    ASSERT_TRUE(wait_for([&] { return !leftovers().empty(); }));
    usleep(100000);
    kill(child, SIGTERM);
    EXPECT_EQ(finish(child).status, 128 + SIGTERM) << integrator;
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
  }
}

TEST_P(Interrupted, WithNothingComputedNothingIsWritten) {
  ASSERT_EQ(mkfifo((folder() / "scene.json").c_str(), 0600), 0);  // that no one writes to
  fs::permissions(folder() / "scene.json", fs::perms(0666));
  const auto before = files();
  const pid_t child = start({"run", "scene.json", "--out", "new/a.csv"});
  int writer = -1;  // there is none before somebody reads
  ASSERT_TRUE(wait_for([&] {
    writer = open((folder() / "scene.json").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    return writer >= 0;
  }));
  kill(child, SIGINT);
  const Result result = finish(child);
  close(writer);
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.err, "poinsot: interrupted by SIGINT\n");
  EXPECT_EQ(files(), before);
}

TEST_P(Interrupted, AnIgnoredSignalStaysIgnored) {
  EXPECT_EQ(shell("trap \"\" HUP; $POINSOT run pendulum.json --end 20 --every 1 --out a.csv & "
                  "sleep 0.1; kill -HUP $!; wait $!"),
            0);
}

TEST_P(Interrupted, AReaderThatGoesAwayEndsTheRun) {
  EXPECT_EQ(shell("$POINSOT run pendulum.json --end 1e6 --out - | head -n 2 > rows; exit ${PIPESTATUS[0]}"),
            128 + SIGPIPE);
  EXPECT_EQ(lines(read("rows")).size(), 2u);
  EXPECT_EQ(shell("$POINSOT list | true; exit ${PIPESTATUS[0]}") % (128 + SIGPIPE), 0);
}

TEST_P(Interrupted, AChartSaysThatItIsNotFinishedAndGoesOn) {
  std::size_t rows = 0;
  for (int time = 0; time < 2; ++time) {
    const pid_t child = start({"chart", "pendulum.json", "--end", "10", "--cache", "cache", "--out", "out"});
    ASSERT_TRUE(
        wait_for([&] { return exists("out/pendulum.csv") && lines(read("out/pendulum.csv")).size() > rows + 12; }));
    kill(child, SIGINT);
    EXPECT_EQ(finish(child).status, 130);
    EXPECT_NE(read("out/pendulum.csv").find("\n# incomplete: "), std::string::npos);
    EXPECT_GT(lines(read("out/pendulum.csv")).size(), rows);
    rows = lines(read("out/pendulum.csv")).size();
  }
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

// Cells and cases that were computed are not computed again.
TEST_P(Interrupted, StabilityAndStudyGoOnWithWhatIsThere) {
  write("parameters.json", R"({"scene": 1, "parameters": {"l": 1}, "gravity": [0, 0, -9.81],
    "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, "l", 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})");
  write("study.json", R"({"study": 1, "scenes": ["parameters.json"], "settings": {"end": 1},
    "vary": [{"parameter": "l", "from": 1, "to": 2, "count": 400}], "keep": [{"column": "rod.y"}]})");
  const std::pair<std::vector<std::string>, std::string> commands[] = {
      {{"stability", "--family", "pulse", "--formulations", "rA", "--quick", "--threads", "1", "--out", "out"},
       "out/pulse.part"},
      {{"study", "study.json", "--threads", "1", "--out", "out"}, "out/cases.part"}};
  for (const auto& each : commands) {
    const auto& command = each.first;
    const std::string& part = each.second;
    SCOPED_TRACE(command[0]);
    fs::remove_all(folder() / "out");
    for (const int signal : {SIGTERM, SIGKILL}) {
      const auto before = size(part);
      const pid_t child = start(command);
      ASSERT_TRUE(wait_for([&] { return size(part) > before + 2000; }));
      kill(child, signal);
      const Result result = finish(child);
      EXPECT_EQ(result.status, signal == SIGTERM ? 143 : -1);
      EXPECT_EQ(result.err.starts_with("poinsot: interrupted by SIGTERM"), signal == SIGTERM) << result.err;
      EXPECT_GT(size(part), before);
      EXPECT_EQ(leftovers(), std::vector<std::string>{});
    }
    const auto before = size(part);
    const Result whole = poinsot(command);
    EXPECT_TRUE(whole.status == 0 || whole.err.find("matplotlib") != std::string::npos) << whole.err;
    EXPECT_GT(size(part), before);
  }
}

TEST_P(Interrupted, AnExistingFileKeepsItsModeAndIsReplacedAtOnce) {
  write("a.csv", "before");
  fs::permissions(folder() / "a.csv", fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_EQ(
      poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "0.01", "--out", "a.csv"}).status, 0);
  EXPECT_EQ(fs::status(folder() / "a.csv").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(lines(read("a.csv")).size(), 12u);
  // Wrong input leaves it as it was.
  write("a.csv", "before");
  EXPECT_EQ(poinsot({"run", "pendulum.json", "--analysis", "kinematics", "--out", "a.csv"}).status, 2);
  EXPECT_EQ(read("a.csv"), "before");
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_P(Interrupted, MemoryThatIsRefusedIsASentence) {
  if (shell("ulimit -v 300000; $POINSOT --version > /dev/null") != 0)
    GTEST_SKIP() << "sanitizers reserve more than is allowed";
  EXPECT_EQ(shell("ulimit -v 300000; $POINSOT make chain --bodies 3000000 --out c.json"), 3);
  EXPECT_EQ(read(".said.shell"), "poinsot: the memory does not suffice\n");
  EXPECT_FALSE(exists("c.json"));
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

// Nobody can be there before: they are in the target's folder under names that differ from run to run.
TEST_P(Interrupted, TemporaryNamesCannotBeGuessed) {
  std::vector<std::string> names;
  for (int time = 0; time < 2; ++time) {
    const pid_t child = start(kLongRun);
    std::vector<std::string> seen;
    EXPECT_TRUE(wait_for([&] { return !(seen = leftovers()).empty(); }));
    kill(child, SIGTERM);
    (void)finish(child);
    for (const std::string& name : seen) EXPECT_EQ(fs::path(name).parent_path(), folder());
    names.insert(names.end(), seen.begin(), seen.end());
  }
  ASSERT_GE(names.size(), 2u);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

INSTANTIATE_TEST_SUITE_P(As, Interrupted, testing::ValuesIn(kUsers), name_of_user);

}  // namespace
}  // namespace poinsot::test
