// `poinsot run --verify` by every integrator in every formulation: what is printed, what the record holds, and what a
// run says of its accuracy by itself.
#include <gmock/gmock.h>

#include <algorithm>

#include "bench/study/verification.h"
#include "command_line.h"
#include "tests/support/every_way.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPrinted[] = {"position",     "orientation",          "velocity",       "angular velocity",
                                    "acceleration", "angular acceleration", "reaction force", "reaction moment"};

// Its centre is beside the hinge, which bears moments.
const char* const kAskewPendulum = R"({
  "scene": 1, "name": "askew", "gravity": [0, 0, -9.81],
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0.3, 1, 0]}],
  "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]
})";

const char* const kDrivenPendulum = R"({
  "scene": 1, "name": "driven", "gravity": [0, 0, -9.81],
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, 1, 0]}],
  "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
  "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [1, 0, 0], "angle": "0.5*t + t^2"}]
})";

class VerifyMethods : public CommandLine {
 protected:
  VerifyMethods() {
    write("pendulum.json", kAskewPendulum);
    write("driven.json", kDrivenPendulum);
  }

  // The lines of quantities: what is printed is what the record holds.
  void expect_printed(const Result& result, const nlohmann::json& verified, bool orders) const {
    const std::vector<std::string> said = lines(result.out);
    ASSERT_EQ(verified["quantities"].size(), std::size(kPrinted));
    for (std::size_t k = 0; k < std::size(kPrinted); ++k) {
      const nlohmann::json& q = verified["quantities"][k];
      EXPECT_EQ(q["quantity"], kPrinted[k]);
      std::string line =
          fmt::format("  {:<20} {:>8.2g} {:<7}", kPrinted[k], q["apart"].get<double>(), q["unit"].get<std::string>());
      if (q["apart"] > 0) line += fmt::format(" {} at t = {:g} s", q["where"].get<std::string>(), q["t"].get<double>());
      if (q.contains("order"))
        line += q["order"].is_null() ? ", order not seen" : fmt::format(", order {:.2f}", q["order"].get<double>());
      if (q.contains("error"))
        line += fmt::format(", so the error is about {:.2g}", q["error"].get<double>());
      else if (q.contains("order") && !q["order"].is_null())
        line += ": the step is too long to tell the error";
      EXPECT_THAT(said, ::testing::Contains(line));
      EXPECT_EQ(q.contains("order"), orders) << kPrinted[k];
    }
  }
};

