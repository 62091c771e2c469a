// Every way to be wrong on the command line and in the configuration: one sentence, status 2, nothing written.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_line.h"
#include "formulations/registry.h"
#include "integrators/settings_reader.h"
#include "linsolve/registry.h"

namespace poinsot::test {
namespace {

class WrongInput : public CommandLine {
 protected:
  WrongInput() {
    write("pendulum.json", kPendulum);
    before_ = files();
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& message) {
    const Result result = poinsot(arguments);
    SCOPED_TRACE(fmt::format("poinsot {}", fmt::join(arguments, " ")));
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, message + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(files(), before_);
  }

  void expect_configuration_refused(const std::string& text, const std::string& message) {
    write("config.json", text);
    before_ = files();
    SCOPED_TRACE(text);
    expect_refused({"run", "pendulum.json", "--config", "config.json", "--out", "a.csv"}, message);
  }

 private:
  std::vector<std::string> before_;
};

std::string names(const char* key) {
  return fmt::format("{}", fmt::join(find_setting(key)->names(), ", "));
}

TEST_F(WrongInput, Usage) {
  const std::string commands =
      "run, check, view, report, compare, list, tables, make, scale, reference, chart, advise, study, stability, "
      "figures, completion, manual; see poinsot --help";
  expect_refused({}, "poinsot: found no command, expected one of " + commands);
  expect_refused({"fly"}, "poinsot: found \"fly\", expected one of " + commands);
  expect_refused({"--fly"}, "poinsot: found \"--fly\", expected one of " + commands);
  expect_refused({"run"}, "poinsot: found no scene, expected poinsot run SCENE; see poinsot run --help");
  expect_refused({"check"}, "poinsot: found no scene, expected poinsot check SCENE; see poinsot check --help");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"view"}, {"view", "pendulum.json"}})
    expect_refused(command,
                   fmt::format("poinsot: found no {}, expected poinsot view SCENE --out FILE.html; see poinsot "
                               "view --help",
                               command.size() == 1 ? "scene" : "--out"));
  expect_refused({"compare", "results"},
                 "poinsot: found no B, expected poinsot compare A B; see poinsot compare --help");
  expect_refused({"run", "pendulum.json", "--stepp", "1"}, "poinsot: --stepp: unknown option; see poinsot run --help");
  expect_refused({"run", "pendulum.json", "more"},
                 "poinsot: found \"more\", expected nothing more; see poinsot run --help");
  expect_refused({"run", "pendulum.json", "--step"},
                 "poinsot: --step: expected one value, once; see poinsot run --help");
  expect_refused({"run", "pendulum.json", "--step", "1", "--step", "2"},
                 "poinsot: --step: expected one value, once; see poinsot run --help");
  for (const char* file : {"--out", "--reactions", "--signals", "--save-state", "--config"})
    expect_refused({"run", "pendulum.json", file, ""},
                   fmt::format("poinsot: {}: found \"\", expected a file; see poinsot run --help", file));
  expect_refused({"run", "pendulum.json", "--bodies", ""},
                 "poinsot: --bodies: found \"\", expected names; see poinsot run --help");
  expect_refused({"advise", "pendulum.json", "--cache", ""},
                 "poinsot: --cache: found \"\", expected a folder; see poinsot advise --help");
  expect_refused({"run", ""}, "poinsot: scene: found \"\", expected a file; see poinsot run --help");
  expect_refused({"run", "pendulum.json", "--quiet=no"}, "poinsot: --quiet: expected no value; see poinsot run --help");
  expect_refused({"make"}, "poinsot: found no structure, expected poinsot make STRUCTURE; see poinsot make --help");
  expect_refused({"make", "chain", "--bodies", "2.5"},
                 "poinsot: --bodies: found \"2.5\", expected a whole number; see poinsot make --help");
  expect_refused({"make", "chain", "--bodies", "99999999999"},
                 "poinsot: --bodies: found \"99999999999\", expected a smaller whole number; see poinsot make --help");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"study", "study.json"}, {"stability"}}) {
    std::vector<std::string> without = command;
    without.insert(without.end(), {"--threads", "0"});
    expect_refused(without, "poinsot: --threads: found 0, expected a whole number, at least 1");
  }
}

