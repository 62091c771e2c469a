// --json of check, advise, list and reference against schemas; completions and manual against the command line.
#include <fmt/format.h>

#include "command_line.h"
#include "formulations/registry.h"
#include "integrators/settings_reader.h"

namespace poinsot::test {
namespace {

class JsonOutput : public CommandLine {
 protected:
  JsonOutput() { write("pendulum.json", kPendulum); }

  // What a command says as JSON, of the schema.
  nlohmann::json said(std::vector<std::string> arguments, const std::string& schema, int status = 0) const {
    arguments.push_back("--json");
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    write("said.json", result.out);
    write("schema.json", schema);
    EXPECT_EQ(shell("python3 -c 'import json, jsonschema; "
                    "jsonschema.validate(json.load(open(\"said.json\")), json.load(open(\"schema.json\")))'"),
              0)
        << result.out;
    return nlohmann::json::parse(result.out);
  }
};

TEST_F(JsonOutput, List) {
  const nlohmann::json list = said({"list"}, R"({
    "type": "object", "additionalProperties": false,
    "required": ["formulations", "integrators", "linear_solvers", "linear_systems", "jacobians", "stopping_tests"],
    "properties": {
      "formulations": {"$ref": "#/$defs/named"}, "linear_solvers": {"$ref": "#/$defs/named"},
      "linear_systems": {"$ref": "#/$defs/named"}, "jacobians": {"$ref": "#/$defs/named"},
      "stopping_tests": {"$ref": "#/$defs/named"},
      "integrators": {"type": "array", "items": {"type": "object", "additionalProperties": false,
        "required": ["name", "about", "analysis", "order", "controls_error", "parameters", "refuses"],
        "properties": {"name": {"type": "string"}, "about": {"type": "string"},
          "analysis": {"enum": ["kinematics", "dynamics"]}, "order": {"type": "integer"},
          "controls_error": {"type": "boolean"},
          "parameters": {"type": "array", "items": {"type": "object",
            "required": ["name", "about", "default", "least", "most"]}},
          "refuses": {"type": "array", "items": {"type": "object", "required": ["formulation", "why"]}}}}}},
    "$defs": {"named": {"type": "array", "minItems": 1, "items": {"type": "object", "additionalProperties": false,
      "required": ["name", "about"], "properties": {"name": {"type": "string"}, "about": {"type": "string"}}}}}})");
  EXPECT_EQ(list["formulations"].size(), formulations().size());
  EXPECT_EQ(list["integrators"].size(), integrators().size());
}

const char* const kCheck = R"({
  "type": "object", "additionalProperties": false,
  "required": ["scene", "bodies", "rows", "degrees_of_freedom", "singular_position", "singular", "touching",
               "redundant", "conflicting", "undetermined_reactions", "undetermined_components", "violation",
               "notices", "derivatives", "sound", "message"],
  "properties": {
    "scene": {"type": "string"}, "bodies": {"type": "integer"}, "rows": {"type": "integer"},
    "mass": {"type": "number"}, "extent": {"type": "array"}, "gravity": {"type": "array"}, "joints": {"type": "array"},
    "degrees_of_freedom": {"type": "integer"}, "singular_position": {"type": "boolean"},
    "singular": {"$ref": "#/$defs/rows"}, "touching": {"$ref": "#/$defs/rows"},
    "redundant": {"$ref": "#/$defs/rows"}, "conflicting": {"$ref": "#/$defs/rows"},
    "undetermined_reactions": {"type": "array", "items": {"type": "string"}},
    "undetermined_components": {"type": "array", "items": {"type": "array", "items": {"type": "string"}}},
    "violation": {"type": "object", "required": ["position", "velocity"]},
    "notices": {"type": "array", "items": {"type": "string"}},
    "derivatives": {"type": "object", "required": ["compared", "largest_difference", "wrong"]},
    "sound": {"type": "boolean"}, "message": {"type": "string"}},
  "$defs": {"rows": {"type": "array", "items": {"type": "object", "required": ["row", "follows_from"]}}}})";

TEST_F(JsonOutput, Check) {
  const nlohmann::json sound = said({"check", "pendulum.json"}, kCheck);
  EXPECT_EQ(sound["degrees_of_freedom"], 1);
  EXPECT_EQ(sound["sound"], true);
  EXPECT_GT(sound["derivatives"]["compared"], 0);
  write("conflicting.json", kConflicting);
  const nlohmann::json conflicting = said({"check", "conflicting.json"}, kCheck, 2);
  ASSERT_EQ(conflicting["conflicting"].size(), 1u);
  EXPECT_TRUE(conflicting["conflicting"][0].contains("off_by"));
  EXPECT_EQ(conflicting["sound"], false);
  EXPECT_EQ(poinsot({"check", "pendulum.json", "--quiet"}).out, "");
}

