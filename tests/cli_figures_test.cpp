// `poinsot figures`: the files it writes, and that what it says was fitted follows from the points in the CSV.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "command_line.h"

namespace poinsot::test {
namespace {

using Figures = CommandLine;

// The names below "Figures:" in the help text.
std::set<std::string> listed(const std::string& help) {
  std::set<std::string> names;
  bool below = false;
  for (const std::string& line : lines(help)) {
    if (below && line.starts_with("  ")) names.insert(line.substr(2, line.find(' ', 2) - 2));
    below = below || line == "Figures:";
  }
  return names;
}

TEST_F(Figures, HelpListsThem) {
  const Result result = poinsot({"figures", "--help"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(listed(result.out), (std::set<std::string>{"order_paper", "order_integrators", "order_controlled",
                                                       "solution_deltas", "iterations", "energy"}));
}

TEST_F(Figures, OrdersFollowFromThePoints) {
  const Result result = poinsot({"figures", "order_paper", "--quick", "--out", "results"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::set<std::string> found;
  for (const auto& file : std::filesystem::directory_iterator(folder() / "results"))
    found.insert(file.path().filename());
  EXPECT_EQ(found, (std::set<std::string>{"figures.md", "order_paper.md", "order_paper.csv", "order_paper.svg",
                                          "order_paper.png", "order_paper_table.csv"}));
  EXPECT_TRUE(read("results/order_paper.png").starts_with("\x89PNG"));
  EXPECT_NE(read("results/order_paper.svg").find("four link, z of link 3: velocity"), std::string::npos);

  // panel and formulation -> points of the fit, in logarithms
  std::map<std::pair<std::string, std::string>, std::vector<std::pair<double, double>>> points;
  for (const std::string& line : lines(read("results/order_paper.csv"))) {
    if (line.starts_with('#') || line.starts_with("panel,")) continue;
    const std::size_t quote = line.rfind('"');  // panels hold commas
    ASSERT_TRUE(line.starts_with('"') && quote != std::string::npos) << line;
    const auto f = fields(line.substr(quote + 2));  // series, variant, x, y, low, high, in_fit
    ASSERT_EQ(f.size(), 7u) << line;
    if (f[6] == "1")
      points[{line.substr(1, quote - 1), f[0]}].emplace_back(std::log(std::stod(f[2])), std::log(std::stod(f[3])));
  }
  EXPECT_EQ(points.size(), 3u * 2 * 3);
  int rows = 0;
  for (const std::string& line : lines(read("results/order_paper_table.csv"))) {
    if (line.starts_with('#') || line.starts_with("coordinate,")) continue;
    const std::size_t quote = line.rfind('"');
    const auto f = fields(line.substr(quote + 2));  // formulation, quantity, exponent, least, largest, ...
    const std::string unit = f[1] == "velocity" ? "m/s" : "m/s²";
    const auto& p = points.at({fmt::format("{}: {}, {}", line.substr(1, quote - 1), f[1], unit), f[0]});
    ASSERT_GE(p.size(), 5u);
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const auto n = static_cast<double>(p.size());
    for (const auto& [x, y] : p) sx += x, sy += y, sxx += x * x, sxy += x * y;
    EXPECT_NEAR(std::stod(f[2]), (n * sxy - sx * sy) / (n * sxx - sx * sx), 6e-4) << line;
    EXPECT_NEAR(std::stod(f[2]), 1, 0.1) << line;
    EXPECT_NEAR(std::stod(f[3]), 1, 0.1) << line;
    EXPECT_NEAR(std::stod(f[4]), 1, 0.1) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 3 * 2 * 3);
  EXPECT_TRUE(result.out.starts_with("order_paper\n  implicit_euler (order 1): exponents ")) << result.out;
}

TEST_F(Figures, TheIndexHoldsThoseThatWereThereBefore) {
  expect_drawn(poinsot({"figures", "solution_deltas", "--quick", "--out", "results"}));
  const std::string before = read("results/solution_deltas.md");
  EXPECT_TRUE(before.starts_with("# solution_deltas: ")) << before;
  EXPECT_NE(before.find("- settings: --quick"), std::string::npos) << before;
  const Result result = poinsot({"figures", "order_paper", "--quick", "--out", "results"});
  expect_drawn(result);
  EXPECT_TRUE(result.out.ends_with("\nresults/figures.md\n")) << result.out;
  const std::string index = read("results/figures.md");
  const std::size_t first = index.find("\n- [order_paper](order_paper.md): the paper's order analysis"),
                    second = index.find("\n- [solution_deltas](solution_deltas.md): the paper's double pendulum");
  EXPECT_LT(first, second) << index;
  EXPECT_NE(second, std::string::npos) << index;
  EXPECT_EQ(index.find("energy"), std::string::npos) << "it is not there";
  EXPECT_EQ(read("results/solution_deltas.md"), before);
}

TEST_F(Figures, OrdersOfErrorControlledMethods) {
  const Result result = poinsot({"figures", "order_controlled", "--out", "results"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::set<std::string> methods;
  int rows = 0;
  for (const std::string& line : lines(read("results/order_controlled_table.csv"))) {
    if (line.starts_with('#') || line.starts_with("mechanism,")) continue;
    const std::size_t quote = line.rfind('"');  // mechanisms may hold commas
    const auto f = fields(quote == std::string::npos ? line.substr(line.find(',') + 1) : line.substr(quote + 2));
    ASSERT_EQ(f.size(), 10u) << line;  // integrator, formulation, order, four exponents, neighbours, from, to
    methods.insert(f[0]);
    const double order = std::stod(f[2]);
    for (std::size_t k = 3; k < 7; ++k) EXPECT_NEAR(std::stod(f[k]), order, 0.1) << line;
    EXPECT_NEAR(std::stod(f[7]), order, 0.1) << line;
    EXPECT_NEAR(std::stod(f[7].substr(f[7].find(" to ") + 4)), order, 0.1) << line;
    ++rows;
  }
  EXPECT_EQ(methods, (std::set<std::string>{"dopri5", "dop853", "radau5"}));
  EXPECT_EQ(rows, 15);
}

// Of all commands that draw, told also with --quiet.
TEST_F(Figures, WithoutMatplotlibTheNumbersAreThere) {
  write("pendulum.json", kPendulum);
  write("study.json", R"({"study": 1, "scenes": ["pendulum.json"], "settings": {"end": 0.1},
    "vary": [{"setting": "formulation", "values": ["rA", "rp"]}], "keep": ["counts"],
    "pictures": [{"file": "steps", "title": "steps", "histogram": "steps"}]})");
  write("matplotlib.py", "raise ImportError\n");
  setenv("PYTHONPATH", folder().c_str(), 1);
  const std::string sentence =
      "no picture was drawn: that needs Python 3 with matplotlib (Debian: python3-matplotlib); the CSV is there";
  const std::pair<std::vector<std::string>, const char*> commands[] = {
      {{"figures", "solution_deltas"}, "solution_deltas.csv"},
      {{"chart", "pendulum.json", "--end", "0.1", "--cache", "cache", "--formulations", "rA", "--integrators",
        "dop853"},
       "pendulum.csv"},
      {{"stability", "--family", "pulse", "--formulations", "rA", "--integrators", "dop853"}, "pulse.csv"},
      {{"study", "study.json"}, "cases.csv"}};
  for (auto [command, csv] : commands) {
    SCOPED_TRACE(command[0]);
    command.insert(command.end(), {"--quick", "--quiet", "--out", "results"});
    const Result result = poinsot(command);
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(result.err, "poinsot: " + sentence + "\n");
    EXPECT_FALSE(read(std::string("results/") + csv).empty());
  }
  unsetenv("PYTHONPATH");
  EXPECT_NE(read("results/solution_deltas.md").find(sentence), std::string::npos);
}

TEST_F(Figures, AFamilyOfTheSuiteIsMapped) {
  const Result result = poinsot({"stability", "--family", "pulse", "--quick", "--formulations", "rA", "--integrators",
                                 "dop853", "--out", "results"});
  expect_drawn(result);
  EXPECT_NE(result.out.find("cells: "), std::string::npos) << result.out;
  const std::vector<std::string> names = fields(lines(read("results/stability_verdicts.csv"))[0]),
                                 counts = fields(lines(read("results/stability_verdicts.csv"))[1]);
  ASSERT_EQ(names.back(), "cells");
  EXPECT_EQ(counts[0], "pulse");
  int cells = 0;
  for (const std::string& line : lines(read("results/pulse.csv"))) cells += !line.starts_with("#");
  EXPECT_EQ(cells - 1, std::stoi(counts.back()));
  EXPECT_EQ(
      poinsot({"stability", "--family", "tides"}).err.find("poinsot: --family: found \"tides\", expected one of "), 0u);
}

TEST_F(Figures, TablesOfTheSuiteHoldFamiliesThatWereThereBefore) {
  const auto map = [&](const char* family) {
    expect_drawn(poinsot({"stability", "--family", family, "--quick", "--formulations", "rA", "--integrators",
                          "rattle,dop853", "--quiet", "--out", "results"}));
  };
  const std::vector<std::string> tables{"stability_verdicts", "stability_use", "stability_doubtful"};
  map("pulse");
  std::map<std::string, std::vector<std::string>> before;
  for (const std::string& table : tables) before[table] = lines(read("results/" + table + ".csv"));
  EXPECT_GT(before["stability_doubtful"].size(), 6u) << "rattle goes over pulses";
  map("far_away");
  write("results/stiffness.csv", "t,x\n0,1\n");  // somebody's own of this name
  map("far_away");
  for (const std::string& table : tables) {
    const std::vector<std::string> now = lines(read("results/" + table + ".csv"));
    for (const std::string& line : before[table]) {
      if (line.starts_with("all,") || line.starts_with("# ")) continue;
      EXPECT_EQ(std::ranges::count(now, line), 1) << table << ": " << line;
    }
  }
  const std::vector<std::string> verdicts = lines(read("results/stability_verdicts.csv"));
  ASSERT_GT(verdicts.size(), 4u);
  int sum = 0;
  for (std::size_t k = 1; k < 3; ++k) sum += std::stoi(fields(verdicts[k]).back());
  EXPECT_EQ(fields(verdicts[3])[0], "all");
  EXPECT_EQ(std::stoi(fields(verdicts[3]).back()), sum);
  const std::string page = read("results/stability.md");
  EXPECT_EQ(page.find("](pulse.svg)") != std::string::npos, pictures_are_drawn()) << page;
  EXPECT_NE(page.find("- pulse: computed before, as pulse.csv says\n"), std::string::npos) << page;

  // Torn ones are no reason to compute nothing.
  const std::string whole = read("results/pulse.csv");
  const std::pair<std::string, std::string> damaged[] = {
      {whole.substr(0, whole.rfind("\nrA,") + 6), "fields, expected 10"},
      {"", "found no header, expected a table"},
      {whole.substr(0, whole.find('\n')) + "\nrA,rattle,1,1,sound,ok,0,0,1,\n", "found \"sound\", expected a verdict"}};
  for (const auto& [text, why] : damaged) {
    write("results/pulse.csv", text);
    const Result result = poinsot({"stability", "--family", "far_away", "--quick", "--formulations", "rA",
                                   "--integrators", "rattle,dop853", "--out", "results"});
    EXPECT_EQ(result.err.find("poinsot: note: left out of stability.md: results/pulse.csv: "), 0u) << result.err;
    EXPECT_NE(result.err.find(why + "; delete the file, or have it written anew\n"), std::string::npos) << result.err;
    EXPECT_EQ(read("results/stability.md").find("pulse"), std::string::npos);
  }
  map("pulse");
  EXPECT_EQ(read("results/pulse.csv"), whole);
}

TEST_F(Figures, SaysWhatItDoesNotKnow) {
  const Result result = poinsot({"figures", "order_paper", "portrait", "--out", "results"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err,
            "poinsot: NAME: found \"portrait\", expected one of order_paper, order_integrators, order_controlled, "
            "solution_deltas, "
            "iterations, energy\n");
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace poinsot::test
