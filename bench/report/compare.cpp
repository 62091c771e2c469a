#include "bench/report/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "bench/report/contents.h"
#include "bench/report/raw_cells.h"
#include "bench/study/chart_file.h"
#include "bench/study/measure.h"
#include "core/counted.h"

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

bool is_measured(const std::string& column) {
  return column == "seconds" || column == "spread" || column.starts_with("seconds_");
}

class Comparer {
 public:
  Comparer(const Results& a, const Results& b) : a_(a), b_(b) {}

  Comparison run() {
    find_origins();
    for (const auto& [name, table] : a_.tables)
      if (!b_.find(name)) result_.only_a.push_back(name + ".csv");
    for (const auto& [name, table] : b_.tables)
      if (!a_.find(name)) result_.only_b.push_back(name + ".csv");
    for (const auto& [name, table] : a_.tables)
      if (const CsvTable* other = b_.find(name)) compare_tables(table, *other);
    compare_studies();
    if (!quotients_.empty()) result_.common = median_interval(quotients_).median;
    return std::move(result_);
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
      if (const std::string a = origin(a_, key), b = origin(b_, key); a != b) result_.origins.push_back({key, a, b});
    if (const std::string a = incomplete(a_), b = incomplete(b_); a != b)
      result_.origins.push_back({"incomplete", a, b});
  }

  // "chart.csv", by commas: what was interrupted and lacks rows.
  static std::string incomplete(const Results& results) {
    std::vector<std::string> files;
    for (const auto& [name, table] : results.tables)
      if (!table.note("incomplete").empty()) files.push_back(name + ".csv");
    return fmt::format("{}", fmt::join(files, ", "));
  }

  // Empty, or why the times of two tables say nothing of one another.
  static std::string why_no_times(const CsvTable& a, const CsvTable& b) {
    for (const auto& [key, what] :
         {std::pair{"processor", "another processor"}, {"compiler", "another compiler or flags"}})
      if (a.note(key) != b.note(key)) return fmt::format("{}: found \"{}\" and \"{}\"", what, a.note(key), b.note(key));
    return {};
  }

  void leave_out(const std::string& file, const std::string& what, const std::string& why) {
    result_.not_compared.push_back(fmt::format("{}: {}: {}", file, what, why));
  }

  // Not what never says anything of another folder, but what would if it had been computed alike.
  void leave_out_all(const std::string& file, const std::string& why) {
    leave_out(file, "nothing", why);
    result_.incomparable = true;
  }

  void compare_tables(const CsvTable& a, const CsvTable& b) {
    const std::string file = a.file + ".csv";
    if (of_study(a_, a.file) && of_study(b_, a.file)) return;
    for (const char* key : {"settings", "scene"})
      if (a.note(key) != b.note(key))
        return leave_out_all(file, fmt::format("other {}: \"{}\" and \"{}\"", key, a.note(key), b.note(key)));
    if (a.header != b.header) return leave_out_all(file, "the columns are others");
    if (a.file == kRaw) return compare_raw(a, b);
    if (is_chart(a)) return compare_charts(a, b);
    const Holds what = holds(a);
    if (what == Holds::lone_times) return leave_out(file, "nothing", "times without their repetitions");
    if (what == Holds::values) compare_values(a, b);
  }

  void changed(const std::string& file, const std::string& cell, const std::string& quantity, const std::string& before,
               const std::string& after) {
    if (before != after) result_.changed.push_back({file, cell, quantity, before, after});
  }

  // What has the same name in both files; what one of them lacks is told.
  template <class Item, class Name, class Compare>
  void compare_each(const std::string& file, const std::vector<Item>& before, const std::vector<Item>& after,
                    const Name& name, const Compare& compare) {
    for (const Item& item : after)
      if (std::ranges::find(before, std::invoke(name, item), name) == before.end())
        result_.only_b.push_back(fmt::format("{}: {}", file, std::invoke(name, item)));
    for (const Item& item : before) {
      const auto other = std::ranges::find(after, std::invoke(name, item), name);
      if (other == after.end())
        result_.only_a.push_back(fmt::format("{}: {}", file, std::invoke(name, item)));
      else
        compare(item, *other);
    }
  }

  void compare_raw(const CsvTable& a, const CsvTable& b) {
    const std::string why = why_no_times(a, b);
    if (!why.empty()) leave_out("raw.csv", "times", why);
    compare_each("raw.csv", raw_cells(a), raw_cells(b), &RawCell::name, [&](const RawCell& cell, const RawCell& other) {
      for (const auto& [quantity, count] : cell.counts)
        changed("raw.csv", cell.name(), quantity, count, other.counts.at(quantity));
      if (why.empty()) compare_times(cell, other);
    });
  }

