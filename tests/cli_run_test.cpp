// `poinsot run`: what it writes, what it says, and how it ends.
#include <fmt/format.h>
#include <pty.h>

#include <chrono>
#include <csignal>

#include "command_line.h"
#include "formulations/registry.h"

namespace poinsot::test {
namespace {

class Run : public CommandLineWithPendulum {};

TEST_F(Run, PrintsASummaryWithoutAnOutputFile) {
  const Result result = poinsot({"run", "pendulum.json", "--end", "0.1"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  for (const char* part :
       {"pendulum: dynamics, rA, auto, auto, rtol = 1e-08", "t = 0.1 s", "rod", "dop853: t = 0 to 0.1 s in ",
        "block on the whole matrix: ", "assembly", "largest violation", "\naccuracy: "})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
  EXPECT_EQ(result.out.find("h ="), std::string::npos) << "there is none";
  const Result fixed = poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "0.1"});
  for (const char* part : {"pendulum: dynamics, rA, implicit_euler, auto, h = 0.001 s", "100 steps",
                           "Newton iterations", "\naccuracy: not estimated"})
    EXPECT_NE(fixed.out.find(part), std::string::npos) << part << "\n" << fixed.out;
  EXPECT_EQ(files(), std::vector<std::string>{"pendulum.json"});
}

// Zeros would be taken for what was computed.
TEST_F(Run, TheSummaryOfARunThatDoesNotBeginSaysWhatIsKnown) {
  std::string forced = kPendulum;
  forced.insert(forced.find("\"joints\""), R"scene("forces": [{"type": "force", "body": "rod", "point": [0, 0, 0],
    "force": ["sqrt(t - 1)", 0, 0]
}], )scene");
  write("forced.json", forced);
  for (const char* integrator : {"auto", "implicit_euler"}) {
    const Result result = poinsot({"run", "forced.json", "--integrator", integrator});
    EXPECT_EQ(result.status, 3);
    EXPECT_NE(result.err.find("at t = 0 s force 'force1'"), std::string::npos) << result.err;
    EXPECT_EQ(lines(result.out).size(), 1u) << result.out;
    EXPECT_TRUE(result.out.starts_with("pendulum: dynamics, rA, ")) << result.out;
  }
  // The state is known there, a step is not.
  const Result result = poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--max-iterations", "1",
                                 "--tolerance", "1e-14", "--no-retry"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.out.find("t = 0 s\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nno step came to its end\nblock on the whole matrix: "), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("a step"), std::string::npos) << result.out;
}

