// What `run` can write beside a whole trajectory: signals, chosen columns and bodies, .npy, the state at the end.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>
#include <tuple>

#include "tests/command_line.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class CliResults : public CommandLine {};

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

TEST_F(CliResults, SignalsHaveTheColumnsOfTheContract) {
  write("pend.json", kPendulum);
  const Result result = poinsot({"run", "pend.json", "--end", "0.1", "--every", "0.05", "--signals", "s.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(first_line(read("s.csv")),
            "t,kinetic,potential,energy,px,py,pz,Lx,Ly,Lz,revolute1.angle,revolute1.angle_rate");
}

TEST_F(CliResults, ColumnsAndBodiesChooseWhatATrajectoryHolds) {
  write("pend.json", kPendulum);
  ASSERT_EQ(poinsot({"run", "pend.json", "--end", "0.1", "--every", "0.05", "--out", "x.csv", "--columns",
                     "velocity,position", "--bodies", "rod"})
                .status,
            0);
  EXPECT_EQ(first_line(read("x.csv")), "t,rod.x,rod.y,rod.z,rod.vx,rod.vy,rod.vz");
  const Result unknown = poinsot({"run", "pend.json", "--out", "x.csv", "--columns", "speed"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--columns: found \"speed\", expected one or more of position, orientation"));
  const Result nobody = poinsot({"run", "pend.json", "--out", "x.csv", "--bodies", "crank"});
  EXPECT_EQ(nobody.status, 2);
  EXPECT_THAT(nobody.err, HasSubstr("--bodies: found \"crank\", expected one or more of rod"));
  // Names may hold commas themselves.
  write("free.json", R"({"scene": 1, "bodies": [
    {"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]},
    {"name": "rod, left", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]},
    {"name": "rod", "mass": 1, "inertia": [1, 1, 1], "position": [2, 0, 0]}]})");
  for (const char* both : {"rod, left,a", "a,rod, left"}) {
    const Result chosen = poinsot({"run", "free.json", "--out", "x.csv", "--columns", "position", "--bodies", both});
    EXPECT_EQ(chosen.status, 0) << chosen.err;
    EXPECT_EQ(first_line(read("x.csv")), "t,a.x,a.y,a.z,\"rod, left.x\",\"rod, left.y\",\"rod, left.z\"");
  }
}

// The array of an .npy file, read by its header.
std::vector<double> numbers_of(const std::string& npy, std::size_t& rows, std::size_t& columns) {
  EXPECT_THAT(npy, StartsWith(std::string("\x93NUMPY\x01\0", 8)));
  const std::size_t header = static_cast<unsigned char>(npy[8]) + 256 * static_cast<unsigned char>(npy[9]);
  EXPECT_EQ((10 + header) % 64, 0);
  const std::string dictionary = npy.substr(10, header);
  std::smatch shape;
  EXPECT_TRUE(std::regex_match(
      dictionary, shape, std::regex(R"(\{'descr': '<f8', 'fortran_order': False, 'shape': \((\d+), (\d+)\), \} *\n)")))
      << dictionary;
  rows = std::stoul(shape[1]), columns = std::stoul(shape[2]);
  EXPECT_EQ(npy.size(), 10 + header + 8 * rows * columns);
  std::vector<double> numbers(rows * columns);
  std::memcpy(numbers.data(), npy.data() + 10 + header, 8 * numbers.size());
  return numbers;
}

TEST_F(CliResults, AnNpyHoldsTheNumbersOfTheCsv) {
  write("pend.json", kPendulum);
  const std::string door = fmt::format("{}/models/door.json", POINSOT_SOURCE_DIR);  // with undetermined reactions
  for (const auto& [scene, option, width] : {std::tuple{"pend.json", "--out", 20u},
                                             {"pend.json", "--reactions", 7u},
                                             {"pend.json", "--signals", 12u},
                                             {door.c_str(), "--reactions", 37u}}) {
    SCOPED_TRACE(fmt::format("{} {}", scene, option));
    for (const char* file : {"x.csv", "x.npy"})
      ASSERT_EQ(poinsot({"run", scene, "--end", "0.1", "--every", "0.02", option, file}).status, 0);
    std::size_t rows = 0, columns = 0;
    const std::vector<double> numbers = numbers_of(read("x.npy"), rows, columns);
    EXPECT_EQ(rows, 6U);
    EXPECT_EQ(columns, width);
    std::string csv = read("x.csv");
    const std::string header = first_line(csv);
    csv.erase(0, header.size() + 1);
    std::replace(csv.begin(), csv.end(), '\n', ',');
    std::stringstream fields(csv);
    std::string field;
    for (const double x : numbers) {
      ASSERT_TRUE(std::getline(fields, field, ','));
      EXPECT_EQ(x, std::stod(field));
    }
    std::string names;
    const nlohmann::json record = read_json("x.run.json");
    for (const auto& name : record["columns"][option]) names += (names.empty() ? "" : ",") + name.get<std::string>();
    EXPECT_EQ(names, header);
  }
}

TEST_F(CliResults, AnNpyOfAReferenceHasNamesForItsColumns) {
  write("pend.json", kPendulum);
  for (const char* file : {"x.csv", "x.npy"})
    ASSERT_EQ(poinsot({"reference", "pend.json", "--end", "0.1", "--cache", "cache", "--out", file}).status, 0);
  std::string names;
  const nlohmann::json record = read_json("x.run.json");
  for (const auto& name : record["columns"]["--out"]) names += (names.empty() ? "" : ",") + name.get<std::string>();
  EXPECT_EQ(names, first_line(read("x.csv")));
}

TEST_F(CliResults, ASavedStateRunsOn) {
  write("pend.json", kPendulum);
  const auto end_of = [&](const char* scene, const char* end) {
    const Result result =
        poinsot({"run", scene, "--integrator", "rattle", "--tolerance", "1e-9", "--end", end, "--every", end, "--out",
                 "x.csv", "--columns", "position,velocity", "--save-state", "saved.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    std::string csv = read("x.csv");
    csv.pop_back();
    return csv.substr(csv.rfind('\n') + 1);
  };
  const std::string through = end_of("pend.json", "0.4");
  (void)end_of("pend.json", "0.2");
  write("half.json", read("saved.json"));
  EXPECT_THAT(read("half.json"), HasSubstr("\"axis_i\""));
  std::stringstream a(through.substr(through.find(',') + 1)), b;
  const std::string on = end_of("half.json", "0.2");
  b.str(on.substr(on.find(',') + 1));
  for (std::string x, y; std::getline(a, x, ',');) {
    ASSERT_TRUE(std::getline(b, y, ','));
    EXPECT_NEAR(std::stod(x), std::stod(y), 1e-12);
  }
}

TEST_F(CliResults, ASavedStateIsWrittenToStandardOutputToo) {
  write("pend.json", kPendulum);
  const Result result = poinsot({"run", "pend.json", "--end", "0.1", "--quiet", "--save-state", "/dev/stdout"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["scene"], 1);
}

}  // namespace
}  // namespace poinsot::test
