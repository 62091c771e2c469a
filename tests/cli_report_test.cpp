// `poinsot report` and `poinsot compare`: what they write, say and refuse.
#include <gmock/gmock.h>

#include "command_line.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

class Report : public CommandLine {
 protected:
  Report() {
    std::filesystem::create_directories(folder() / "r");
    write("r/constraint_counts.csv", "mechanism,CD\nSingle pendulum,3\n# processor: P\n# settings: none\n");
  }
};

TEST_F(Report, WritesThePageAndWhatItsSentencesAreMadeOf) {
  const Result result = poinsot({"report", "r"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "r/report.html\n");
  const std::string page = read("r/report.html");
  EXPECT_THAT(page, HasSubstr("<td>3\n"));
  EXPECT_THAT(page, HasSubstr("poinsot chart --all --quick --out r"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "r/report_contents.csv"));
  ASSERT_EQ(poinsot({"report", "r", "--out", "page.html"}).status, 0);
  EXPECT_EQ(read("page.html"), page) << "its own tables are no results";
}

TEST_F(Report, RefusesWhatIsNoFolderOfResults) {
  std::filesystem::create_directories(folder() / "none");
  write("r/bad.csv", "a,b\n1\n");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& said) {
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, "poinsot: " + said + "\n");
  };
  refused({"report", "nowhere"}, "nowhere: expected a folder of results");
  refused({"report", "none"}, "none: found no CSV file, expected what `poinsot tables --out none` writes");
  refused({"report", "r"}, "r/bad.csv: line 2: found 1 fields, expected 2; delete the file, or have it written anew");
  refused({"compare", "r", "none"},
          "r/bad.csv: line 2: found 1 fields, expected 2; delete the file, or have it written anew");
  std::filesystem::remove(folder() / "r/bad.csv");
  refused({"report", "r", "--out", "r/constraint_counts.csv"},
          "r/constraint_counts.csv: --out would overwrite a table of the folder; choose another name or folder for the "
          "output");
  EXPECT_FALSE(std::filesystem::exists(folder() / "r/report_contents.csv"));
}

TEST_F(Report, CompareTellsWhatDiffers) {
  std::filesystem::create_directories(folder() / "s");
  write("s/energy_table.csv", "integrator,value\nrattle,2\n# settings: none\n");
  write("r/energy_table.csv", "integrator,value\nrattle,3\n# settings: none\n");
  const Result text = poinsot({"compare", "r", "s"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("energy_table.csv: 1 of 2 fields: numbers by up to 1"));
  EXPECT_THAT(text.out, HasSubstr("only in r\n  constraint_counts.csv\n"));
  const Result json = poinsot({"compare", "r", "s", "--json"});
  const nlohmann::json said = nlohmann::json::parse(json.out);
  EXPECT_EQ(said["same"], false);
  EXPECT_EQ(said["only_a"][0], "constraint_counts.csv");
  EXPECT_EQ(nlohmann::json::parse(poinsot({"compare", "r", "r", "--json"}).out)["same"], true);
}

// In the folder itself and in folders of it; times of studies are times, and what else differs is told by column.
TEST_F(Report, CompareLooksAtStudiesToo) {
  write("study.json", R"({"study": 1, "name": "sweep", "scenes": [{"make": "chain", "bodies": 1}],
    "settings": {"integrator": "implicit_euler", "step": 0.01, "end": 0.05},
    "vary": [{"setting": "formulation", "values": ["rA", "rp", "reps"]}], "repetitions": 2,
    "keep": ["counts", "seconds", {"column": "rod1.z", "name": "z", "take": ["final"]}],
    "pictures": [{"file": "cost", "points": {"x": "case", "y": "seconds"}}]})");
  for (const char* out : {"r/sweep", "s/sweep", "t"})
    ASSERT_EQ(poinsot({"study", "study.json", "--out", out, "--quiet"}).status, 0);
  const auto compared = [&](const std::string& a, const std::string& b) {
    return nlohmann::json::parse(poinsot({"compare", a, b, "--json"}).out);
  };
  for (const nlohmann::json& alike : {compared("r/sweep", "t"), compared("r", "s")}) {
    EXPECT_EQ(alike["times_compared"], 3) << alike;
    EXPECT_EQ(alike["changed"], nlohmann::json::array()) << alike;
  }
  std::string cases = read("s/sweep/cases.csv");
  cases.replace(cases.find(",5,"), 3, ",6,");  // its steps
  cases.erase(cases.find("\n2,") + 1);
  write("s/sweep/cases.csv", cases);
  const nlohmann::json said = compared("r", "s");
  EXPECT_EQ(said["same"], false);
  EXPECT_EQ(said["times_compared"], 2);
  ASSERT_EQ(said["changed"].size(), 1u) << said;
  EXPECT_EQ(said["changed"][0]["file"], "sweep/cases.csv");
  EXPECT_EQ(said["changed"][0]["quantity"], "steps");
  EXPECT_EQ(said["changed"][0]["after"], "differs in 1 of 2 cases, by up to 1");
  EXPECT_EQ(said["only_a"], nlohmann::json({"constraint_counts.csv", "sweep/cases.csv: 1 case"}));
  std::filesystem::remove_all(folder() / "s/sweep");
  write("s/energy_table.csv", "integrator,value\nrattle,2\n");
  EXPECT_EQ(compared("r", "s")["only_a"], nlohmann::json({"constraint_counts.csv", "sweep/cases.csv"}));
}

}  // namespace
}  // namespace poinsot::test
