// `poinsot reference`: the digits it gives, what it keeps, and what it says where there is no reference.
#include <cmath>

#include "command_line.h"

namespace poinsot::test {
namespace {

class ReferenceCommand : public CommandLine {
 protected:
  ReferenceCommand() { write("pendulum.json", kPendulum); }

  Result reference(const std::string& out) const {
    return poinsot({"reference", "pendulum.json", "--end", "1", "--every", "0.25", "--cache", "cache", "--out", out});
  }
  std::filesystem::path kept() const { return *std::filesystem::directory_iterator(folder() / "cache"); }
};

// The rod's angle from the horizontal, by the classical Runge-Kutta method with steps that leave its error below 1e-13.
double angle(double end) {
  constexpr int steps = 4000;
  const double h = end / steps, of = 3 * 9.81 / (1 + 3);
  const auto rate = [&](double a) { return -of * std::cos(a); };
  double x = 0, v = 0;
  for (int k = 0; k < steps; ++k) {
    const double a1 = rate(x), a2 = rate(x + h / 2 * v), a3 = rate(x + h / 2 * v + h * h / 4 * a1),
                 a4 = rate(x + h * v + h * h / 2 * a2);
    x += h * v + h * h / 6 * (a1 + a2 + a3);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

TEST_F(ReferenceCommand, GivesTheMotionAndHowManyDigitsAgree) {
  const Result result = reference("motion.csv");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("digits that agree"), std::string::npos);
  const auto rows = lines(read("motion.csv"));
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto f = fields(rows[k]);
    const double t = 0.25 * static_cast<double>(k - 1);
    EXPECT_EQ(std::stod(f[0]), t);
    EXPECT_NEAR(std::stod(f[2]), std::cos(angle(t)), 1e-11);
    EXPECT_NEAR(std::stod(f[3]), std::sin(angle(t)), 1e-11);
  }
  const auto record = read_json("motion.run.json");
  for (const char* quantity : {"position", "velocity", "acceleration", "multiplier"}) {
    EXPECT_LT(record["agreement"][quantity].get<double>(), 1e-11) << quantity;
    for (const auto& method : record["methods"]) EXPECT_EQ(method["failure"], "");
  }
  EXPECT_TRUE(record["confirmed_by_another_method"].get<bool>());
}

TEST_F(ReferenceCommand, KeepsItByContent) {
  ASSERT_EQ(reference("first.csv").status, 0);
  const auto made = std::filesystem::last_write_time(kept());
  ASSERT_EQ(reference("second.csv").status, 0);
  EXPECT_EQ(std::filesystem::last_write_time(kept()), made) << "computed twice";
  EXPECT_EQ(read("first.csv"), read("second.csv"));
  EXPECT_EQ(read("first.run.json"), read("second.run.json"));

  const std::string good = test::read(kept());
  std::string damaged = good;
  damaged[damaged.size() - 20] ^= 1;
  for (const std::string& text : {damaged, good.substr(0, good.size() / 2), std::string()}) {
    std::ofstream(kept()) << text;
    const Result again = reference("third.csv");
    EXPECT_EQ(again.status, 0);
    EXPECT_NE(again.err.find("damaged"), std::string::npos) << again.err;
    EXPECT_EQ(read("third.csv"), read("first.csv"));
    EXPECT_EQ(test::read(kept()), good);
  }

  const auto name = kept();
  std::filesystem::remove(name);
  std::filesystem::create_directory(name);
  const Result unkept = reference("third.csv");
  EXPECT_EQ(unkept.status, 0);
  EXPECT_NE(unkept.err.find("damaged"), std::string::npos) << unkept.err;
  EXPECT_NE(unkept.err.find("not kept for the next time"), std::string::npos) << unkept.err;
  EXPECT_EQ(read("third.csv"), read("first.csv"));

  std::string heavier = kPendulum;
  heavier.replace(heavier.find("\"mass\": 3"), 9, "\"mass\": 4");
  write("pendulum.json", heavier);
  ASSERT_EQ(reference("heavier.csv").status, 0);
  EXPECT_NE(read("heavier.csv"), read("first.csv"));
}

TEST_F(ReferenceCommand, TakesRoundingForNoMotion) {
  write("at_origin.json", R"({"scene": 1, "name": "rotor about its centre, at the origin", "bodies": [
    {"name": "rotor", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, 0],
     "orientation": {"axis": [0.6, 0.64, 0.48], "angle": 1}}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rotor"], "point": [0.1, 0.2, -0.3], "axis": [0.1, 0.2, -0.3]}],
    "forces": [{"type": "torque", "body": "rotor", "torque": ["0.1", "0", "0.5"], "frame": "global"}]})");
  write("at_rest.json", R"({"scene": 1, "name": "mass on a spring, at rest", "gravity": [0, 0, -9.81], "bodies": [
    {"name": "bob", "mass": 1.3, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, "-1 - 1.3*9.81/70"]}],
    "forces": [{"type": "spring", "bodies": ["ground", "bob"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "stiffness": 70,
                "damping": 0.5, "length": 1}]})");
  write("drifting.json", R"({"scene": 1, "name": "without any force", "bodies": [
    {"name": "ball", "mass": 1.3, "inertia": [0.1, 0.1, 0.1], "position": [0.1, 0.2, 0.3], "velocity": [1, 0.3, 0.7],
     "angular_velocity": [2, 0.1, 7]}]})");
  for (const std::string scene : {"at_origin", "at_rest", "drifting"}) {
    const Result result = poinsot(
        {"reference", scene + ".json", "--end", "1", "--cache", "cache", "--quiet", "--out", scene + "_motion.csv"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto record = read_json(scene + "_motion.run.json");
    for (const char* quantity : {"position", "velocity", "acceleration", "multiplier"})
      EXPECT_LT(record["agreement"][quantity].get<double>(), 1e-9) << scene << ": " << quantity;
  }
}

// A force that jumps from 0 to 2e4 N at 0.1 s lets no method pass at the tolerances asked for.
TEST_F(ReferenceCommand, WhereTheTolerancesAskForTooMuchGoesBackToSuchAsPass) {
  write("jump.json",
        R"~({"scene": 1, "name": "jump",
    "bodies": [{"name": "sledge", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
    "forces": [{"type": "force", "body": "sledge", "point": [0, 0, 0],
                "force": ["1e4*(1 + abs(t - 0.1)/(t - 0.1))", "0", "0"]}]})~");
  const Result result =
      poinsot({"reference", "jump.json", "--end", "0.3", "--every", "0.3", "--cache", "cache", "--out", "motion.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(std::stod(fields(lines(read("motion.csv")).back())[1]), 1e4 * 0.2 * 0.2, 1e-8);
  const auto record = read_json("motion.run.json");
  for (const auto& method : record["methods"]) {
    EXPECT_EQ(method["failure"], "") << method;
    const double loose = method["rtol"][0], tight = method["rtol"][1];
    EXPECT_NEAR(loose / tight, 100, 1e-9) << method;
  }
}

TEST_F(ReferenceCommand, SaysWhyThereIsNone) {
  write("overstretched.json", kOverstretched);
  const Result none =
      poinsot({"reference", "overstretched.json", "--end", "2", "--cache", "cache", "--out", "motion.csv"});
  EXPECT_EQ(none.status, 3);
  EXPECT_TRUE(none.err.starts_with("poinsot: no reference could be computed; ")) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "motion.csv"));
  write("conflicting.json", kConflicting);
  const Result wrong = poinsot({"reference", "conflicting.json", "--cache", "cache", "--out", "motion.csv"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(wrong.err.starts_with("poinsot: conflicting.json: the constraints conflict: ")) << wrong.err;
  EXPECT_EQ(wrong.err.find("dop853"), std::string::npos) << wrong.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"cache", "conflicting.json", "overstretched.json", "pendulum.json"}));
  const Result many = poinsot({"reference", "pendulum.json", "--digits", "30"});
  EXPECT_EQ(many.status, 2);
  EXPECT_EQ(many.err, "poinsot: --digits: found 30, expected a whole number from 4 to 12\n");
  const Result same = poinsot({"reference", "pendulum.json", "--out", "pendulum.json"});
  EXPECT_EQ(same.status, 2);
  EXPECT_EQ(read("pendulum.json"), kPendulum);
}

}  // namespace
}  // namespace poinsot::test
