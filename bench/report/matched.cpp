#include <fmt/format.h>

#include <cmath>
#include <map>

#include "bench/paper/cell_rows.h"
#include "bench/report/findings.h"
#include "bench/study/chart_file.h"
#include "bench/study/cost_curve.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr int kExponents[] = {2, 4, 6, 8, 10};

// The rows of one integrator, and where the reference ends.
struct Chart {
  std::map<std::string, std::vector<ChartRow>> by_integrator;
  PerQuantity agreement{};
};

Chart read_chart(const CsvTable& table) {
  Chart chart;
  for (const ChartRow& row : chart_rows(table)) {
    if (row.measured.status == "reference")
      chart.agreement = row.measured.error;
    else
      chart.by_integrator[row.integrator].push_back(row);
  }
  return chart;
}

}  // namespace

Table matched_table(const std::vector<const CsvTable*>& charts) {
  Table table{
      "report_matched",
      fmt::format("Time over that of {} at the same accuracy", paper::kSubject),
      "Between the measured cases of a method its time is interpolated, log time over log error. Noise: what the "
      "spreads of the two times allow for, in per cent.",
      {"scene", "integrator", "formulation", "quantity", "accuracy", "ratio", "noise, %"}};
  for (const CsvTable* file : charts) {
    const Chart chart = read_chart(*file);
    for (const auto& [integrator, rows] : chart.by_integrator)
      for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
        const std::vector<CostCurve> curves = cost_curves(rows, quantity, chart.agreement[quantity]);
        const auto of = [&rows = rows](const CostCurve& c) { return rows[c.knots.front().row].formulation; };
        for (const CostCurve& subject : curves)
          for (const CostCurve& other : curves)
            for (const int k : kExponents) {
              const double error = std::pow(10.0, -k);
              const auto ours = subject.seconds_at(error), theirs = other.seconds_at(error);
              if (of(subject) != paper::kSubject || of(other) == paper::kSubject || !ours || !theirs) continue;
              if (error < kResolved * chart.agreement[quantity]) continue;
              // Where either is asked for less than its coarsest case has, the accuracies are not matched.
              if (error > subject.knots.front().error || error > other.knots.front().error) continue;
              table.rows.push_back(
                  {file->file, integrator, of(other), std::string(kQuantities[quantity]), fmt::format("1e-{}", k),
                   fmt::format("{:.2f}", *theirs / *ours),
                   fmt::format("{:.0f}", 100 * std::hypot(subject.spread_at(error), other.spread_at(error)))});
            }
      }
  }
  return table;
}

}  // namespace poinsot::report
