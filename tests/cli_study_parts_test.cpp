// A study computed by threads, shards and ranks: the table is the same, byte by byte.
#include <fmt/format.h>

#include "support/study_command.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

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

TEST_F(CliStudy, RanksGiveTheSameBytes) {
  if (shell("mpirun --version > .said.mpi 2>&1") != 0)
    GTEST_SKIP() << "mpirun was not found: studies across processes are not looked at";
  const std::string expected = reference();
  // MPI itself leaves memory behind, and mpirun of Open MPI 4.1 can wait for one of its own threads for good once all
  // ranks have ended, and SIGTERM need not end it then: it is killed and started again.
  constexpr int killed = 137;
  const auto run = [&](int ranks, const std::string& out) {
    int status = killed;
    for (int tries = 0; tries < 4 && status == killed; ++tries)
      status = shell(fmt::format(
          "ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout --signal=KILL "
          "40 mpirun --oversubscribe -n {} '{}' study study.json --quiet --out {} 2> .said.mpi",
          ranks, POINSOT_PROGRAM, out));
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
  EXPECT_NE(status, killed);
  EXPECT_NE(read(".said.mpi").find("study.json: /study: found nothing"), std::string::npos);
}

}  // namespace
}  // namespace poinsot::test
