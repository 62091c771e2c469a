#include "bench/report/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "bench/report/compare_tables.h"
#include "bench/report/contents.h"
#include "bench/study/chart_file.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr const char *kRaw = "raw", *kCases = "cases";

enum class Holds { values, lone_times, what_stands_elsewhere };

// Tables of formulations by `tables` are made of raw.csv, those of all charts of the charts; `scale` keeps no
// repetitions.
Holds holds(const CsvTable& table) {
  for (const Section& section : contents())
    for (const Item& item : section.items) {
      if (item.figure != table.file && std::ranges::find(item.tables, table.file) == std::end(item.tables)) continue;
      if (item.command == "scale") return Holds::lone_times;
      if (item.command.starts_with("chart") || (item.command == "tables" && table.column("formulation") >= 0))
        return Holds::what_stands_elsewhere;
    }
  return Holds::values;
}

// The table of cases of a study in the folder itself, and its pictures, which are drawn from it.
bool of_study(const Results& results, const std::string& name) {
  for (const StudyResults& study : results.studies) {
    if (!study.folder.empty()) continue;
    if (name == kCases) return true;
    for (const StudyPicture& picture : study.pictures)
      if (name == picture.file || name == picture.file + "_table") return true;
  }
  return false;
}

class Comparer {
 public:
  Comparer(const Results& a, const Results& b) : a_(a), b_(b) {}

  Comparison run() {
    find_origins();
    for (const auto& [name, table] : a_.tables)
      if (!b_.find(name)) told_.only_a(name + ".csv");
    for (const auto& [name, table] : b_.tables)
      if (!a_.find(name)) told_.only_b(name + ".csv");
    for (const auto& [name, table] : a_.tables)
      if (const CsvTable* other = b_.find(name)) compare_tables(table, *other);
    compare_studies();
    return std::move(told_).told();
  }

 private:
  static std::string origin(const Results& results, const std::string& key) {
    std::set<std::string> values;
    const auto add = [&](const CsvTable& table) {
      if (const std::string value = table.note(key); !value.empty()) values.insert(value);
    };
    for (const auto& [name, table] : results.tables) add(table);
    for (const StudyResults& study : results.studies) add(study.origin);
    return fmt::format("{}", fmt::join(values, "; "));
  }

  void find_origins() {
    for (const char* key : {"processor", "program", "compiler", "libraries"})
      told_.origin(key, origin(a_, key), origin(b_, key));
    told_.origin("incomplete", incomplete(a_), incomplete(b_));
  }

  // "chart.csv", by commas: what was interrupted and lacks rows.
  static std::string incomplete(const Results& results) {
    std::vector<std::string> files;
    for (const auto& [name, table] : results.tables)
      if (!table.note("incomplete").empty()) files.push_back(name + ".csv");
    return fmt::format("{}", fmt::join(files, ", "));
  }

  void compare_tables(const CsvTable& a, const CsvTable& b) {
    const std::string file = a.file + ".csv";
    if (of_study(a_, a.file) && of_study(b_, a.file)) return;
    for (const char* key : {"settings", "scene"})
      if (a.note(key) != b.note(key))
        return told_.leave_out_all(file, fmt::format("other {}: \"{}\" and \"{}\"", key, a.note(key), b.note(key)));
    if (a.header != b.header) return told_.leave_out_all(file, "the columns are others");
    if (a.file == kRaw) return compare_raw(a, b, told_);
    if (is_chart(a)) return compare_charts(a, b, told_);
    const Holds what = holds(a);
    if (what == Holds::lone_times) return told_.leave_out(file, "nothing", "times without their repetitions");
    if (what == Holds::values) compare_values(a, b, told_);
  }

  void compare_studies() {
    const auto missing = [](const StudyResults& study, const Results& others) {
      return !study.folder.empty() &&
             std::ranges::find(others.studies, study.folder, &StudyResults::folder) == others.studies.end();
    };
    for (const StudyResults& study : b_.studies)
      if (missing(study, a_)) told_.only_b(study.folder + "cases.csv");
    for (const StudyResults& study : a_.studies) {
      const std::string file = study.folder + "cases.csv";
      const auto other = std::ranges::find(b_.studies, study.folder, &StudyResults::folder);
      if (missing(study, b_)) told_.only_a(file);
      if (other == b_.studies.end()) continue;
      if (study.incomplete || other->incomplete)
        told_.leave_out_all(file, "the study is incomplete");
      else
        compare_cases(file, read_csv(a_.folder / file), study.origin, read_csv(b_.folder / file), other->origin, told_);
    }
  }

  const Results &a_, &b_;
  Differences told_;
};

}  // namespace

Comparison compare(const Results& a, const Results& b) {
  return Comparer(a, b).run();
}

}  // namespace poinsot::report
