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

}  // namespace

Table matched_table(const std::vector<const CsvTable*>& charts) {
  Table table{
      "report_matched",
      fmt::format("Time over that of {} at the same accuracy", paper::kSubject),
      "Between the measured cases of a method its time is interpolated, log time over log error. Noise: what the "
      "spreads of the two times allow for, in per cent.",
      {"scene", "integrator", "formulation", "quantity", "accuracy", "ratio", "noise, %"}};
  for (const CsvTable* file : charts) {
    const std::vector<ChartRow> all = chart_rows(*file);
    const PerQuantity agreement = chart_agreement(all);
    std::map<std::string, std::vector<ChartRow>> by_integrator;
    for (const ChartRow& row : all)
      if (!row.is_reference()) by_integrator[row.integrator].push_back(row);
    for (const auto& [integrator, rows] : by_integrator)
      for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
        const std::vector<CostCurve> curves = cost_curves(rows, quantity, agreement[quantity]);
        const auto of = [&rows = rows](const CostCurve& c) { return rows[c.knots.front().row].formulation; };
        for (const CostCurve& subject : curves)
          for (const CostCurve& other : curves)
            for (const int k : kExponents) {
              const double error = std::pow(10.0, -k);
              const auto ours = subject.seconds_at(error), theirs = other.seconds_at(error);
              if (of(subject) != paper::kSubject || of(other) == paper::kSubject || !ours || !theirs) continue;
              if (error < kResolved * agreement[quantity]) continue;
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
