// The trajectory and reaction files: columns, rows and digits of the contract.
#include <fmt/format.h>

#include <cmath>

#include "command_line.h"

namespace poinsot::test {
namespace {

// Two bodies turning freely, one of them past half a turn: e0 of its Euler parameters changes sign.
const char* const kTurning = R"({
  "scene": 1,
  "name": "turning",
  "bodies": [
    {"name": "top", "mass": 1, "inertia": [1, 1, 1], "position": [1, 2, 3], "velocity": [1, 0, -1],
     "angular_velocity": [0, 0, "2*pi"]},
    {"name": "a, b", "mass": 1, "inertia": [1, 2, 3], "position": [0, 0, 0], "angular_velocity": [0.1, 3, 0.1]}],
  "constraints": [{"type": "CD", "name": "slot", "bodies": ["ground", "top"], "c": [0, 1, 0],
    "s_i": [0, 2, 0], "s_j": [0, 0, 0]}],
  "forces": [{"type": "force", "body": "top", "point": [0, 0, 0], "force": ["2", "0", "0"]}]
})";

class Trajectory : public CommandLine {
 protected:
  Trajectory() { write("scene.json", kTurning); }

  std::vector<std::vector<double>> rows(const std::string& file) const {
    std::vector<std::vector<double>> result;
    for (const std::string& line : lines(read(file))) {
      if (line.starts_with("t,")) continue;
      result.emplace_back();
      for (const std::string& field : fields(line)) result.back().push_back(std::stod(field));
    }
    return result;
  }
};

TEST_F(Trajectory, Header) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--end", "0.1", "--out", "a.csv"}).status, 0);
  EXPECT_EQ(
      lines(read("a.csv"))[0],
      "t,top.x,top.y,top.z,top.e0,top.e1,top.e2,top.e3,top.vx,top.vy,top.vz,top.wx,top.wy,top.wz,top.ax,top.ay,top.az,"
      "top.alx,top.aly,top.alz,\"a, b.x\",\"a, b.y\",\"a, b.z\",\"a, b.e0\",\"a, b.e1\",\"a, b.e2\",\"a, b.e3\","
      "\"a, b.vx\",\"a, b.vy\",\"a, b.vz\",\"a, b.wx\",\"a, b.wy\",\"a, b.wz\",\"a, b.ax\",\"a, b.ay\",\"a, b.az\","
      "\"a, b.alx\",\"a, b.aly\",\"a, b.alz\"");
}

TEST_F(Trajectory, RowsAndDigits) {
  ASSERT_EQ(
      poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "1", "--step", "0.01", "--out", "a.csv"})
          .status,
      0);
  const auto text = lines(read("a.csv"));
  const auto values = rows("a.csv");
  ASSERT_EQ(values.size(), 101u);
  for (std::size_t n = 0; n < values.size(); ++n) {
    ASSERT_EQ(values[n].size(), 39u);
    EXPECT_DOUBLE_EQ(values[n][0], static_cast<double>(n) * 0.01);
    const auto written = fields(text[n + 1]);
    for (std::size_t k = 0; k < written.size(); ++k) EXPECT_EQ(written[k], fmt::format("{:.17g}", values[n][k]));
    for (const std::size_t e0 : {4u, 23u}) {
      EXPECT_GE(values[n][e0], 0);
      double norm = 0;
      for (std::size_t k = 0; k < 4; ++k) norm += values[n][e0 + k] * values[n][e0 + k];
      EXPECT_NEAR(norm, 1, 1e-12);
    }
  }
  // The first row is the initial state, with its accelerations: the force of 2 N on 1 kg.
  const std::vector<double> first{0, 1, 2, 3, 1, 0, 0, 0, 1, 0, -1, 0, 0, 2 * M_PI, 2, 0, 0, 0, 0, 0};
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_NEAR(values[0][k], first[k], 1e-12) << k;
  // Uniform rotation about z: at t = 0.75 by 270 degrees, which with e0 ≥ 0 is −90 degrees.
  EXPECT_NEAR(values[75][4], std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(values[75][7], -std::sqrt(0.5), 1e-9);
}

TEST_F(Trajectory, EveryThinsTheRows) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "1", "--step", "0.01", "--out",
                     "a.csv", "--reactions", "ra.csv"})
                .status,
            0);
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "1", "--step", "0.01", "--every",
                     "0.3", "--out", "b.csv", "--reactions", "rb.csv"})
                .status,
            0);
  for (const auto& [full, thin] : {std::pair{"a.csv", "b.csv"}, {"ra.csv", "rb.csv"}}) {
    const auto all = lines(read(full));
    EXPECT_EQ(lines(read(thin)), (std::vector<std::string>{all[0], all[1], all[31], all[61], all[91], all[101]}));
  }
}

TEST_F(Trajectory, Reactions) {
  write("pendulum.json", kPendulum);
  ASSERT_EQ(poinsot({"run", "pendulum.json", "--end", "0.1", "--reactions", "r.csv"}).status, 0);
  EXPECT_EQ(lines(read("r.csv"))[0], "t,revolute1.fx,revolute1.fy,revolute1.fz,revolute1.nx,revolute1.ny,revolute1.nz");
  // A rod of 3 kg and 1 kg m² that is let go from the horizontal, its centre 1 m from the hinge: the angular
  // acceleration is m g / (1 + m), and the hinge carries m (g − that).
  const std::vector<double> expected{0, 0, 0, 3 * (9.81 - 3 * 9.81 / 4), 0, 0, 0};
  const auto first = rows("r.csv")[0];
  ASSERT_EQ(first.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(first[k], expected[k], 1e-10) << k;

  ASSERT_EQ(poinsot({"run", "scene.json", "--end", "0.1", "--reactions", "s.csv"}).status, 0);
  EXPECT_EQ(lines(read("s.csv"))[0], "t,slot.lambda");
}

// The run ends soon, at a force without a value, but that is not known before.
TEST_F(Trajectory, OfManyGigabytesIsToldBeforeItIsWritten) {
  write("short.json", R"({"scene": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
    "forces": [{"type": "force", "body": "a", "point": [0, 0, 0], "force": ["0*sqrt(1e-6 - t) ", 0, 0]}]})");
  const auto told = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", "short.json", "--columns", "position"});
    const Result result = poinsot(options);
    EXPECT_EQ(result.status, 3) << result.err;
    return lines(result.err).at(0);
  };
  const std::string note = "poinsot: note: ", advice = "; a larger --every writes fewer";
  EXPECT_EQ(told({"--every", "1e-9", "--out", "a.csv"}),
            note + "1e+09 rows are to be written, of up to 100 bytes each: 100 GB" + advice);
  EXPECT_EQ(told({"--every", "1e-9", "--out", "a.npy", "--reactions", "r.csv"}),
            note + "1e+09 rows are to be written, of up to 57 bytes each: 57 GB" + advice);
  EXPECT_EQ(told({"--integrator", "rattle", "--step", "1e-8", "--out", "a.csv"}),
            note + "1e+08 rows are to be written, of up to 100 bytes each: 10 GB" + advice);
  for (const std::vector<std::string>& little : {std::vector<std::string>{"--every", "1e-6", "--out", "a.csv"},
                                                 {"--every", "1e-9", "--out", "/dev/null"},
                                                 {"--every", "1e-9", "--out", "a.csv", "--quiet"},
                                                 {"--out", "a.csv"}})
    EXPECT_EQ(told(little).find("are to be written"), std::string::npos);
}

}  // namespace
}  // namespace poinsot::test
