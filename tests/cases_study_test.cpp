// The study file's reader, by the table that also holds the JSON schema to it, and how cases are numbered and keyed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/cases/case_table.h"
#include "bench/cases/computation.h"
#include "bench/cases/study_file.h"
#include "core/input_error.h"

namespace poinsot::cases {
namespace {
using Json = nlohmann::json;

const char* const kPendulum = R"({"scene": 1, "name": "pendulum", "parameters": {"l": 1}, "gravity": [0, 0, -9.81],
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, "l", 0]}],
  "joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})";

Study study_of(const Json& document) {
  return parse_content(
      Json{{"file", "study.json"}, {"study", document.dump()}, {"scenes", {{"pendulum.json", kPendulum}}}}.dump());
}

Json case_table() {
  std::ifstream in(POINSOT_SOURCE_DIR "/tests/study_schema_test.json");
  return Json::parse(in);
}

TEST(CasesStudy, AnswersEveryCaseOfTheTable) {
  const Json cases = case_table();
  for (const Json& c : cases["cases"]) {
    Json document = cases["base"];
    if (c.contains("set"))
      for (const auto& [pointer, value] : c["set"].items()) document[Json::json_pointer(pointer)] = value;
    if (c.contains("remove")) {
      for (const Json& pointer : c["remove"]) {
        const Json::json_pointer place(pointer.get<std::string>());
        document[place.parent_pointer()].erase(place.back());
      }
    }
    if (c.value("what", "") == "a scene that is not there") continue;  // that is for files
    std::string error;
    try {
      (void)study_of(document);
    } catch (const InputError& refused) {
      error = refused.what();
    }
    const std::string expected = c.value("error", "");
    EXPECT_TRUE(expected.empty() ? error.empty() : error.starts_with(expected)) << c["what"] << ": " << error;
  }
}

TEST(CasesStudy, TheLastDimensionVariesFastestAndKeysAreOfWhatIsComputed) {
  Json document = case_table()["base"];
  Study study = study_of(document);
  ASSERT_EQ(study.size(), 4);
  EXPECT_EQ(case_of(study, 0).parameters, std::vector{1.0});
  EXPECT_EQ(case_of(study, 1).settings, 1u);
  EXPECT_EQ(case_of(study, 2).parameters, std::vector{1.5});
  EXPECT_EQ(header(study),
            "case,scene,bodies,l,formulation,status,rod.y.final,rod.y.range,rod.y@0.005,violation_position,"
            "violation_velocity,message");
  std::set<std::uint64_t> keys;
  for (std::int64_t k = 0; k < 4; ++k) keys.insert(key_of(study, case_of(study, k)));
  EXPECT_EQ(keys.size(), 4u);
  // The same cases under other numbers; other cases where anything changes.
  document["vary"][0]["values"] = {0.5, 1, 1.5};
  study = study_of(document);
  for (std::int64_t k = 2; k < 6; ++k) EXPECT_TRUE(keys.contains(key_of(study, case_of(study, k)))) << k;
  Json kept = document;
  kept["keep"].push_back("counts");
  study = study_of(kept);
  for (std::int64_t k = 0; k < 6; ++k) EXPECT_FALSE(keys.contains(key_of(study, case_of(study, k)))) << k;
  document["settings"]["step"] = 0.0005;
  study = study_of(document);
  for (std::int64_t k = 0; k < 6; ++k) EXPECT_FALSE(keys.contains(key_of(study, case_of(study, k)))) << k;
}

TEST(CasesStudy, ShardsAndATenthAreDisjointAndComplete) {
  Json document = case_table()["base"];
  document.erase("pictures");
  document["vary"][0] = {{"parameter", "l"}, {"from", 1}, {"to", 2}, {"count", 37}};
  const Study study = study_of(document);
  std::set<std::int64_t> all;
  for (int place = 1; place <= 5; ++place) {
    const Selection shard(study, false, place, 5);
    for (std::int64_t k = 0; k < shard.size(); ++k) EXPECT_TRUE(all.insert(shard.at(k)).second);
  }
  EXPECT_EQ(all.size(), 74u);
  const Selection quick(study, true);
  ASSERT_EQ(quick.size(), 8);  // four of 37 lengths, in both formulations
  for (std::int64_t k = 0; k < quick.size(); ++k) EXPECT_EQ(quick.at(k), k / 2 * 22 + k % 2);
}

// A row is one byte for byte, of the case that it says; everything else is computed again.
TEST(CasesStudy, ADamagedRowIsNone) {
  const Study study = study_of(case_table()["base"]);
  std::string folder = (std::filesystem::temp_directory_path() / "poinsot-rows-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::filesystem::path part = std::filesystem::path(folder) / "cases.part";
  CaseTable(study).open(part);
  const std::string whole = "pendulum,1,1,rA,ok,1,2,3,4,5,";
  std::string damaged = make_row(study, case_of(study, 1), whole, false).line;
  damaged[damaged.size() - 3] ^= 1;  // a digit
  Json document = case_table()["base"];
  document["vary"].erase(1);  // a column less
  document.erase("pictures");
  const Study other = study_of(document);
  std::ofstream(part, std::ios::app) << make_row(study, case_of(study, 0), whole, false).line << damaged
                                     << make_row(other, case_of(other, 0), "pendulum,1,1,ok,1,2,3,4,5,", false).line
                                     << make_row(study, case_of(study, 2), "pendulum,1,1", false).line << "no row\n";
  CaseTable rows(study);
  EXPECT_EQ(rows.read(part, false), 1);
  EXPECT_TRUE(rows.has(0));
  EXPECT_FALSE(rows.has(1));
  EXPECT_FALSE(rows.has(2)) << "its checksum is right, but fields are missing";
  EXPECT_EQ(rows.damaged(), 3);
  EXPECT_EQ(rows.unused(), 1);
  std::filesystem::remove_all(folder);
}

// As a program does it, without a command line; what is there already is not computed again.
TEST(CasesStudy, AFewLinesComputeOne) {
  const auto folder = std::filesystem::temp_directory_path() / "poinsot_cases_study_test";
  std::filesystem::remove_all(folder);
  Json document = case_table()["base"];
  document.erase("pictures");
  for (const bool again : {false, true}) {
    ComputationOptions options;
    options.folder = folder;
    options.threads = 1;
    Computation computation(study_of(document), options);
    EXPECT_EQ(computation.there(), again ? 4 : 0);
    computation.compute();
    ASSERT_TRUE(computation.complete());
    std::vector<std::filesystem::path> written;
    EXPECT_EQ(computation.conclude(written), "");
    EXPECT_EQ(computation.failures(), 0);
    ASSERT_EQ(written, std::vector{folder / "cases.csv"});
    std::ifstream in(written.front());
    std::string line;
    int rows = 0;
    while (std::getline(in, line)) rows += !line.starts_with("#");
    EXPECT_EQ(rows, 1 + 4);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace poinsot::cases
