// `poinsot run --verify`: what it says of a run is so.
#include <cmath>
#include <map>

#include "command_line.h"

namespace poinsot::test {
namespace {

class Verify : public CommandLine {
 protected:
  Verify() { write("pendulum.json", kPendulum); }

  nlohmann::json quantity(const nlohmann::json& record, const std::string& name) const {
    for (const nlohmann::json& one : record["verify"]["quantities"])
      if (one["quantity"] == name) return one;
    return {};
  }

  // Largest |Δr| of the only body in rows of the two files at the same times, and when.
  std::pair<double, double> apart(const std::string& a, const std::string& b) const {
    std::map<double, std::vector<std::string>> rows;
    for (const std::string& line : lines(read(b)))
      if (!line.starts_with("t,")) rows[std::stod(line)] = fields(line);
    double largest = 0, when = 0;
    for (const std::string& line : lines(read(a))) {
      if (line.starts_with("t,")) continue;
      const auto x = fields(line), y = rows.at(std::stod(line));
      double square = 0;
      for (const std::size_t k : {1u, 2u, 3u}) square += std::pow(std::stod(x[k]) - std::stod(y[k]), 2);
      if (std::sqrt(square) <= largest) continue;
      largest = std::sqrt(square);
      when = std::stod(line);
    }
    return {largest, when};
  }
};

TEST_F(Verify, EqualStepsAreHalvedTwiceAndShowTheirOrder) {
  for (const auto& [integrator, order] : {std::pair{"implicit_euler", 1}, {"rattle", 2}}) {
    const auto with = [name = integrator](const char* step, const char* out) {
      return std::vector<std::string>{"run",         "pendulum.json", "--integrator", name,   "--step", step,
                                      "--tolerance", "1e-9",          "--every",      "0.01", "--out",  out};
    };
    std::vector<std::string> run = with("1e-3", "a.csv");
    run.insert(run.end(), {"--verify", "--reactions", "r.csv"});
    const Result result = poinsot(run);
    ASSERT_EQ(result.status, 0) << result.err;
    ASSERT_EQ(poinsot(with("5e-4", "b.csv")).status, 0);
    const nlohmann::json record = read_json("a.run.json");
    EXPECT_EQ(record["accuracy"], "not estimated");
    EXPECT_EQ(record["verify"]["failure"], "");
    EXPECT_EQ(record["verify"]["times"], 101);
    const auto [largest, when] = apart("a.csv", "b.csv");
    const nlohmann::json position = quantity(record, "position");
    EXPECT_DOUBLE_EQ(position["apart"], largest);
    EXPECT_DOUBLE_EQ(position["t"], when);
    EXPECT_EQ(position["where"], "rod");
    for (const char* name :
         {"position", "orientation", "velocity", "angular velocity", "acceleration", "reaction force"}) {
      EXPECT_NEAR(quantity(record, name)["order"].get<double>(), order, 0.1) << name;
      EXPECT_NE(result.out.find(std::string("\n  ") + name), std::string::npos) << result.out;
    }
    EXPECT_EQ(quantity(record, "reaction force")["where"], "revolute1");
    // Against a motion that is much more accurate, the error is what was said.
    ASSERT_EQ(poinsot({"run", "pendulum.json", "--integrator", "dop853", "--rtol", "1e-12", "--every", "0.01", "--out",
                       "exact.csv"})
                  .status,
              0);
    const double error = apart("a.csv", "exact.csv").first;
    EXPECT_NEAR(position["error"].get<double>(), error, 0.05 * error);
    EXPECT_NE(result.out.find("verified against half the step, h = 0.0005 s"), std::string::npos) << result.out;
  }
}

TEST_F(Verify, ErrorControlGetsATenthOfItsTolerances) {
  const Result result = poinsot({"run", "pendulum.json", "--integrator", "dop853", "--rtol", "1e-6", "--verify"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(
      result.out.find("accuracy: the error of a step, as estimated, is held to rtol 1e-06 and atol 1e-08; what adds "
                      "up over the run is not estimated\n"),
      std::string::npos)
      << result.out;
  EXPECT_NE(
      result.out.find("verified against a tenth of the tolerances, rtol 1e-07 and atol 1e-09: apart by at most, of "
                      "1001 times\n  position"),
      std::string::npos)
      << result.out;
  EXPECT_EQ(result.out.find("order"), std::string::npos) << result.out;
}

TEST_F(Verify, WhatFailsIsSaidAndTheStatusIsTheRuns) {
  write("overstretched.json", kOverstretched);
  const Result failed =
      poinsot({"run", "overstretched.json", "--end", "2", "--step", "0.01", "--verify", "--out", "a.csv"});
  EXPECT_EQ(failed.status, 3);
  EXPECT_EQ(failed.out, "not verified: the run did not come to its end\n");
  EXPECT_EQ(read_json("a.run.json")["verify"]["failure"], "the run did not come to its end");
  EXPECT_EQ(poinsot({"run", "pendulum.json", "--end", "0.01", "--verify", "--quiet"}).out, "");
  const Result rows =
      poinsot({"run", "pendulum.json", "--integrator", "implicit_euler", "--end", "0.01", "--verify", "--out", "-"});
  EXPECT_EQ(rows.status, 0);
  EXPECT_EQ(lines(rows.out).size(), 12u) << "the rows alone";
  EXPECT_TRUE(rows.err.starts_with("verified against half the step")) << rows.err;
}

}  // namespace
}  // namespace poinsot::test