TEST_F(WrongInput, Scene) {
  expect_refused({"run", "none.json", "--out", "a.csv"},
                 "poinsot: none.json: cannot be read: No such file or directory");
  write("bad.json",
        R"({"scene": 1, "bodies": [{"name": "a", "mass": -1, "inertia": [1, 1, 1], "position": [0, 0, 0]}]})");
  const Result result = poinsot({"run", "bad.json", "--out", "a.csv"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(result.err.starts_with("poinsot: bad.json: /bodies/0/mass: found -1, expected ")) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "a.csv"));
  EXPECT_EQ(poinsot({"check", "bad.json"}).err, result.err);
}

TEST_F(WrongInput, CommandLineValues) {
  const auto refused = [&](const char* option, const char* value, const std::string& message) {
    expect_refused({"run", "pendulum.json", "--out", "a.csv", option, value}, "poinsot: " + message);
  };
  refused("--step", "0", "--step: found \"0\", expected a number greater than 0");
  refused("--step", "-1", "--step: found \"-1\", expected a number greater than 0");
  refused("--rtol", "1e-15", "--rtol: found \"1e-15\", expected a number from 2.2e-15 to 1");
  for (const char* radius : {"3", "-1", "1.001"})
    refused("--spectral-radius", radius,
            fmt::format("--spectral-radius: found \"{}\", expected a number from 0 to 1", radius));
  refused("--spectral-radius", "0.5",
          "--spectral-radius: no parameter of integrator 'auto'; it is one of generalized_alpha, "
          "generalized_alpha_i2");
  refused("--every", "-1", "--every: found \"-1\", expected a number, at least 0");
  refused("--max-iterations", "2.5", "--max-iterations: found \"2.5\", expected a whole number, at least 1");
  for (const char* key : {"analysis", "formulation", "integrator", "linear_solver", "jacobian", "stopping"}) {
    const std::string option = option_name(*find_setting(key));
    refused(option.c_str(), "no_such", fmt::format("{}: found \"no_such\", expected one of {}", option, names(key)));
  }
  EXPECT_TRUE(poinsot({"run", "pendulum.json", "--end", "1/0"}).err.starts_with("poinsot: --end: found \"1/0\" ("));
  const Result text = poinsot({"run", "pendulum.json", "--step", "small"});
  EXPECT_EQ(text.status, 2);
  EXPECT_TRUE(text.err.starts_with("poinsot: --step: found \"small\" (")) << text.err;
  EXPECT_TRUE(text.err.ends_with("), expected a number greater than 0\n")) << text.err;
}

TEST_F(WrongInput, Configuration) {
  std::vector<std::string_view> keys;
  for (const SettingEntry& entry : setting_entries()) keys.push_back(entry.key);
  expect_configuration_refused(
      R"({"stepp": 1})",
      fmt::format("poinsot: config.json: /stepp: unknown key, expected for a solver configuration: {}",
                  fmt::join(keys, ", ")));
  expect_configuration_refused(R"({"step": true})",
                               "poinsot: config.json: /step: found true, expected a number greater than 0");
  expect_configuration_refused(R"({"step": 0})",
                               "poinsot: config.json: /step: found 0, expected a number greater than 0");
  expect_configuration_refused(R"({"rtol": 1e-15})",
                               "poinsot: config.json: /rtol: found 1e-15, expected a number from 2.2e-15 to 1");
  expect_configuration_refused(R"({"spectral_radius": 3})",
                               "poinsot: config.json: /spectral_radius: found 3, expected a number from 0 to 1");
  expect_configuration_refused(
      R"({"integrator": "rattle", "spectral_radius": 0.5})",
      "poinsot: config.json: /spectral_radius: no parameter of integrator 'rattle'; it is one of "
      "generalized_alpha, generalized_alpha_i2");
  expect_configuration_refused(R"({"analysis": "kinematics",
  "spectral_radius": 0.5})",
                               "poinsot: config.json: /spectral_radius: no parameter of kinematics; it is one of "
                               "generalized_alpha, generalized_alpha_i2 (line 2)");
  expect_configuration_refused(R"({"max_iterations": 0})",
                               "poinsot: config.json: /max_iterations: found 0, expected a whole number, at least 1");
  expect_configuration_refused(
      R"({"linear_solver": "slu"})",
      fmt::format("poinsot: config.json: /linear_solver: found \"slu\", expected one of {}", names("linear_solver")));
  expect_configuration_refused(
      R"({"formulation": 3})",
      fmt::format("poinsot: config.json: /formulation: found 3, expected one of {}", names("formulation")));
  expect_configuration_refused(R"({"step": 1, "step": 2})",
                               "poinsot: config.json: /step: found the key twice, expected it once");
  expect_configuration_refused(
      "[]",
      "poinsot: config.json: /: found an array of 0 values, expected a solver configuration as "
      "an object");
  expect_configuration_refused("{\"end\": 1,\n \"step\": 0}",
                               "poinsot: config.json: /step: found 0, expected a number greater than 0 (line 2)");
  write("config.json", "{\"step\": 1,\n \"end\" 2}");
  const Result syntax = poinsot({"run", "pendulum.json", "--config", "config.json"});
  EXPECT_EQ(syntax.status, 2);
  EXPECT_TRUE(syntax.err.starts_with("poinsot: config.json: line 2, column 8: ")) << syntax.err;
  EXPECT_EQ(lines(syntax.err).size(), 1u);
}

