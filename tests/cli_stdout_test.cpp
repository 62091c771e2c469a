// Standard output, devices, pipes and sockets are written as they are, as root and as anybody; what is lost on them is
// no success.
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>

#include "command_line.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

// As the user of the test, and as nobody where the test is root.
class Stdout : public CommandLine {
 protected:
  Stdout() {
    write("pendulum.json", kPendulum);
    fs::copy_file(POINSOT_PROGRAM, folder() / "poinsot");  // where nobody may not go it stands elsewhere
    fs::permissions(folder() / "poinsot", fs::perms(0755));
    fs::permissions(folder(), fs::perms(0777));
    if (geteuid() == 0 && shell("true", "setpriv --reuid=65534 --regid=65534 --clear-groups ") == 0)
      users_.emplace_back("setpriv --reuid=65534 --regid=65534 --clear-groups ");
  }

  int shell(const std::string& commands, const std::string& as = "", const char* said = ".said.shell") const {
    write("commands.sh", commands);
    const int status = std::system(
        fmt::format("cd '{}' && PATH=.:$PATH {}bash commands.sh 2> {}", folder().string(), as, said).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  // The status of the commands, the same as every user; a fresh folder `out` for each.
  void expect(int status, const std::string& commands, const std::string& check = "true") const {
    for (const std::string& user : users_) {
      SCOPED_TRACE(user + commands);
      fs::remove_all(folder() / "out");
      fs::create_directory(folder() / "out");
      fs::permissions(folder() / "out", fs::perms(0777));
      EXPECT_EQ(shell(commands, user), status) << read(".said.shell");
      EXPECT_EQ(shell(check, user, ".said.check"), 0) << check;
    }
  }

  std::vector<std::string> users_{""};
};

TEST_F(Stdout, IsWrittenAfterWhatItHolds) {
  expect(0, "echo kept > out/log; poinsot make chain --bodies 3 >> out/log",
         "head -n 1 out/log | grep -qx kept && tail -n +2 out/log > out/s.json && poinsot check out/s.json --quiet");
  expect(0, "( echo head; poinsot make chain --bodies 2; echo foot ) > out/f",
         "head -n 1 out/f | grep -qx head && tail -n 1 out/f | grep -qx foot && test $(wc -l < out/f) -gt 10");
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    expect(0,
           fmt::format("( echo head; poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out {}; echo "
                       "foot ) > out/x.csv",
                       name),
           "test $(wc -l < out/x.csv) = 14 && test $(ls out | wc -l) = 1");
    expect(0,
           fmt::format("poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out {} | cat > out/x.csv",
                       name),
           "test $(wc -l < out/x.csv) = 12");
  }
  expect(0, "ln -s /dev/stdout out/link; poinsot make chain --bodies 2 --out out/link > out/f",
         "test -L out/link && test -s out/f && test $(ls out | wc -l) = 2");
}

TEST_F(Stdout, IsTheNameOfADash) {
  expect(0, "cat pendulum.json | poinsot run - --integrator implicit_euler --end 0.01 --out - > out/x.csv",
         "test $(wc -l < out/x.csv) = 12");
  for (const char* command :
       {"check -", "run - --integrator implicit_euler --end 0.01", "reference - --end 0.1 --digits 4 --cache c --out -",
        "advise - --end 0.1 --accuracy 1e-3 --cache c",
        "chart - --quick --end 0.1 --integrators implicit_euler --formulations rA --cache c --out d --quiet"}) {
    EXPECT_EQ(shell(fmt::format("poinsot < pendulum.json > said {}", command)), 0) << read(".said.shell");
    EXPECT_TRUE(!read("said").empty() || std::string_view(command).starts_with("chart")) << command;
  }
  expect(0, "true", "test $(ls | grep -c '^-') = 0");
  expect(2, "echo '{' | poinsot run -");
  EXPECT_TRUE(read(".said.shell").starts_with("poinsot: standard input: line ")) << read(".said.shell");
  expect(2, "poinsot run pendulum.json --integrator implicit_euler --out - --reactions /dev/stdout");
}

TEST_F(Stdout, ThatIsClosedOrFullIsNoSuccess) {
  expect(3, "poinsot list > /dev/full");
  EXPECT_EQ(read(".said.shell"), "poinsot: standard output: cannot be written: No space left on device\n");
  expect(3, "poinsot run pendulum.json --integrator implicit_euler --end 0.01 > /dev/full");
  expect(3, "poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out - > /dev/full");
  expect(3, "poinsot make chain > /dev/full");
  expect(3, "poinsot --help > /dev/full");
  expect(3, "poinsot make chain --bodies 2 >&-", "test -c /dev/full && test -L /dev/stdout");
  expect(3, "poinsot list >&-");
  expect(0, "poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out out/x.csv --quiet <&- >&- 2>&-",
         "test $(wc -l < out/x.csv) = 12 && test -s out/x.run.json");
  expect(2, "poinsot run none.json 2>&-");
  expect(2, "poinsot run none.json 2> /dev/full");
  expect(2, "poinsot fly 2>&-");
}

TEST_F(Stdout, DevicesPipesAndSocketsStayWhatTheyAre) {
  expect(0, "poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out /dev/null --reactions /dev/null",
         "test -c /dev/null && test ! -e /dev/null.run.json && test ! -e /dev/null.json");
  expect(0,
         "mkfifo out/pipe; cat out/pipe > out/x.csv & poinsot run pendulum.json --integrator implicit_euler --end 0.01 "
         "--out out/pipe && wait",
         "test -p out/pipe && test $(wc -l < out/x.csv) = 12 && test $(ls out | wc -l) = 2");

  const std::string name = (folder() / "socket").string();
  const int listening = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, name.c_str());
  ASSERT_EQ(bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(listening, 1), 0);
  const pid_t child = start({"make", "chain", "--bodies", "2", "--out", "socket"});
  const int connected = accept(listening, nullptr, nullptr);
  std::string got;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(connected, buffer, sizeof buffer)) > 0;)
    got.append(buffer, static_cast<std::size_t>(n));
  EXPECT_EQ(finish(child).status, 0);
  EXPECT_EQ(nlohmann::json::parse(got)["bodies"].size(), 2u);
  EXPECT_TRUE(fs::is_socket(name));
  close(connected);
  close(listening);
}

