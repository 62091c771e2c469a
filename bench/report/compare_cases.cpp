#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/report/compare_tables.h"
#include "core/counted.h"

namespace poinsot::report {

using namespace study;

namespace {

bool is_measured(const std::string& column) {
  return column == "seconds" || column == "spread" || column.starts_with("seconds_");
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

}  // namespace

void compare_cases(const std::string& file, const CsvTable& a, const CsvTable& origin_a, const CsvTable& b,
                   const CsvTable& origin_b, Differences& told) {
  if (a.header != b.header) return told.leave_out_all(file, "the columns are others");
  const int status = a.column("status"), seconds = a.column("seconds"), spread = a.column("spread");
  if (status < 1) return told.leave_out_all(file, "it is no table of cases");
  const std::string why = why_no_times(origin_a, origin_b);
  const bool timed = seconds >= 0 && spread >= 0;
  if (timed && !why.empty()) told.leave_out(file, "times", why);
  const auto time = [&](const std::vector<std::string>& row) {
    return Differences::Timed{csv_number(row[static_cast<std::size_t>(seconds)]),
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
    if (timed && why.empty()) told.times_by_spreads(file, "case " + row[0], time(row), time(other), common);
  }
  if (const std::size_t alone = a.rows.size() - both; alone > 0)
    told.only_a(fmt::format("{}: {}", file, counted(alone, "case")));
  if (!rest.empty()) told.only_b(fmt::format("{}: {}", file, counted(rest.size(), "case")));
  if (others > 0)
    told.changed(file, "", "scene or values", "",
                 fmt::format("others in {} of {} cases, which are not compared", others, both));
  for (std::size_t c = 0; c < differences.size(); ++c)
    if (const auto& [cases, most] = differences[c]; cases > 0)
      told.changed(file, "", a.header[c], "",
                   fmt::format("differs in {} of {} cases{}", cases, both,
                               most > 0 ? fmt::format(", by up to {:.2g}", most) : ""));
}

}  // namespace poinsot::report
