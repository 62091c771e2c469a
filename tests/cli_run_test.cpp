// `poinsot run`: what it writes, what it says, and how it ends.
#include <fmt/format.h>
#include <pty.h>

#include <chrono>
#include <csignal>

#include "command_line.h"
#include "core/provenance.h"
#include "formulations/registry.h"
#include "integrators/settings_reader.h"

namespace poinsot::test {
namespace {

class Run : public CommandLine {
 protected:
  Run() { write("pendulum.json", kPendulum); }
};

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

TEST_F(Run, OptionsThatMeanNothingToTheMethodAreTold) {
  const auto told = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", "pendulum.json", "--end", "0.01"});
    return poinsot(options).err;
  };
  for (const char* option : {"--step", "--tolerance", "--max-iterations"}) {
    EXPECT_EQ(told({option, "1"}), fmt::format("poinsot: note: {} means nothing to integrator auto, which controls its "
                                               "error by rtol and atol\n",
                                               option));
    EXPECT_EQ(told({option, "1", "--integrator", "rattle", "--step", "0.01"}).find("means nothing"), std::string::npos)
        << option;
  }
  for (const char* option : {"--rtol", "--atol"}) {
    EXPECT_EQ(
        told({"--integrator", "rattle", option, "1e-6"}),
        fmt::format("poinsot: note: {} means nothing to integrator rattle, whose accuracy follows from its step\n",
                    option));
    EXPECT_EQ(told({option, "1e-6"}), "");
  }
}

TEST_F(Run, OptionsOfIntegratorsAreToldToMeanNothingToKinematics) {
  const auto told = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", POINSOT_SOURCE_DIR "/models/single_pendulum_joints.json", "--analysis",
                                     "kinematics", "--end", "0.01"});
    const Result result = poinsot(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  const std::string before = told({});
  const auto expect_told = [&](std::vector<std::string> options, const char* why) {
    EXPECT_EQ(told(options),
              fmt::format("poinsot: note: {} means nothing to kinematics, {}\n{}", options.front(), why, before));
  };
  expect_told({"--integrator", "rattle"}, "which finds positions and integrates nothing");
  expect_told({"--stopping", "relative"}, "which finds positions and integrates nothing");
  expect_told({"--retry"}, "which finds positions and integrates nothing");
  expect_told({"--rtol", "1e-6"}, "whose accuracy is the tolerance of Newton's method");
  EXPECT_EQ(told({"--step", "0.005", "--tolerance", "1e-6", "--jacobian", "kept", "--max-iterations", "30"}), before);
}

TEST_F(Run, QuietSaysNothing) {
  const Result result = poinsot({"run", "pendulum.json", "--end", "0.1", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Run, TheCommandLineWinsOverTheConfiguration) {
  write("config.json", R"({
    // how to solve
    "formulation": "rp", "jacobian": "simplified", "step": "1/200", "end": 0.1, "max_iterations": 30
  })");
  const Result result = poinsot(
      {"run", "pendulum.json", "--config", "config.json", "--formulation", "reps", "--end", "0.2", "--out", "a.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json used = read_json("a.run.json")["configuration"];
  EXPECT_EQ(used["formulation"], "reps");
  EXPECT_EQ(used["jacobian"], "simplified");
  EXPECT_EQ(used["step"], 0.005);
  EXPECT_EQ(used["end"], 0.2);
  EXPECT_EQ(used["max_iterations"], 30);
  EXPECT_EQ(used["linear_solver"], Settings{}.linear_solver);
}

// A door on three hinges that hold it too often.
TEST_F(Run, TheRecordSaysWhichReactionsAreNotDetermined) {
  const std::string door = fmt::format("{}/models/door.json", POINSOT_SOURCE_DIR);
  const Result result = poinsot({"run", door, "--end", "0.01", "--out", "door.csv", "--reactions", "r.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json record = read_json("door.run.json");
  EXPECT_EQ(record["reactions_undetermined"], true);
  EXPECT_EQ(record["undetermined_reactions"], (std::vector<std::string>{"lower", "middle", "upper"}));
}

TEST_F(Run, TheRecordSaysWhereTheNumbersComeFrom) {
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

TEST_F(Run, AnAbsoluteToleranceThatIsNotGivenFollowsTheRelativeOne) {
  const auto atol = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", "pendulum.json", "--integrator", "dop853", "--out", "motion.csv"});
    EXPECT_EQ(poinsot(options).status, 0);
    return read_json("motion.run.json")["configuration"]["atol"].get<double>();
  };
  EXPECT_DOUBLE_EQ(atol({}), 1e-10);
  EXPECT_DOUBLE_EQ(atol({"--rtol", "1e-12"}), 1e-14);
  EXPECT_DOUBLE_EQ(atol({"--rtol", "1e-12", "--atol", "1e-6"}), 1e-6);
}

TEST_F(Run, TheRecordedConfigurationRepeatsTheRun) {
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "2/3", "--step", "1/300",
                     "--formulation", "rp", "--no-assemble", "--out", "a.csv"})
                .status,
            0);
  write("again.json", read_json("a.run.json")["configuration"].dump());
  const Result again = poinsot({"run", "pendulum.json", "--config", "again.json", "--out", "b.csv"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(read("a.csv") == read("b.csv"));
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

TEST_F(Run, AnIntegratorThatControlsItsErrorGivesRowsAtAnyMultiples) {
  const Result result = poinsot(
      {"run", "pendulum.json", "--integrator", "dopri5", "--every", "0.0015", "--end", "0.1", "--out", "a.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string rows = read("a.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 67 + 1);  // header, 0 to 66 times 0.0015 s, the end
}

TEST_F(Run, AStepThatDoesNotDivideTheEndIsShortenedWithANotice) {
  const Result result = poinsot(
      {"run", "pendulum.json", "--integrator", "implicit_euler", "--step", "0.03", "--end", "0.1", "--out", "a.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err,
            "poinsot: note: end 0.1 s is not a multiple of step 0.03 s: the step is shortened to 0.025 s, so that step "
            "4 lands "
            "on the end exactly\n");
  EXPECT_EQ(read_json("a.run.json")["configuration"]["step"], 0.025);
  EXPECT_EQ(read_json("a.run.json")["notices"].size(), 1u);
  const std::vector<std::string> rows = lines(read("a.csv"));
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(std::stod(fields(rows.back())[0]), 0.1);
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
