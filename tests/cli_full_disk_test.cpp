// Disks that are full: all files of a run end with the same row, the record beside them says so, nothing half-written
// remains.
#include <csignal>

#include "support/interrupted.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

class FullDisk : public Interrupted {
 protected:
  static constexpr const char* kOnlyRoot = "only root can make a small disk";
  bool can_mount() const {
    if (geteuid() != 0 || std::system("unshare --mount true 2> /dev/null") != 0) return false;
    for (const char* name : {"disk", "kept"}) fs::create_directory(folder() / name);
    fs::permissions(folder() / "kept", fs::perms(0777));
    return true;
  }

  // The exit status of a command that finds a disk of so many kB, empty, in disk/; in kept/ is what remains of it.
  int on_disk(int kilobytes, const std::string& command) const {
    const std::string as = program() == POINSOT_PROGRAM ? "" : "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    write("on_disk.sh", command);
    const int status = std::system(
        fmt::format("cd '{}' && rm -rf kept/* && export POINSOT='{}' && unshare --mount bash -c 'mount -t tmpfs -o "
                    "size={}k none disk && chmod 777 disk && {}bash on_disk.sh; s=$?; cp -r disk/. kept; exit $s'",
                    folder().string(), program(), kilobytes, as)
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

// A limit on the size of files stands for a full disk; with the signal ignored it is one.
TEST_P(FullDisk, AFullDiskKeepsTheRowsThereWasRoomFor) {
  const std::string run = "ulimit -f 64; $POINSOT run pendulum.json --integrator implicit_euler --end 10 --out a.csv";
  EXPECT_EQ(shell("trap \"\" XFSZ; " + run), 3);
  const std::string said = read(".said.shell");
  expect_complete_rows("a.csv");
  const std::size_t rows = lines(read("a.csv")).size() - 1;
  EXPECT_GT(rows, 100u);
  EXPECT_NE(
      said.find(fmt::format("a.csv: cannot be written: File too large; what is kept of it ends with row {}", rows)),
      std::string::npos)
      << said;
  EXPECT_EQ(read_json("a.run.json")["incomplete"], true);
  EXPECT_EQ(read_json("a.run.json")["status"], "interrupted");
  EXPECT_EQ(shell(run), 128 + SIGXFSZ);
  expect_complete_rows("a.csv");
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
  // A state is whole, or as it was.
  write("s.json", "before");
  EXPECT_EQ(shell("$POINSOT make chain --bodies 50 --out c.json; ulimit -f 1; trap \"\" XFSZ; "
                  "$POINSOT run c.json --integrator implicit_euler --end 0.01 --save-state s.json > /dev/null"),
            3);
  EXPECT_NE(read(".said.shell").find("s.json: cannot be written: File too large"), std::string::npos);
  EXPECT_EQ(read("s.json"), "before");
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

// The disk is one for all: what the files keep of the run is the same rows, and the record beside them says so.
TEST_P(FullDisk, AFullDiskIsSharedByAllFiles) {
  if (!can_mount()) GTEST_SKIP() << kOnlyRoot;
  write("commands.sh",
        "\"$POINSOT\" run pendulum.json --integrator implicit_euler --quiet "
        "--out disk/a.csv --reactions disk/r.csv --signals disk/s$NPY \"$@\" 2> kept/said");
  for (const char* options :
       {"--end 1", "--end 1e6 --step 1e-4"})  // shorter and longer than files wait for their names
    for (const char* npy : {".csv", ".npy"}) {
      SCOPED_TRACE(fmt::format("{} {}", options, npy));
      const int status = on_disk(96, fmt::format("NPY={} bash commands.sh {}", npy, options));
      EXPECT_EQ(status, 3) << read("kept/said");
      const std::size_t rows = lines(read("kept/a.csv")).size() - 1;
      EXPECT_GT(rows, 10u);
      expect_complete_rows("kept/a.csv");
      expect_complete_rows("kept/r.csv");
      EXPECT_EQ(lines(read("kept/r.csv")).size() - 1, rows);
      const std::string signals = read(std::string("kept/s") + npy);
      if (npy == std::string_view(".csv"))
        EXPECT_EQ(lines(signals).size() - 1, rows);
      else
        EXPECT_NE(signals.find(fmt::format("'shape': ({}, ", rows)), std::string::npos) << signals.substr(0, 200);
      const nlohmann::json record = read_json("kept/a.run.json");
      EXPECT_EQ(record["incomplete"], true);
      EXPECT_EQ(record["status"], "interrupted");
      EXPECT_NE(read("kept/said")
                    .find(fmt::format("No space left on device; what is kept of all files ends with row {}\n", rows)),
                std::string::npos)
          << read("kept/said");
      EXPECT_EQ(leftovers(), std::vector<std::string>{});
    }
}

// The room of the last rows, of the record, of the state: whichever is missing, the record says so.
TEST_P(FullDisk, AShortRunIsMarkedWhereverTheRoomEnds) {
  if (!can_mount()) GTEST_SKIP() << kOnlyRoot;
  bool without_state = false;
  std::size_t most = 0;
  for (int kilobytes = 8; kilobytes <= 128; kilobytes += 4) {
    SCOPED_TRACE(::testing::Message() << kilobytes << " kB");
    const int status = on_disk(kilobytes,
                               "\"$POINSOT\" run pendulum.json --integrator implicit_euler --end 0.05 --quiet --out "
                               "disk/a.csv --signals disk/s.csv --save-state disk/state.json 2> kept/said");
    const std::size_t rows = exists("kept/a.csv") ? lines(read("kept/a.csv")).size() - 1 : 0;
    EXPECT_EQ(exists("kept/s.csv"), rows > 0);
    if (rows > 0) {
      expect_complete_rows("kept/a.csv");
      expect_complete_rows("kept/s.csv");
      EXPECT_EQ(lines(read("kept/s.csv")).size() - 1, rows);
    }
    const nlohmann::json record = read_json("kept/a.run.json");
    EXPECT_EQ(record["status"], status == 0 ? "ok" : "interrupted");
    EXPECT_EQ(exists("kept/state.json"), status == 0);
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
    EXPECT_GE(rows, most);
    most = rows;
    if (status == 0) {
      EXPECT_EQ(rows, 51u);
      EXPECT_TRUE(without_state);  // of the sizes before one had room for all but the state
      return;
    }
    EXPECT_EQ(status, 3);
    EXPECT_NE(read("kept/said").find("No space left on device"), std::string::npos) << read("kept/said");
    without_state = without_state || rows == 51;
  }
  FAIL() << "no disk was large enough";
}

// A study's cases, its record, its tables and pictures.
TEST_P(FullDisk, AStudyLeavesNothingHalf) {
  if (!can_mount()) GTEST_SKIP() << kOnlyRoot;
  write("study.json", R"({"study": 1, "scenes": ["pendulum.json"], "settings": {"integrator": "rattle", "end": 0.1},
    "vary": [{"setting": "step", "values": [0.01, 0.005]}], "keep": [{"column": "rod.z", "name": "z"}],
    "pictures": [{"file": "picture", "title": "z", "points": {"x": "step", "y": "z.final"}}]})");
  const std::string command = "\"$POINSOT\" study study.json --threads 1 --quiet --out disk 2> kept/said";
  for (const int kilobytes : {4, 8, 12, 16, 24, 32, 48}) {
    SCOPED_TRACE(::testing::Message() << kilobytes << " kB");
    EXPECT_EQ(on_disk(kilobytes, command), 3) << read("kept/said");
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
    if (exists("kept/cases.csv")) {
      EXPECT_EQ(lines(read("kept/cases.csv")).size(), 3u);
    }
    if (exists("kept/cases.run.json")) {
      EXPECT_EQ(read_json("kept/cases.run.json")["incomplete"], !exists("kept/cases.csv"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(As, FullDisk, testing::ValuesIn(kUsers), name_of_user);

}  // namespace
}  // namespace poinsot::test