TEST_F(Stdout, MissingFoldersAreMadeAndWrongInputLeavesNone) {
  expect(0,
         "poinsot run pendulum.json --integrator implicit_euler --end 0.01 --out out/a/b/x.csv --reactions out/c/r.csv",
         "test -s out/a/b/x.run.json && test -s out/c/r.csv");
  expect(0, "poinsot make chain --out out/a/b/s.json", "test -s out/a/b/s.json");
  expect(0, "poinsot reference pendulum.json --end 0.1 --digits 4 --cache out/k --out out/a/m.csv --quiet",
         "test -s out/a/m.run.json");
  expect(2, "poinsot run pendulum.json --integrator implicit_euler --analysis kinematics --out out/a/b/x.csv",
         "test -z \"$(ls out)\"");
}

TEST_F(Stdout, NamesThatLeadNowhereAreWrongInput) {
  const std::string nothing = "test $(ls out | wc -l) -le 1";
  expect(2, "ln -s loop out/loop; poinsot run out/loop", nothing);
  expect(2, "ln -s loop out/loop; poinsot run pendulum.json --integrator implicit_euler --out out/loop", nothing);
  expect(2, "poinsot run pendulum.json --integrator implicit_euler --out out/$(printf 'a%.0s' {1..300}).csv", nothing);
  expect(2, "poinsot check out/$(printf 'a%.0s' {1..300})/b.json", nothing);
  expect(2, "poinsot tables --out out/$(printf 'a%.0s' {1..300})", nothing);
  expect(2, "poinsot tables --models out/$(printf 'a%.0s' {1..300})", nothing);
  expect(2, "poinsot run pendulum.json --integrator implicit_euler --out pendulum.json/x.csv", nothing);
}

TEST_F(Stdout, WhatIsNoCacheIsNotWaitedFor) {
  const std::string run = "poinsot reference pendulum.json --end 0.1 --digits 4 --cache out/k --quiet";
  expect(0, run + " && f=$(ls out/k/*) && rm $f && mkfifo $f && timeout 60 " + run, "test -p out/k/*");
  expect(0, run + " && f=$(ls out/k/*) && rm $f && ln -s loop $f && timeout 60 " + run);
  expect(0, "mkdir out/k; chmod 0 out/k; " + run + "; s=$?; chmod 700 out/k; exit $s");
  expect(0, "touch out/k; " + run);
}

}  // namespace
}  // namespace poinsot::test
