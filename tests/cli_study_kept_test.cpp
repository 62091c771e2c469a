// A study that is killed, is interrupted or finds no room: what was computed is kept, and it goes on with that.
#include <fmt/format.h>

#include <chrono>
#include <csignal>

#include "support/study_command.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

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

}  // namespace
}  // namespace poinsot::test