TEST_F(JsonOutput, ReferenceAndAdvise) {
  const nlohmann::json reference =
      said({"reference", "pendulum.json", "--end", "0.5", "--digits", "6", "--cache", "cache"}, R"({
        "type": "object", "required": ["end", "every", "given", "confirmed_by_another_method", "agreement", "methods",
                                       "program", "processor", "scene"],
        "properties": {"given": {"type": "object", "required": ["integrator", "formulation", "rtol"]},
          "agreement": {"type": "object", "required": ["position", "velocity", "acceleration", "multiplier"]}}})");
  EXPECT_LT(reference["agreement"]["position"], 1e-5);
  const nlohmann::json advice =
      said({"advise", "pendulum.json", "--end", "0.5", "--accuracy", "1e-4", "--cache", "cache"}, R"({
        "type": "object", "additionalProperties": false,
        "required": ["scene", "end", "accuracy", "of", "reached", "reaching", "others", "reference",
                     "costs_without_mattering"],
        "properties": {"scene": {"type": "string"}, "end": {"type": "number"}, "accuracy": {"type": "number"},
          "of": {"type": "array"}, "reached": {"type": "boolean"},
          "reaching": {"$ref": "#/$defs/cases"}, "others": {"$ref": "#/$defs/cases"},
          "reference": {"type": "object", "required": ["integrator", "formulation", "rtol", "resolves", "unresolved"]},
          "costs_without_mattering": {"type": "array", "items": {"type": "string"}}},
        "$defs": {"cases": {"type": "array", "items": {"type": "object",
          "required": ["analysis", "formulation", "integrator", "linear_solver", "seconds", "error", "command"]}}}})");
  EXPECT_EQ(advice["reached"], true);
  EXPECT_LE(advice["reaching"][0]["error"]["position"], 1e-4);
}

using Shell = JsonOutput;

TEST_F(Shell, CompletionsNameWhatTheCommandLineTakes) {
  for (const char* shell_name : {"bash", "zsh", "fish"}) {
    const Result result = poinsot({"completion", shell_name});
    ASSERT_EQ(result.status, 0);
    write("script", result.out);
    const std::string have = fmt::format("command -v {} > /dev/null", shell_name);
    EXPECT_TRUE(shell(have) != 0 || shell(fmt::format("{} -n script", shell_name)) == 0) << shell_name;
    for (const SettingEntry& entry : setting_entries()) {
      const std::string name = option_name(entry).substr(2);
      EXPECT_NE(result.out.find(name), std::string::npos) << shell_name << name;
      if (!entry.names) continue;
      for (const std::string& word : entry.names())
        EXPECT_NE(result.out.find(word), std::string::npos) << shell_name << word;
    }
  }
  EXPECT_EQ(poinsot({"completion", "tcsh"}).err, "poinsot: SHELL: found \"tcsh\", expected one of bash, zsh, fish\n");
}

TEST_F(Shell, BashCompletes) {
  write("script", poinsot({"completion", "bash"}).out);
  const auto completed = [&](const std::string& words) {
    write("ask.sh", fmt::format("source ./script; COMP_WORDS=({}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _poinsot; "
                                "echo \"${{COMPREPLY[*]}}\" > answer",
                                words));
    EXPECT_EQ(shell("bash ask.sh"), 0);
    return read("answer");
  };
  EXPECT_EQ(completed("poinsot ch"), "check chart\n");
  EXPECT_EQ(completed("poinsot run --formulation r"), "rA rp reps\n");
  EXPECT_EQ(completed("poinsot run pend"), "pendulum.json\n");
  EXPECT_EQ(completed("poinsot run pendulum.json --rea"), "--reactions\n");
  EXPECT_EQ(completed("poinsot make la"), "ladder\n");
  EXPECT_EQ(completed("poinsot stability --family pul"), "pulse\n");
}

TEST_F(Shell, TheManualHasEveryCommandAndOption) {
  const std::string page = poinsot({"manual"}).out;
  for (const char* part : {".TH POINSOT 1 ", ".SH EXIT STATUS", ".SS poinsot run\n", "\\fB\\-\\-verify\\fR",
                           "\\fB\\-\\-linear\\-solver\\fR \\fINAME\\fR", ".SS poinsot completion\n", "NO_COLOR"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  write("page", page);
  if (shell("command -v man > /dev/null && command -v groff > /dev/null") == 0) {
    EXPECT_EQ(shell("LC_ALL=C.UTF-8 MANWIDTH=200 man --warnings -l page > shown 2> warned"), 0);
    EXPECT_EQ(read("warned"), "");
  }
}

}  // namespace
}  // namespace poinsot::test
