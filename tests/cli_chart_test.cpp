// `poinsot chart`: the rows it writes, the front, going on after an interruption; not how fast anything is.
#include <map>

#include "command_line.h"

namespace poinsot::test {
namespace {

using Row = std::map<std::string, std::string>;

class Chart : public CommandLine {
 protected:
  Chart() { write("pendulum.json", kPendulum); }

  Result chart(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"chart", "pendulum.json", "--quick", "--end", "0.5", "--cache", "cache", "--out", "out",
                               "--formulations", "rA,rp", "--integrators", "implicit_euler,dop853"});
    return poinsot(more);
  }

  std::vector<Row> rows(const std::string& file = "out/pendulum.csv") const {
    std::vector<Row> result;
    std::vector<std::string> names;
    for (const std::string& line : lines(read(file))) {
      if (line.starts_with("#")) continue;
      const auto f = fields(line);
      if (names.empty()) {
        names = f;
        continue;
      }
      Row& row = result.emplace_back();
      for (std::size_t k = 0; k < f.size(); ++k) row[names[k]] = f[k];
    }
    return result;
  }
};

TEST_F(Chart, MeasuresEveryCaseAndFindsTheFront) {
  const Result result = chart();
  expect_drawn(result);
  for (const char* picture : {"out/pendulum.svg", "out/pendulum.png"})
    EXPECT_EQ(std::filesystem::exists(folder() / picture), pictures_are_drawn());

  const std::vector<Row> all = rows();
  ASSERT_EQ(all.size(), 1u + 2 * 5 + 2 * 5);
  EXPECT_EQ(all[0].at("status"), "reference");
  EXPECT_NE(read("out/pendulum.csv").find("# conclusion, position: 1e-2"), std::string::npos);
  EXPECT_NE(read("out/pendulum.csv").find("; --quick, the reduced set\n"), std::string::npos);
  for (const char* quantity : {"position", "velocity", "acceleration", "multiplier"}) {
    const double floor = 10 * std::stod(all[0].at(quantity));
    EXPECT_LT(floor, 1e-10) << quantity;
    const auto error = [&](const Row& row) { return std::max(floor, std::stod(row.at(quantity))); };
    const auto seconds = [](const Row& row) { return std::stod(row.at("seconds")); };
    double coarse = 0, fine = 1;
    for (const Row& row : all) {
      if (row.at("status") != "ok") continue;
      bool beaten = error(row) > 0.01;
      for (const Row& other : all)
        if (other.at("status") == "ok" && error(other) <= error(row) && seconds(other) <= seconds(row))
          beaten = beaten || error(other) < error(row) || seconds(other) < seconds(row);
      EXPECT_FALSE(beaten && row.at(std::string("front_") + quantity) == "1") << row.at("integrator");
      (row.at("integrator") == "dop853" ? fine : coarse) = error(row);
    }
    EXPECT_LT(fine, coarse / 100);
  }
}

// Also where errors are so large that the panel is cut on the left.
TEST_F(Chart, ThePictureShowsWhatTheReferenceResolves) {
  const Result result = poinsot({"chart", "pendulum.json", "--quick", "--end", "20", "--cache", "cache", "--out", "out",
                                 "--formulations", "rA", "--integrators", "implicit_euler,rattle"});
  expect_drawn(result);
  if (!pictures_are_drawn()) GTEST_SKIP() << result.err;
  const std::string svg = read("out/pendulum.svg");
  const std::size_t line = svg.find("<g id=\"resolved_position\">");
  ASSERT_NE(line, std::string::npos);
  const double x = std::stod(svg.substr(svg.find("d=\"M ", line) + 5));
  EXPECT_GT(x, 0);
  EXPECT_LT(x, 396);  // the first of three panels beside one another on 1188 points
}

