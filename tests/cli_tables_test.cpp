// `poinsot tables`: the files it writes and what stands in them; not how fast anything is.
#include <fmt/format.h>

#include <map>

#include "command_line.h"
#include "core/provenance.h"
#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "linsolve/registry.h"

namespace poinsot::test {
namespace {

using Tables = CommandLine;

TEST_F(Tables, WritesThePapersTables) {
  std::filesystem::create_directories(folder() / "results/interrupted");  // with what an interruption left
  for (const char* file : {"tables.md", "raw.csv", "kinematics_phases.csv"})
    write(fmt::format("results/interrupted/{}", file), "a part\n");
  const Result result = poinsot({"tables", "--quick", "--repetitions", "1", "--out", "results"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::vector<std::string> expected{"constraint_counts.csv", "linear_solvers.csv", "raw.csv", "tables.md"};
  for (const char* analysis : {"dynamics", "kinematics"})
    for (const char* table : {"advantage", "against_original", "iterations", "phases", "speed_up"})
      expected.push_back(fmt::format("{}_{}.csv", analysis, table));
  std::sort(expected.begin(), expected.end());
  std::vector<std::string> found;
  for (const auto& file : std::filesystem::directory_iterator(folder() / "results"))
    found.push_back(file.path().filename());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);

  // Ours beside the paper's: the same counts.
  const auto counts = lines(read("results/constraint_counts.csv"));
  for (const char* row : {"Single pendulum,3,3,0,0,3,3,0,0", "Double pendulum,6,4,0,0,6,4,0,0",
                          "Four link,12,6,0,0,12,6,0,0", "Slider crank,6,7,4,1,6,7,4,1"})
    EXPECT_NE(std::find(counts.begin(), counts.end(), row), counts.end()) << row;

  // Every figure is there, and every table says what made it.
  const std::size_t modes = jacobians().size(), forms = formulations().size();
  std::size_t refused = 0;  // matrices a linear solver does not take
  for (const std::string& line : lines(read("results/linear_solvers.csv"))) refused += line.ends_with(",refused,,,,,,");
  EXPECT_LE(refused, 4 * forms * modes);
  // Every solver on all mechanisms, and on the whole matrix, too, where it has G of the three driven ones.
  const auto both =
      static_cast<std::size_t>(std::ranges::count_if(linear_solvers(), &LinearSolverEntry::takes_jacobian));
  const std::size_t systems = (4 * linear_solvers().size() + 3 * both) * forms * modes;
  std::map<std::string, std::size_t> rows{
      {"kinematics_speed_up", 3 * forms}, {"kinematics_phases", 3 * forms * modes},
      {"dynamics_iterations", 4 * forms}, {"dynamics_advantage", 4 * (forms - 1) * modes},
      {"linear_solvers", systems},        {"raw", 7 * forms * modes + systems - refused}};
  for (const auto& [table, count] : rows) {
    std::size_t body = 0;
    const std::string text = read("results/" + table + ".csv");
    for (const std::string& line : lines(text)) body += !line.starts_with("#");
    EXPECT_EQ(body, count + 1) << table;
    for (const std::string& part : {std::string("# processor: "), provenance().commit, provenance().compiler,
                                    std::string("h = 0.001 s, 0.3 s simulated, tolerance 1e-10 (kinematics)"),
                                    std::string("; --quick, a tenth of the time")})
      EXPECT_NE(text.find(part), std::string::npos) << table << part;
  }
  const std::string page = read("results/tables.md");
  EXPECT_EQ(page.find("no figure"), std::string::npos);
  EXPECT_NE(page.find("| Four link | rA | "), std::string::npos);
  EXPECT_NE(page.find(" | 2.62 | 2.41 |\n"), std::string::npos);
  EXPECT_NE(page.find("rA against rp: "), std::string::npos);

  // Speed-ups follow from the times of the same file set.
  std::map<std::string, double> us;
  for (const std::string& line : lines(read("results/dynamics_phases.csv"))) {
    const auto f = fields(line);
    if (f.size() > 3 && f[2] == "exact") us[f[0] + f[1]] = std::stod(f[3]);
  }
  for (const std::string& line : lines(read("results/dynamics_speed_up.csv"))) {
    const auto f = fields(line);
    if (f.size() < 3 || !us.contains(f[0] + f[1])) continue;
    const double of_rp = us.at(f[0] + "rp"), own = us.at(f[0] + f[1]), speed_up = of_rp / own;
    // Two digits of the speed-up are printed and three of the times, which a busy machine may set far apart.
    EXPECT_NEAR(std::stod(f[2]), speed_up, 0.0051 + 0.00051 * (1 + speed_up) / own) << line;
  }
}

TEST_F(Tables, WrongInput) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.begin(), {"tables", "--quick"});
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, "poinsot: " + message + "\n");
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  };
  std::string names;
  for (const LinearSolverEntry& entry : linear_solvers())
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  refused({"--linear-solver", "none"}, "--linear-solver: found \"none\", expected one of " + names);
  refused({"--models", "nowhere"},
          "--models: found no single_pendulum.json in nowhere, expected a folder with the paper's mechanisms");
  refused({"--repetitions", "0"}, "--repetitions: found 0, expected a whole number, at least 1");
  write("file", "");
  refused({"--out", "file/results"}, "file/results: the folder cannot be made: file is a file; choose another name");
}

}  // namespace
}  // namespace poinsot::test
