#include "bench/report/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/paper/cell_rows.h"
#include "bench/paper/published.h"

namespace poinsot::report {
using namespace study;
namespace {

void add_published(Ratio& ratio) {
  const Analysis analysis =
      ratio.analysis == paper::analysis_name(Analysis::kinematics) ? Analysis::kinematics : Analysis::dynamics;
  const paper::Published* subject = paper::find_published(analysis, ratio.mechanism, paper::kSubject);
  const paper::Published* other = paper::find_published(analysis, ratio.mechanism, ratio.formulation);
  if (!subject || !other) return;
  ratio.paper_c1 = subject->speedup_c1 / other->speedup_c1;
  ratio.paper_c2 = subject->speedup_c2 / other->speedup_c2;
}

}  // namespace

std::vector<Ratio> ratios(const CsvTable& raw) {
  std::vector<RawCell> cells = raw_cells(raw);
  if (cells.empty()) return {};
  const std::string solver = cells.front().linear_solver;
  std::erase_if(cells, [&](const RawCell& c) { return c.block > 0 || c.linear_solver != solver; });
  std::vector<Ratio> all;
  for (const RawCell& cell : cells) {
    if (cell.formulation == paper::kSubject) continue;
    const auto subject = std::ranges::find_if(cells, [&](const RawCell& c) {
      return c.analysis == cell.analysis && c.mechanism == cell.mechanism && c.jacobian == cell.jacobian &&
             c.formulation == paper::kSubject;
    });
    if (subject == cells.end()) continue;
    std::vector<double> quotients;
    std::array<std::vector<double>, kPhases.size()> saved;
    for (const auto& [repetition, run] : cell.repetitions) {
      const auto other = subject->repetitions.find(repetition);
      if (other == subject->repetitions.end() || !(other->second.total > 0) || !std::isfinite(run.total)) continue;
      quotients.push_back(run.total / other->second.total);
      for (std::size_t k = 0; k < saved.size(); ++k) saved[k].push_back(run.phase[k] - other->second.phase[k]);
    }
    if (quotients.empty()) continue;
    Ratio ratio{cell.analysis, cell.mechanism, cell.formulation, cell.jacobian, median_interval(quotients), {}, 0, 0};
    for (std::size_t k = 0; k < saved.size(); ++k) ratio.saved[k] = median_interval(saved[k]).median;
    add_published(ratio);
    all.push_back(std::move(ratio));
  }
  return all;
}

Table ratios_table(const std::vector<Ratio>& all) {
  Table table{"report_ratios",
              fmt::format("Time over that of {}", paper::kSubject),
              fmt::format("Medians of the quotients of interleaved repetitions, and the interval their order gives. By "
                          "phase: what {} saves, microseconds a step.",
                          paper::kSubject),
              {"analysis", "mechanism", "formulation", "jacobian", "ratio", "from", "to", "confidence, %"}};
  for (const auto phase : kPhases) table.header.push_back(fmt::format("{}, us", phase));
  table.header.insert(table.header.end(), {"paper C1", "paper C2"});
  for (const Ratio& r : all) {
    table.rows.push_back({r.analysis, r.mechanism, r.formulation, r.jacobian, fmt::format("{:.2f}", r.over.median),
                          fmt::format("{:.2f}", r.over.low), fmt::format("{:.2f}", r.over.high),
                          fmt::format("{:.1f}", 100 * r.over.confidence)});
    for (const double x : r.saved) table.rows.back().push_back(fmt::format("{:.3f}", x));
    for (const double x : {r.paper_c1, r.paper_c2}) table.rows.back().push_back(paper::number(x, 2));
  }
  return table;
}

}  // namespace poinsot::report