  void compare_times(const RawCell& a, const RawCell& b) {
    std::vector<double> ratios, before, after;
    for (const auto& [repetition, run] : a.repetitions) {
      const auto other = b.repetitions.find(repetition);
      if (other == b.repetitions.end() || !(run.total > 0) || !(other->second.total > 0)) continue;
      ratios.push_back(other->second.total / run.total);
      before.push_back(run.total), after.push_back(other->second.total);
    }
    if (ratios.empty()) return;
    const Interval ratio = median_interval(ratios, kOfChange);
    ++result_.times;
    quotients_.push_back(ratio.median);
    if (ratio.confidence > 0) result_.by_chance += 1 - ratio.confidence;
    if (ratio.confidence > 0 && !ratio.contains(1))
      result_.changed_times.push_back(
          {"raw.csv", a.name(), median_interval(before).median, median_interval(after).median, ratio});
  }

  void compare_charts(const CsvTable& a, const CsvTable& b) {
    const std::string why = why_no_times(a, b), file = a.file + ".csv";
    if (!why.empty()) leave_out(file, "times", why);
    const std::vector<ChartRow> before = chart_rows(a), after = chart_rows(b);
    const PerQuantity agreement = chart_agreement(before);
    std::vector<double> spreads = chart_spreads(before);
    for (const double x : chart_spreads(after)) spreads.push_back(x);
    const CommonSpread spread(spreads);
    std::size_t left_out = 0;
    const auto name = [](const ChartRow& r) {
      return r.is_reference() ? r.measured.status : fmt::format("{}, {} {}", r.method(), r.parameter, r.value);
    };
    compare_each(file, before, after, name, [&](const ChartRow& row, const ChartRow& other) {
      const Measured &m = row.measured, &n = other.measured;
      if (row.is_reference()) return;
      if (m.left_out() || n.left_out()) {
        left_out += m.left_out() != n.left_out();
        return;
      }
      changed(file, name(row), "status", m.status, n.status);
      if (!m.ok() || !n.ok()) return;
      changed(file, name(row), "newton_iterations", std::to_string(m.newton_iterations),
              std::to_string(n.newton_iterations));
      for (std::size_t k = 0; k < kQuantities.size(); ++k)
        if (std::abs(m.error[k] - n.error[k]) > kResolved * agreement[k])
          changed(file, name(row), fmt::format("error in {}", kQuantities[k]), fmt::format("{:.3g}", m.error[k]),
                  fmt::format("{:.3g}", n.error[k]));
      if (why.empty()) compare_by_spreads(file, name(row), {m.seconds, m.spread}, {n.seconds, n.spread}, spread);
    });
    if (left_out > 0) leave_out(file, counted(left_out, "case"), "left out for the time they take in one of the two");
  }

  struct Timed {
    double seconds, spread;
  };

  void compare_by_spreads(const std::string& file, const std::string& cell, const Timed& a, const Timed& b,
                          const CommonSpread& common) {
    constexpr double kTimes = 3, kBetweenRuns = 0.1;
    if (!(a.seconds > 0) || !(b.seconds > 0)) return;
    const double spread = std::hypot(common.of(a.spread), common.of(b.spread));
    const double ratio = b.seconds / a.seconds, noise = 1 + std::max(kBetweenRuns, kTimes * spread);
    ++result_.times;
    quotients_.push_back(ratio);
    if (ratio > noise || ratio * noise < 1)
      result_.changed_times.push_back({file, cell, a.seconds, b.seconds, {ratio, ratio / noise, ratio * noise, 0}});
  }

  void compare_studies() {
    const auto missing = [](const StudyResults& study, const Results& others) {
      return !study.folder.empty() &&
             std::ranges::find(others.studies, study.folder, &StudyResults::folder) == others.studies.end();
    };
    for (const StudyResults& study : b_.studies)
      if (missing(study, a_)) result_.only_b.push_back(study.folder + "cases.csv");
    for (const StudyResults& study : a_.studies) {
      const std::string file = study.folder + "cases.csv";
      const auto other = std::ranges::find(b_.studies, study.folder, &StudyResults::folder);
      if (missing(study, b_)) result_.only_a.push_back(file);
      if (other == b_.studies.end()) continue;
      if (study.incomplete || other->incomplete)
        leave_out_all(file, "the study is incomplete");
      else
        compare_cases(file, study, *other);
    }
  }

