#include "bench/report/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/paper/cell_rows.h"
#include "bench/paper/published.h"

namespace poinsot::report {
using namespace study;
namespace {

// A repetition of a cell.
struct Run {
  double total = 0;               // s
  std::array<double, 4> phase{};  // µs a step
};

struct Cell {
  std::vector<std::string> key;     // analysis, mechanism, formulation, jacobian
  std::map<std::string, Run> runs;  // by repetition
};

std::vector<Cell> cells_of(const CsvTable& raw) {
  std::vector<int> key, phases;
  for (const char* name : {"analysis", "mechanism", "formulation", "jacobian"}) key.push_back(raw.column(name));
  for (const char* name : {"assembly_s", "factor_s", "solve_s", "other_s"}) phases.push_back(raw.column(name));
  const int solver = raw.column("linear_solver"), repetition = raw.column("repetition"), steps = raw.column("steps"),
            total = raw.column("total_s");
  std::vector<int> all{solver, repetition, steps, total};
  all.insert(all.end(), key.begin(), key.end());
  all.insert(all.end(), phases.begin(), phases.end());
  if (std::ranges::min(all) < 0 || raw.rows.empty()) return {};
  const auto field = [](const std::vector<std::string>& row, int column) -> const std::string& {
    return row[static_cast<std::size_t>(column)];
  };
  std::vector<Cell> cells;
  for (const auto& row : raw.rows) {
    if (field(row, solver) != field(raw.rows.front(), solver)) continue;
    std::vector<std::string> own;
    for (const int column : key) own.push_back(field(row, column));
    auto cell = std::ranges::find(cells, own, &Cell::key);
    if (cell == cells.end()) cell = cells.insert(cell, {own, {}});
    Run run{csv_number(field(row, total)), {}};
    for (std::size_t k = 0; k < phases.size(); ++k)
      run.phase[k] = 1e6 * csv_number(field(row, phases[k])) / csv_number(field(row, steps));
    cell->runs.emplace(field(row, repetition), run);  // measured once more beside other solvers: the first counts
  }
  return cells;
}

double median(const std::vector<double>& values) {
  return median_interval(values).median;
}

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
  const std::vector<Cell> cells = cells_of(raw);
  std::vector<Ratio> all;
  for (const Cell& cell : cells) {
    if (cell.key[2] == paper::kSubject) continue;
    std::vector<std::string> key = cell.key;
    key[2] = paper::kSubject;
    const auto subject = std::ranges::find(cells, key, &Cell::key);
    if (subject == cells.end()) continue;
    std::vector<double> quotients;
    std::array<std::vector<double>, 4> saved;
    for (const auto& [repetition, run] : cell.runs) {
      const auto other = subject->runs.find(repetition);
      if (other == subject->runs.end() || !(other->second.total > 0) || !std::isfinite(run.total)) continue;
      quotients.push_back(run.total / other->second.total);
      for (std::size_t k = 0; k < saved.size(); ++k) saved[k].push_back(run.phase[k] - other->second.phase[k]);
    }
    if (quotients.empty()) continue;
    Ratio ratio{cell.key[0], cell.key[1], cell.key[2], cell.key[3], median_interval(quotients), {}, 0, 0};
    for (std::size_t k = 0; k < saved.size(); ++k) ratio.saved[k] = median(saved[k]);
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
              {"analysis", "mechanism", "formulation", "jacobian", "ratio", "from", "to", "confidence, %"},
              {}};
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