TEST_F(Chart, KinematicsTakesPartWhereDriversPrescribeAll) {
  write("driven.json", std::string(kPendulum).insert(std::string(kPendulum).rfind('}'), R"(,
    "drivers": [{"type": "angle", "bodies": ["ground", "rod"], "axis": [1, 0, 0], "angle": "t^2"}])"));
  expect_drawn(poinsot(
      {"chart", "driven.json", "--quick", "--end", "0.2", "--cache", "cache", "--out", "out", "--formulations", "rA"}));
  int kinematics = 0;
  for (const Row& row : rows("out/driven.csv")) kinematics += row.at("integrator") == "kinematics";
  EXPECT_GT(kinematics, 0);
}

TEST_F(Chart, TakesAnyNameOfAScene) {
  std::string scene = kPendulum;
  scene.replace(scene.find("\"name\": \"pendulum\""), 18, R"("name": "at $5,\n \"only\" $\\frac{ $")");
  write("pendulum.json", scene);
  expect_drawn(chart());
  EXPECT_EQ(rows().size(), 1u + 2 * 5 + 2 * 5);
  expect_drawn(chart());  // goes on
}

TEST_F(Chart, GoesOnWhereItStopped) {
  expect_drawn(chart());
  const std::vector<Row> whole = rows();
  const std::string text = read("out/pendulum.csv");
  const std::size_t cut = text.rfind("dop853");  // within the last row
  write("out/pendulum.csv", text.substr(0, cut));
  expect_drawn(chart());
  const std::vector<Row> again = rows();
  ASSERT_EQ(again.size(), whole.size());
  for (std::size_t k = 0; k + 1 < whole.size(); ++k) EXPECT_EQ(again[k].at("seconds"), whole[k].at("seconds")) << k;

  const Result otherwise = chart({"--linear-solvers", "klu"});
  EXPECT_EQ(otherwise.status, 2);
  EXPECT_NE(otherwise.err.find("out/pendulum.csv: measured otherwise, there it says \"settings: "), std::string::npos);
  EXPECT_NE(otherwise.err.find("--fresh begins it anew"), std::string::npos);
  expect_drawn(chart({"--linear-solvers", "klu", "--fresh"}));
}

TEST_F(Chart, CountsTheFrontsOfSeveralScenes) {
  write("second.json", kPendulum);
  const Result result = chart({"second.json"});
  expect_drawn(result);
  EXPECT_NE(result.out.find("on the front of so many of 2 charts:\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("out/fronts.md\n"), std::string::npos) << result.out;
  EXPECT_NE(read("out/fronts.md").find("On how many of 2 charts"), std::string::npos);
  int found = 0;
  for (const char* table : {"out/fronts_integrators.csv", "out/fronts_methods.csv"}) {
    for (const Row& row : rows(table)) {
      int any = 0;
      std::map<std::string, int> expected;
      for (const char* file : {"out/pendulum.csv", "out/second.csv"}) {
        std::map<std::string, bool> on;
        for (const Row& one : rows(file)) {
          if (one.at("integrator") != row.at("integrator") || one.at("status") != "ok") continue;
          if (row.count("formulation") && one.at("formulation") != row.at("formulation")) continue;
          for (const char* quantity : {"position", "velocity", "acceleration", "multiplier"})
            if (one.at(std::string("front_") + quantity) == "1") on[quantity] = true;
        }
        for (const auto& [quantity, is] : on) expected[quantity] += is;
        any += !on.empty();
      }
      for (const char* quantity : {"position", "velocity", "acceleration", "multiplier"})
        EXPECT_EQ(row.at(quantity), std::to_string(expected[quantity])) << table << quantity;
      EXPECT_EQ(row.at("any"), std::to_string(any));
      found += any;
    }
  }
  EXPECT_EQ(rows("out/fronts_integrators.csv").size(), 2u);
  EXPECT_EQ(rows("out/fronts_methods.csv").size(), 4u);
  EXPECT_GT(found, 0);
}

TEST_F(Chart, FrontsAreThoseOfAllChartsThatLieInTheFolder) {
  expect_drawn(chart());
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/fronts.md"));
  write("second.json", kPendulum);
  const std::vector<std::string> second{"chart",   "second.json",   "--quick", "--end", "0.5",
                                        "--cache", "cache",         "--out",   "out",   "--formulations",
                                        "rA",      "--integrators", "rattle"};
  expect_drawn(poinsot(second));
  const auto page = [&] { return read("out/fronts.md"); };
  EXPECT_NE(page().find("On how many of 2 charts"), std::string::npos) << page();
  EXPECT_NE(page().find("- pendulum: measured before, as pendulum.csv says\n"), std::string::npos) << page();
  std::vector<std::string> integrators, expected{"rattle", "implicit_euler", "dop853"};  // what was asked for first
  for (const Row& row : rows("out/fronts_integrators.csv")) {
    integrators.push_back(row.at("integrator"));
    const auto scenes = row.find("scenes");  // of whose fronts it is on
    if (scenes != row.end()) {
      EXPECT_EQ(scenes->second.find("second") != std::string::npos, integrators.back() == "rattle");
    }
  }
  EXPECT_EQ(integrators, expected);

  const std::string whole = read("out/pendulum.csv");
  write("out/pendulum.csv", whole.substr(0, whole.find("implicit_euler", whole.size() / 2)) + "\n");
  const Result torn = poinsot(second);
  EXPECT_NE(torn.err.find("poinsot: note: left out of fronts.md: out/pendulum.csv: line "), std::string::npos)
      << torn.err;
  EXPECT_NE(torn.err.find("expected 22; delete the file, or have it written anew\n"), std::string::npos) << torn.err;
  EXPECT_NE(page().find("On how many of 1 charts"), std::string::npos) << page();
  write("out/pendulum.csv", "# incomplete: interrupted\n" + whole);
  EXPECT_NE(poinsot(second).err.find("left out of fronts.md: out/pendulum.csv: incomplete: interrupted"),
            std::string::npos);
}

// After so long a time implicit Euler is too far off at every step for any front, however quick it is.
TEST_F(Chart, CountsOnlyWhatItMeasured) {
  const Result result = poinsot({"chart", "pendulum.json", "--quick", "--end", "20", "--cache", "cache", "--out", "out",
                                 "--formulations", "rA", "--integrators", "ida,implicit_euler,dop853"});
  expect_drawn(result);
  EXPECT_EQ(result.out.find("ida"), std::string::npos) << result.out;  // refuses rA
  EXPECT_NE(result.out.find("on no front: implicit_euler\n"), std::string::npos) << result.out;
}

TEST_F(Chart, SaysWhatIsWrong) {
  const auto says = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, "poinsot: " + message + "\n");
  };
  says({"chart"}, "found no scene, expected poinsot chart SCENE, or --all");
  says({"chart", "pendulum.json", "--formulations", "rA,magic"},
       "--formulations: found \"magic\", expected one or more of rA, rp, reps, with commas between");
  const auto before = files();
  says({"chart", "pendulum.json", "--formulations", "rp,rA,rp"},
       "--formulations: found \"rp\" twice, expected each name once");
  says({"chart", "pendulum.json", "--formulations", "rA,reps", "--integrators", "ida"},
       "--integrators, --formulations: integrator 'ida' refuses formulation 'rA': it needs a vector space of "
       "coordinates with their rates as velocities, which is rp");
  says({"chart", "pendulum.json", "--out", ""}, "--out: found \"\", expected a folder; see poinsot chart --help");
  says({"chart", "pendulum.json", "--formulations", "rA,"},
       "--formulations: a name is missing in \"rA,\", expected names with a comma between");
  says({"chart", "pendulum.json", "--end", "0"}, "--end: found \"0\", expected a number greater than 0");
  EXPECT_EQ(files(), before);
  write("conflicting.json", kConflicting);
  const Result wrong = poinsot({"chart", "pendulum.json", "conflicting.json", "--out", "out", "--cache", "cache"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(wrong.err.starts_with("poinsot: conflicting.json: the constraints conflict: ")) << wrong.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
  write("other.csv", "1,2\n");
  std::filesystem::create_directories(folder() / "taken" / "pendulum.csv");
  says({"chart", "pendulum.json", "--quick", "--end", "0.1", "--cache", "cache", "--out", "taken"},
       "taken/pendulum.csv: cannot be written: it is a directory; give a file name");
  says({"chart", "pendulum.json", "./pendulum.json"}, "pendulum.json: two tables would be written as pendulum.csv");
}

TEST_F(Chart, AFailureIsARowAndASceneWithoutReferenceASentence) {
  write("overstretched.json", kOverstretched);
  const Result result = poinsot({"chart", "overstretched.json", "pendulum.json", "--quick", "--end", "1.5", "--cache",
                                 "cache", "--out", "out", "--integrators", "dop853"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("overstretched.json: no chart: no reference could be computed"), std::string::npos);
  EXPECT_FALSE(rows().empty());

  const Result none = poinsot({"chart", "overstretched.json", "--quick", "--end", "1.5", "--cache", "cache", "--out",
                               "none", "--integrators", "dop853"});
  EXPECT_EQ(none.status, 3);
  EXPECT_EQ(lines(none.err).size(), 1u) << none.err;  // no word of pictures
}

}  // namespace
}  // namespace poinsot::test