TEST_F(VerifyMethods, SayHowFarApartAndTheOrder) {
  const int ways = in_every_way(5e-3, 0.1, [&](const Settings& settings) {
    const IntegratorEntry& integrator = integrators().require(settings.integrator);
    const Result result = poinsot({"run", "pendulum.json", "--integrator", settings.integrator, "--formulation",
                                   settings.formulation, "--step", "5e-3", "--end", "0.1", "--tolerance", "1e-9",
                                   "--rtol", "1e-6", "--verify", "--out", "a.csv", "--reactions", "r.csv"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json record = read_json("a.run.json"), verified = record["verify"];
    EXPECT_EQ(verified["failure"], "");
    expect_printed(result, verified, !integrator.controls_error);
    const std::string by_itself = record["accuracy"];
    if (integrator.controls_error) {
      EXPECT_THAT(by_itself,
                  ::testing::StartsWith("the error of a step, as estimated, is held to rtol 1e-06 and atol"));
      EXPECT_THAT(result.out, HasSubstr("verified against a tenth of the tolerances, rtol 1e-07 and atol 1e-09: "));
      return;
    }
    EXPECT_EQ(by_itself, "not estimated");
    EXPECT_THAT(result.out, HasSubstr("verified against half the step, h = 0.0025 s: apart by at most, of 21 times"));
    // In plane motion half-implicit Euler has velocities of second order, but for what rp adds.
    for (const nlohmann::json& q : verified["quantities"]) {
      const std::string name = q["quantity"];
      if (settings.integrator == "half_implicit" && name.ends_with("velocity")) continue;
      if (q["order"].is_null()) {  // as of the first step's accelerations by Euler's methods
        EXPECT_FALSE(q.contains("error")) << name;
        continue;
      }
      EXPECT_LT(q["order"].get<double>(), integrator.order + 1.25) << name;
      EXPECT_GT(q["order"].get<double>(), integrator.order - 0.2) << name;
    }
  });
  EXPECT_GE(ways, 25);
}

// Where two motions have nothing more to do with one another.
TEST_F(VerifyMethods, NameNoErrorWhereDifferencesDoNotShrink) {
  write("double.json", R"({
    "scene": 1, "name": "double", "gravity": [0, 0, -9.81],
    "bodies": [{"name": "upper", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 1, 0]},
               {"name": "lower", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 3, 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "upper"], "point": [0, 0, 0], "axis": [1, 0, 0]},
               {"type": "revolute", "bodies": ["upper", "lower"], "point": [0, 2, 0], "axis": [1, 0.1, 0]}]
  })");
  const Result result = poinsot({"run", "double.json", "--integrator", "implicit_euler", "--step", "0.05", "--end",
                                 "10", "--verify", "--out", "a.csv", "--reactions", "r.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json verified = read_json("a.run.json")["verify"];
  expect_printed(result, verified, true);
  const auto& all = verified["quantities"];
  EXPECT_FALSE(std::ranges::all_of(all, [](const nlohmann::json& q) { return q.contains("error"); })) << all;
}

TEST_F(VerifyMethods, OfKinematicsSayThatNothingAddsUp) {
  for (const FormulationEntry& formulation : formulations()) {
    SCOPED_TRACE(formulation.name);
    const Result result = poinsot({"run", "driven.json", "--analysis", "kinematics", "--formulation",
                                   std::string(formulation.name), "--step", "0.1", "--end", "2", "--tolerance", "1e-4",
                                   "--verify", "--out", "a.csv", "--reactions", "r.csv"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json record = read_json("a.run.json");
    EXPECT_EQ(record["accuracy"], "every position is found on its own, to the tolerance 0.0001");
    EXPECT_THAT(result.out, HasSubstr("verified against half the step and a tenth of the tolerance, 1e-05: apart by at "
                                      "most, of 21 times\n"));
    EXPECT_THAT(result.out, Not(HasSubstr("order")));
    expect_printed(result, record["verify"], false);
    EXPECT_LT(record["verify"]["quantities"][0]["apart"], 1e-4);
  }
}

// Without --verify the line points to it.
TEST_F(VerifyMethods, TheAccuracyLineOfEachKindOfRunPointsToIt) {
  for (const auto& [arguments, accuracy] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"pendulum.json", "--integrator", "rattle"}, "not estimated"},
           {{"pendulum.json", "--rtol", "1e-5"},
            "the error of a step, as estimated, is held to rtol 1e-05 and atol 1e-07; what adds up over the run is not "
            "estimated"},
           {{"driven.json", "--analysis", "kinematics"},
            "every position is found on its own, to the tolerance 0.001"}}) {
    std::vector<std::string> run{"run", "--step", "0.01", "--end", "0.1"};
    run.insert(run.end(), arguments.begin(), arguments.end());
    EXPECT_THAT(poinsot(run).out, HasSubstr("accuracy: " + accuracy + "; --verify\n"));
    run.emplace_back("--verify");
    EXPECT_THAT(poinsot(run).out, HasSubstr("accuracy: " + accuracy + "\n"));
    run.back() = "--out";
    run.emplace_back("a.csv");
    ASSERT_EQ(poinsot(run).status, 0);
    EXPECT_EQ(read_json("a.run.json")["accuracy"], accuracy);
    EXPECT_FALSE(read_json("a.run.json").contains("verify"));
  }
}

}  // namespace
}  // namespace poinsot::test
