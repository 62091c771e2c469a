// `poinsot study` in a folder of its own: a pendulum of varied length, and studies of it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../command_line.h"
#include "../scale.h"

namespace poinsot::test {

inline const int kMany = std::max(400, scaled(800));  // samples, of two cases each, which take a while and much room

class CliStudy : public CommandLine {
 protected:
  CliStudy() {
    write("pendulum.json", R"({"scene": 1, "name": "pendulum", "parameters": {"l": 1}, "gravity": [0, 0, -9.81],
      "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, "l", 0]}],
      "joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})");
    write_study(40, 0.02);
  }

  void write_study(int samples, double end, const std::string& more = "") const {
    write("study.json", fmt::format(R"({{"study": 1, "seed": 7, "scenes": ["pendulum.json"],
      "settings": {{"integrator": "implicit_euler", "step": 1e-3, "end": {}}},
      "vary": [{{"samples": {}, "parameters": {{"l": {{"uniform": [0.5, 2]}}}}}},
               {{"setting": "formulation", "values": ["rA", "rp"]}}],
      "keep": [{{"column": "rod.y", "take": ["min", "range"], "at": [0.01]}}, {{"column": "hinge.fz"}},
               {{"column": "hinge.angle"}}, "violation", "energy_drift", "counts"]{}}})",
                                    end, samples, more));
  }
  Result study(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"study", "study.json", "--quiet"});
    return poinsot(arguments);
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& why) const {
    const Result result = study(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  }
  std::string reference() const {
    const Result result = study({"--threads", "1", "--out", "reference"});
    EXPECT_EQ(result.status, 0) << result.err;
    return read("reference/cases.csv");
  }
};

}  // namespace poinsot::test