  // Of the fields of a column: in how many cases they differ, and by how much.
  struct Difference {
    std::size_t cases = 0;
    double most = 0;

    void add(const std::string& before, const std::string& after) {
      if (before == after) return;
      ++cases;
      if (const double by = std::abs(csv_number(before) - csv_number(after)); by > most) most = by;
    }
  };

  // Case by case, and told column by column: there may be very many.
  void compare_cases(const std::string& file, const StudyResults& of_a, const StudyResults& of_b) {
    const CsvTable a = read_csv(a_.folder / file), b = read_csv(b_.folder / file);
    if (a.header != b.header) return leave_out_all(file, "the columns are others");
    const int status = a.column("status"), seconds = a.column("seconds"), spread = a.column("spread");
    if (status < 1) return leave_out_all(file, "it is no table of cases");
    const std::string why = why_no_times(of_a.origin, of_b.origin);
    const bool timed = seconds >= 0 && spread >= 0;
    if (timed && !why.empty()) leave_out(file, "times", why);
    const auto time = [&](const std::vector<std::string>& row) {
      return Timed{csv_number(row[static_cast<std::size_t>(seconds)]),
                   csv_number(row[static_cast<std::size_t>(spread)])};
    };
    std::vector<double> spreads;
    if (timed)
      for (const CsvTable* table : {&a, &b})
        for (const auto& row : table->rows)
          if (const double x = time(row).spread; std::isfinite(x)) spreads.push_back(x);
    const CommonSpread common(spreads);
    std::map<std::string, const std::vector<std::string>*> rest;
    for (const auto& row : b.rows) rest[row[0]] = &row;
    std::vector<Difference> differences(a.header.size());
    std::size_t others = 0, both = 0;
    for (const auto& row : a.rows) {
      const auto found = rest.find(row[0]);
      if (found == rest.end()) continue;
      const std::vector<std::string>& other = *found->second;
      rest.erase(found);
      ++both;
      if (!std::equal(row.begin(), row.begin() + status, other.begin())) {
        ++others;
        continue;
      }
      for (std::size_t c = static_cast<std::size_t>(status); c < row.size(); ++c)
        if (!is_measured(a.header[c])) differences[c].add(row[c], other[c]);
      if (timed && why.empty()) compare_by_spreads(file, "case " + row[0], time(row), time(other), common);
    }
    if (const std::size_t alone = a.rows.size() - both; alone > 0)
      result_.only_a.push_back(fmt::format("{}: {}", file, counted(alone, "case")));
    if (!rest.empty()) result_.only_b.push_back(fmt::format("{}: {}", file, counted(rest.size(), "case")));
    const auto told = [&](const std::string& what, const std::string& how) {
      result_.changed.push_back({file, "", what, "", how});
    };
    if (others > 0)
      told("scene or values", fmt::format("others in {} of {} cases, which are not compared", others, both));
    for (std::size_t c = 0; c < differences.size(); ++c)
      if (const auto& [cases, most] = differences[c]; cases > 0)
        told(a.header[c], fmt::format("differs in {} of {} cases{}", cases, both,
                                      most > 0 ? fmt::format(", by up to {:.2g}", most) : ""));
  }

  // Cell by cell: of the numbers that differ, how many and by how much.
  void compare_values(const CsvTable& a, const CsvTable& b) {
    if (a.rows.size() != b.rows.size())
      return changed(a.file + ".csv", "", "rows", std::to_string(a.rows.size()), std::to_string(b.rows.size()));
    std::size_t differ = 0, all = 0;
    double most = 0;
    for (std::size_t r = 0; r < a.rows.size(); ++r)
      for (std::size_t c = 0; c < a.header.size(); ++c) {
        const std::string &before = a.rows[r][c], &after = b.rows[r][c];
        const double x = csv_number(before), y = csv_number(after);
        ++all;
        differ += before != after;
        if (before != after && std::isfinite(x) && std::isfinite(y)) most = std::max(most, std::abs(x - y));
      }
    if (differ > 0)
      result_.changed.push_back({a.file + ".csv", "", fmt::format("{} of {} fields", differ, all), "",
                                 fmt::format("numbers by up to {:.2g}", most)});
  }

  const Results &a_, &b_;
  Comparison result_;
  std::vector<double> quotients_;
};

}  // namespace

Comparison compare(const Results& a, const Results& b) {
  return Comparer(a, b).run();
}

}  // namespace poinsot::report
