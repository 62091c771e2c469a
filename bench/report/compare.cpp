#include "bench/report/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "bench/report/contents.h"
#include "bench/report/raw_cells.h"
#include "bench/study/chart_file.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr const char* kRaw = "raw";

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
    if (!quotients_.empty()) result_.common = median_interval(quotients_).median;
    return std::move(result_);
  }

 private:
  static std::string origin(const Results& results, const std::string& key) {
    std::set<std::string> values;
    for (const auto& [name, table] : results.tables)
      if (const std::string value = table.note(key); !value.empty()) values.insert(value);
    return fmt::format("{}", fmt::join(values, "; "));
  }

  void find_origins() {
    for (const char* key : {"processor", "program", "compiler", "libraries"})
      if (const std::string a = origin(a_, key), b = origin(b_, key); a != b) result_.origins.push_back({key, a, b});
  }

  // Empty, or why the times of two tables say nothing of one another.
  static std::string why_no_times(const CsvTable& a, const CsvTable& b) {
    for (const auto& [key, what] :
         {std::pair{"processor", "another processor"}, {"compiler", "another compiler or flags"}})
      if (a.note(key) != b.note(key)) return fmt::format("{}: found \"{}\" and \"{}\"", what, a.note(key), b.note(key));
    return {};
  }

  void leave_out(const CsvTable& table, const std::string& what, const std::string& why) {
    result_.not_compared.push_back(fmt::format("{}.csv: {}: {}", table.file, what, why));
  }

  void compare_tables(const CsvTable& a, const CsvTable& b) {
    for (const char* key : {"settings", "scene"})
      if (a.note(key) != b.note(key))
        return leave_out(a, "nothing", fmt::format("other {}: \"{}\" and \"{}\"", key, a.note(key), b.note(key)));
    if (a.header != b.header) return leave_out(a, "nothing", "the columns are others");
    if (a.file == kRaw) return compare_raw(a, b);
    if (is_chart(a)) return compare_charts(a, b);
    const Holds what = holds(a);
    if (what == Holds::lone_times) return leave_out(a, "nothing", "times without their repetitions");
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
    if (!why.empty()) leave_out(a, "times", why);
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
    if (!why.empty()) leave_out(a, "times", why);
    const std::vector<ChartRow> before = chart_rows(a), after = chart_rows(b);
    const PerQuantity agreement = chart_agreement(before);
    const auto name = [](const ChartRow& r) {
      return r.is_reference() ? r.measured.status : fmt::format("{}, {} {}", r.method(), r.parameter, r.value);
    };
    compare_each(file, before, after, name, [&](const ChartRow& row, const ChartRow& other) {
      const Measured &m = row.measured, &n = other.measured;
      if (row.is_reference()) return;
      changed(file, name(row), "status", m.status, n.status);
      if (!m.ok() || !n.ok()) return;
      changed(file, name(row), "newton_iterations", std::to_string(m.newton_iterations),
              std::to_string(n.newton_iterations));
      for (std::size_t k = 0; k < kQuantities.size(); ++k)
        if (std::abs(m.error[k] - n.error[k]) > kResolved * agreement[k])
          changed(file, name(row), fmt::format("error in {}", kQuantities[k]), fmt::format("{:.3g}", m.error[k]),
                  fmt::format("{:.3g}", n.error[k]));
      if (!why.empty() || !(m.seconds > 0) || !(n.seconds > 0)) return;
      const double ratio = n.seconds / m.seconds, noise = 1 + std::hypot(m.spread, n.spread);
      ++result_.times;
      if (ratio > noise || ratio * noise < 1)
        result_.changed_times.push_back(
            {file, name(row), m.seconds, n.seconds, {ratio, ratio / noise, ratio * noise, 0}});
    });
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
