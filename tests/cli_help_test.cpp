// Help texts and lists say what there is, from the same tables that the program runs by.
#include <fmt/format.h>

#include "command_line.h"
#include "core/provenance.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "integrators/settings_reader.h"
#include "integrators/stopping_test.h"
#include "linsolve/registry.h"

namespace poinsot::test {
namespace {

class Help : public CommandLine {
 protected:
  std::string said(const std::vector<std::string>& arguments) const {
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(files().empty());
    return result.out;
  }
};

TEST_F(Help, EveryCommandIsInTheHelpAndHasItsOwn) {
  const std::string help = said({"--help"});
  for (const char* command : {"run", "check", "view", "list", "tables", "make", "scale", "reference", "chart", "advise",
                              "figures", "study", "report", "compare", "completion", "manual"}) {
    EXPECT_NE(help.find(fmt::format("\n  {} ", command)), std::string::npos) << help;
    const std::string own = said({command, "--help"});
    EXPECT_NE(own.find(fmt::format("Usage: poinsot {} ", command)), std::string::npos);
    EXPECT_NE(own.find("--quiet"), std::string::npos) << command;
  }
  EXPECT_NE(help.find("Exit status: 0 done; 2 the input is wrong"), std::string::npos);
}

TEST_F(Help, RunNamesEverySettingItsValuesAndItsDefault) {
  const std::string help = said({"run", "--help"});
  for (const SettingEntry& entry : setting_entries()) {
    const std::size_t at = help.find(fmt::format("\n  {}", option_name(entry)));
    ASSERT_NE(at, std::string::npos) << entry.key;
    const std::string text = help.substr(at, help.find("\n  -", at + 1) - at);
    EXPECT_NE(text.find(std::string(entry.about)), std::string::npos) << entry.key << text;
    EXPECT_NE(text.find(fmt::format("default {}", value_text(entry, Settings{}))), std::string::npos)
        << entry.key << text;
    if (!entry.names) continue;
    for (const std::string& name : entry.names()) EXPECT_NE(text.find(name), std::string::npos) << entry.key << name;
  }
  for (const char* option : {"--config FILE", "--out FILE.csv", "--reactions FILE.csv", "--quiet", "--no-assemble"})
    EXPECT_NE(help.find(option), std::string::npos) << option;
}

TEST_F(Help, ListHasALineForEveryEntryOfEveryRegistry) {
  const std::vector<std::string> list = lines(said({"list"}));
  std::size_t expected = 6;
  const auto listed = [&](const char* title, const auto& table) {
    EXPECT_NE(std::find(list.begin(), list.end(), title), list.end()) << title;
    for (const auto& entry : table) {
      ++expected;
      EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const std::string& line) {
        return line.starts_with(fmt::format("  {} ", entry.name)) && line.ends_with(entry.about);
      })) << entry.name;
    }
  };
  listed("formulations", formulations());
  listed("integrators", integrators());
  listed("linear solvers", linear_solvers());
  listed("linear systems", linear_systems());
  listed("jacobians", jacobians());
  listed("stopping tests", stopping_tests());
  for (const IntegratorEntry& entry : integrators()) {
    for (const MethodParameter& parameter : entry.parameters) {
      ++expected;
      EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const std::string& line) {
        return line.ends_with(fmt::format("{}, {} to {}, default {}: {}", parameter.name, parameter.least,
                                          parameter.most, parameter.by_default, parameter.about));
      })) << entry.name;
    }
    for (const FormulationEntry& formulation : formulations()) {
      const auto refusal = refusal_of(entry, formulation.name);
      if (!refusal) continue;
      ++expected;
      EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const std::string& line) {
        return line.ends_with(fmt::format("refuses {}: {}", formulation.name, refusal->why));
      })) << entry.name;
    }
  }
  EXPECT_EQ(list.size(), expected);
}

TEST_F(Help, Version) {
  const std::string version = said({"--version"});
  EXPECT_TRUE(version.starts_with(
      fmt::format("poinsot {} (commit {}", provenance().version, provenance().commit.substr(0, 12))))
      << version;
}

}  // namespace
}  // namespace poinsot::test
