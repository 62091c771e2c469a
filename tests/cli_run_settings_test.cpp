// The settings of `poinsot run`, on the command line and in a configuration file: which of them count, and what is said
// of those that do not.
#include <fmt/format.h>

#include "command_line.h"
#include "integrators/settings.h"

namespace poinsot::test {
namespace {

using RunSettings = CommandLineWithPendulum;

TEST_F(RunSettings, OptionsThatMeanNothingToTheMethodAreTold) {
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

TEST_F(RunSettings, OptionsOfIntegratorsAreToldToMeanNothingToKinematics) {
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

TEST_F(RunSettings, KeysOfTheConfigurationThatMeanNothingToTheMethodAreTold) {
  const auto told = [&](const char* config, std::vector<std::string> options) {
    write("config.json", config);
    options.insert(options.begin(), {"run", "pendulum.json", "--config", "config.json", "--end", "0.01"});
    const Result result = poinsot(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  EXPECT_EQ(told(R"({"step": 0.01, "end": 1})", {}),
            "poinsot: note: config.json: /step means nothing to integrator auto, which controls its error by rtol and "
            "atol\n");
  EXPECT_EQ(told(R"({"integrator": "rattle", "step": 0.01, "rtol": 1e-6, "atol": 1e-8})", {}),
            "poinsot: note: config.json: /rtol, /atol mean nothing to integrator rattle, whose accuracy follows from "
            "its step\n");
  EXPECT_EQ(told("{}", {"--no-retry"}),
            "poinsot: note: --no-retry means nothing to integrator auto, which controls its error by rtol and atol\n");
  EXPECT_EQ(
      told("{}", {"--columns", "position", "--bodies", "rod"}),
      "poinsot: note: --columns means nothing without --out\npoinsot: note: --bodies means nothing without --out\n");
  // The command line decides what the method is, and speaks for itself.
  EXPECT_EQ(
      told(R"({"integrator": "rattle", "step": 0.01, "rtol": 1e-6})", {"--integrator", "dop853"}),
      "poinsot: note: config.json: /step means nothing to integrator dop853, which controls its error by rtol and "
      "atol\n");
  EXPECT_EQ(told(R"({"step": 0.01})", {"--step", "0.02"}),
            "poinsot: note: --step means nothing to integrator auto, which controls its error by rtol and atol\n");
  EXPECT_EQ(told(R"({"step": 0.01})", {"--quiet"}), "");
  EXPECT_EQ(told(R"({"integrator": "rattle", "step": 0.01})", {}), "");
}

TEST_F(RunSettings, TheCommandLineWinsOverTheConfiguration) {
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

// What was given is blamed, not the scene: the formulation, or the integrator where no formulation was.
TEST_F(RunSettings, AFormulationThatTheIntegratorRefusesIsBlamedWhereItWasGiven) {
  const std::string why =
      " integrator 'ida' refuses formulation 'rA': it needs a vector space of coordinates with their rates as "
      "velocities, which is rp";
  const auto expect_refused = [&](const char* config, std::vector<std::string> options, const std::string& place,
                                  const std::string& line) {
    write("config.json", config);
    options.insert(options.end(), {"--config", "config.json"});
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"run", "pendulum.json"}, {"view", "pendulum.json", "--out", "a.html"}}) {
      std::vector<std::string> all = command;
      all.insert(all.end(), options.begin(), options.end());
      const Result result = poinsot(all);
      EXPECT_EQ(result.status, 2);
      EXPECT_EQ(result.err, "poinsot: " + place + why + line + "\n");
    }
    EXPECT_EQ(files(), (std::vector<std::string>{"config.json", "pendulum.json"}));
  };
  expect_refused("{}", {"--integrator", "ida", "--formulation", "rA"}, "--formulation:", "");
  expect_refused("{}", {"--integrator", "ida"}, "--integrator:", "");
  expect_refused("{\"integrator\": \"ida\",\n \"formulation\": \"rA\"}", {}, "config.json: /formulation:", " (line 2)");
  expect_refused("{\"integrator\": \"ida\"}", {}, "config.json: /integrator:", "");
  expect_refused("{\"formulation\": \"rA\"}", {"--integrator", "ida"}, "config.json: /formulation:", "");
  expect_refused("{\"formulation\": \"rp\", \"integrator\": \"ida\"}", {"--formulation", "rA"}, "--formulation:", "");
}

TEST_F(RunSettings, AnAbsoluteToleranceThatIsNotGivenFollowsTheRelativeOne) {
  const auto atol = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", "pendulum.json", "--integrator", "dop853", "--out", "motion.csv"});
    EXPECT_EQ(poinsot(options).status, 0);
    return read_json("motion.run.json")["configuration"]["atol"].get<double>();
  };
  EXPECT_DOUBLE_EQ(atol({}), 1e-10);
  EXPECT_DOUBLE_EQ(atol({"--rtol", "1e-12"}), 1e-14);
  EXPECT_DOUBLE_EQ(atol({"--rtol", "1e-12", "--atol", "1e-6"}), 1e-6);
}

TEST_F(RunSettings, AnIntegratorThatControlsItsErrorGivesRowsAtAnyMultiples) {
  const Result result = poinsot(
      {"run", "pendulum.json", "--integrator", "dopri5", "--every", "0.0015", "--end", "0.1", "--out", "a.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string rows = read("a.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 67 + 1);  // header, 0 to 66 times 0.0015 s, the end
}

TEST_F(RunSettings, AStepThatDoesNotDivideTheEndIsShortenedWithANotice) {
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

}  // namespace
}  // namespace poinsot::test
