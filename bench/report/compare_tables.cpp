#include "bench/report/compare_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/study/chart_file.h"
#include "core/counted.h"

namespace poinsot::report {

using namespace study;

void compare_raw(const CsvTable& a, const CsvTable& b, Differences& told) {
  const std::string why = why_no_times(a, b);
  if (!why.empty()) told.leave_out("raw.csv", "times", why);
  told.each("raw.csv", raw_cells(a), raw_cells(b), &RawCell::name, [&](const RawCell& cell, const RawCell& other) {
    for (const auto& [quantity, count] : cell.counts)
      told.changed("raw.csv", cell.name(), quantity, count, other.counts.at(quantity));
    if (why.empty()) told.times(cell, other);
  });
}

void compare_charts(const CsvTable& a, const CsvTable& b, Differences& told) {
  const std::string why = why_no_times(a, b), file = a.file + ".csv";
  if (!why.empty()) told.leave_out(file, "times", why);
  const std::vector<ChartRow> before = chart_rows(a), after = chart_rows(b);
  const PerQuantity agreement = chart_agreement(before);
  std::vector<double> spreads = chart_spreads(before);
  for (const double x : chart_spreads(after)) spreads.push_back(x);
  const CommonSpread spread(spreads);
  std::size_t left_out = 0;
  const auto name = [](const ChartRow& r) {
    return r.is_reference() ? r.measured.status : fmt::format("{}, {} {}", r.method(), r.parameter, r.value);
  };
  told.each(file, before, after, name, [&](const ChartRow& row, const ChartRow& other) {
    const Measured &m = row.measured, &n = other.measured;
    if (row.is_reference()) return;
    if (m.left_out() || n.left_out()) {
      left_out += m.left_out() != n.left_out();
      return;
    }
    told.changed(file, name(row), "status", m.status, n.status);
    if (!m.ok() || !n.ok()) return;
    told.changed(file, name(row), "newton_iterations", std::to_string(m.newton_iterations),
                 std::to_string(n.newton_iterations));
    for (std::size_t k = 0; k < kQuantities.size(); ++k)
      if (std::abs(m.error[k] - n.error[k]) > kResolved * agreement[k])
        told.changed(file, name(row), fmt::format("error in {}", kQuantities[k]), fmt::format("{:.3g}", m.error[k]),
                     fmt::format("{:.3g}", n.error[k]));
    if (why.empty()) told.times_by_spreads(file, name(row), {m.seconds, m.spread}, {n.seconds, n.spread}, spread);
  });
  if (left_out > 0)
    told.leave_out(file, counted(left_out, "case"), "left out for the time they take in one of the two");
}

void compare_values(const CsvTable& a, const CsvTable& b, Differences& told) {
  if (a.rows.size() != b.rows.size())
    return told.changed(a.file + ".csv", "", "rows", std::to_string(a.rows.size()), std::to_string(b.rows.size()));
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
    told.changed(a.file + ".csv", "", fmt::format("{} of {} fields", differ, all), "",
                 fmt::format("numbers by up to {:.2g}", most));
}

}  // namespace poinsot::report