// Of all commands but `study`; by one of the processes, and only where there are several.
TEST_F(Run, ProcessesThatDoTheSameAreTold) {
  const auto told = [&](const char* rank, const char* processes, std::vector<std::string> command) {
    setenv("OMPI_COMM_WORLD_RANK", rank, 1);
    setenv("OMPI_COMM_WORLD_SIZE", processes, 1);
    const Result result = poinsot(command);
    unsetenv("OMPI_COMM_WORLD_RANK");
    unsetenv("OMPI_COMM_WORLD_SIZE");
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  const std::vector<std::string> run{"run", "pendulum.json", "--end", "0.01"}, check{"check", "pendulum.json"};
  EXPECT_EQ(told("0", "4", run),
            "poinsot: note: 4 processes were started and each of them does all of `poinsot run`: `poinsot study` alone "
            "divides its work among processes; start one\n");
  EXPECT_NE(told("0", "2", check).find("2 processes were started and each of them does all of `poinsot check`"),
            std::string::npos);
  EXPECT_EQ(told("1", "4", run), "");
  EXPECT_EQ(told("0", "1", run), "");
  EXPECT_EQ(told("0", "4", {"run", "pendulum.json", "--end", "0.01", "--quiet"}), "");
}

TEST_F(Run, QuietSaysNothing) {
  const Result result = poinsot({"run", "pendulum.json", "--end", "0.1", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Run, TheSameInputGivesTheSameBytesWhateverRunsBesideIt) {
  for (const FormulationEntry& formulation : formulations()) {
    const std::vector<std::string> common{"run",   "pendulum.json", "--formulation", std::string(formulation.name),
                                          "--end", "0.5",           "--quiet"};
    const auto with = [&](const char* out, const char* reactions) {
      std::vector<std::string> arguments = common;
      arguments.insert(arguments.end(), {"--out", out, "--reactions", reactions});
      return arguments;
    };
    ASSERT_EQ(poinsot(with("a.csv", "ra.csv")).status, 0);
    const pid_t first = start(with("b.csv", "rb.csv"), "1"), second = start(with("c.csv", "rc.csv"), "2");
    ASSERT_EQ(finish(first, "1").status, 0);
    ASSERT_EQ(finish(second, "2").status, 0);
    for (const char* other : {"b.csv", "c.csv"}) EXPECT_TRUE(read("a.csv") == read(other)) << formulation.name;
    for (const char* other : {"rb.csv", "rc.csv"}) EXPECT_TRUE(read("ra.csv") == read(other)) << formulation.name;
  }
}

TEST_F(Run, ReactionsAloneHaveTheirRecordBesideThem) {
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--end", "0.01", "--reactions", "r.csv"}).status, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"pendulum.json", "r.csv", "r.run.json"}));
}

TEST_F(Run, AScenesOwnNameServesForTheTrajectory) {
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--end", "0.01", "--out", "pendulum.csv"}).status, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"pendulum.csv", "pendulum.json", "pendulum.run.json"}));
  EXPECT_EQ(read("pendulum.json"), kPendulum);
}

TEST_F(Run, ADeviceIsWrittenDirectly) {
  const Result result =
      poinsot({"run", "pendulum.json", "--end", "0.01", "--every", "0.001", "--out", "/dev/stdout", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(lines(result.out).size(), 12u);
  EXPECT_EQ(files(), std::vector<std::string>{"pendulum.json"});
}

TEST_F(Run, TakesPipesForInputAndOutput) {
  for (const char* const arguments : {"run pendulum.json --out /dev/stdout", "run /dev/stdin --out /dev/stdout",
                                      "reference /dev/stdin --out /dev/stdout"}) {
    const std::string command =
        fmt::format("cd '{}' && cat pendulum.json | '{}' {} --end 0.01 --every 0.001 --quiet | cat > .piped",
                    folder().string(), POINSOT_PROGRAM, arguments);
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(lines(read(".piped")).size(), 12u) << arguments;
  }
}

TEST_F(Run, WhatWasComputedBeforeANumericalFailureIsKept) {
  write("overstretched.json", kOverstretched);
  for (const FormulationEntry& formulation : formulations()) {
    SCOPED_TRACE(formulation.name);
    const Result result = poinsot({"run", "overstretched.json", "--formulation", std::string(formulation.name),
                                   "--integrator", "implicit_euler", "--step", "0.01", "--end", "2", "--quiet", "--out",
                                   "a.csv", "--reactions", "r.csv"});
    EXPECT_EQ(result.status, 3);
    ASSERT_EQ(lines(result.err).size(), 1u) << result.err;
    EXPECT_TRUE(result.err.starts_with("poinsot: ")) << result.err;
    EXPECT_NE(result.err.find("t = "), std::string::npos) << result.err;
    const nlohmann::json record = read_json("a.run.json");
    EXPECT_NE(record["status"], "ok");
    EXPECT_EQ(record["incomplete"], true);
    EXPECT_EQ("poinsot: " + record["message"].get<std::string>() + "\n", result.err);
    const std::vector<std::string> rows = lines(read("a.csv"));
    ASSERT_GT(rows.size(), 50u);
    EXPECT_EQ(lines(read("r.csv")).size(), rows.size());
    const double last = std::stod(fields(rows.back())[0]);
    EXPECT_LT(last, 1.05);
    EXPECT_GT(record["failure_time"].get<double>(), last);  // in a part of the next step
    EXPECT_LE(record["failure_time"].get<double>(), last + 0.01 + 1e-9);
    EXPECT_EQ(files(),
              (std::vector<std::string>{"a.csv", "a.run.json", "overstretched.json", "pendulum.json", "r.csv"}));
  }
}

// Reads what the program writes to a terminal until `part` comes up, or for a minute.
std::string watch_terminal(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                           const char* part) {
  std::vector<const char*> argv{POINSOT_PROGRAM};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(127);
    execv(POINSOT_PROGRAM, const_cast<char* const*>(argv.data()));
    _exit(127);
  }
  std::string seen;
  char buffer[4096];
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (seen.find(part) == std::string::npos && std::chrono::steady_clock::now() < deadline) {
    const ssize_t count = ::read(terminal, buffer, sizeof buffer);
    if (count <= 0) break;
    seen.append(buffer, static_cast<std::size_t>(count));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(terminal);
  return seen;
}

TEST_F(Run, ALongRunShowsItsProgressOnATerminal) {
  const std::string seen = watch_terminal(folder(), {"run", "pendulum.json", "--end", "10000"}, " left");
  EXPECT_NE(seen.find(" of 10000 s, "), std::string::npos) << seen;
}

TEST_F(Run, ErrorsAreColouredOnATerminalOnly) {
  const std::vector<std::string> wrong{"run", "none.json"};
  unsetenv("NO_COLOR");
  EXPECT_NE(watch_terminal(folder(), wrong, "\n").find("\x1b[1;31mpoinsot:"), std::string::npos);
  setenv("NO_COLOR", "1", 1);
  EXPECT_EQ(watch_terminal(folder(), wrong, "\n").find('\x1b'), std::string::npos);
  unsetenv("NO_COLOR");
  EXPECT_EQ(poinsot(wrong).err.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace poinsot::test