// What is wrong only beside the other settings is told with its place, too, unless the command line has overruled it.
TEST_F(WrongInput, AConfigurationThatDoesNotFitTogetherIsToldWithItsPlace) {
  expect_configuration_refused(
      R"({"integrator": "implicit_euler", "step": 0.01, "every": 0.015})",
      "poinsot: config.json: /every: found 0.015 s, expected a multiple of the step 0.01 s; try 0.02");
  expect_configuration_refused(
      R"({"integrator": "rattle", "step": 1e-300})",
      "poinsot: config.json: /step: found 1e-300 s with end 1 s, which are 1e+300 steps, expected at most 1e15; try a "
      "larger step");
  expect_refused({"view", "pendulum.json", "--config", "config.json", "--out", "a.html", "--step", "1e-200"},
                 "poinsot: --step: found 1e-200 s with end 1 s, which are 1e+200 steps, expected at most 1e15; try a "
                 "larger step");
}

TEST_F(WrongInput, TimeGrid) {
  expect_refused({"run", "pendulum.json", "--integrator", "implicit_euler", "--step", "0.01", "--every", "0.015",
                  "--out", "a.csv"},
                 "poinsot: --every: found 0.015 s, expected a multiple of the step 0.01 s; try 0.02");
  expect_refused(
      {"run", "pendulum.json", "--integrator", "implicit_euler", "--step", "1e-300", "--out", "a.csv"},
      "poinsot: --step: found 1e-300 s with end 1 s, which are 1e+300 steps, expected at most 1e15; try a larger step");
  for (const char* integrator : {"implicit_euler", "dopri5"}) {
    expect_refused(
        {"run", "pendulum.json", "--integrator", integrator, "--every", "1e-300", "--out", "a.csv"},
        "poinsot: --every: found 1e-300 s with end 1 s, which are 1e+300 output times, expected at most 1e15; "
        "try a larger one");
  }
  expect_refused({"run", "pendulum.json", "--integrator", "dopri5", "--end", "1e-320", "--rtol", "1"},
                 "poinsot: --end: found \"1e-320\", expected a number, at least 1e-292");
}

TEST_F(WrongInput, OutputPaths) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.begin(), {"run", "pendulum.json"});
    expect_refused(arguments, "poinsot: " + message);
  };
  refused({"--out", "pendulum.json/a.csv"},
          "pendulum.json: the folder cannot be made: it is a file; choose another name");
  refused({"--out", "."}, ".: cannot be written: it is a directory; give a file name");
  refused({"--out", "no/such/a.csv", "--reactions", "."}, ".: cannot be written: it is a directory; give a file name");
  refused({"--out", "pendulum.json"},
          "pendulum.json: --out would overwrite the scene; choose another name or folder for the output");
  refused({"--out", "a.csv", "--reactions", "./a.csv"},
          "a.csv: --out and --reactions would be the same file; choose different names");
  refused({"--out", "r.csv", "--reactions", "r.run.json"},
          "r.run.json: --reactions and the run record would be the same file; choose different names");
}

TEST_F(WrongInput, KinematicsOfAMechanismThatCanMove) {
  const Result result = poinsot({"run", "pendulum.json", "--analysis", "kinematics", "--out", "a.csv"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err,
            "poinsot: pendulum.json: kinematics needs a mechanism without degrees of freedom, this one has 1; add "
            "drivers, or use analysis "
            "dynamics\n");
  EXPECT_EQ(files(), std::vector<std::string>{"pendulum.json"});
}

}  // namespace
}  // namespace poinsot::test
