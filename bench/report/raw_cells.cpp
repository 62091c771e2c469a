#include "bench/report/raw_cells.h"

#include <fmt/format.h>

#include <algorithm>

namespace poinsot::report {
using namespace study;
namespace {

constexpr std::array kKey{"analysis", "mechanism", "formulation", "jacobian", "linear_solver"};
constexpr std::array kPhaseColumns{"assembly_s", "factor_s", "solve_s", "other_s"};
constexpr std::array kCounts{"factored",       "steps", "newton_iterations", "jacobian_evaluations",
                             "factorizations", "solves"};

}  // namespace

std::string RawCell::name() const {
  return fmt::format("{}, {}, {}, {}, {}{}", analysis, mechanism, formulation, jacobian, linear_solver,
                     block == 0 ? "" : fmt::format(" #{}", block + 1));
}

std::vector<RawCell> raw_cells(const CsvTable& raw) {
  const auto has = [&](const char* name) { return raw.column(name) >= 0; };
  if (!std::ranges::all_of(kKey, has) || !std::ranges::all_of(kPhaseColumns, has) ||
      !std::ranges::all_of(kCounts, has) || !has("repetition") || !has("total_s"))
    return {};
  std::vector<RawCell> cells;
  for (const auto& row : raw.rows) {
    const auto field = [&](const char* name) -> const std::string& {
      return row[static_cast<std::size_t>(raw.column(name))];
    };
    const std::string& repetition = field("repetition");
    const auto its = [&](const RawCell& c) {
      return c.analysis == field("analysis") && c.mechanism == field("mechanism") &&
             c.formulation == field("formulation") && c.jacobian == field("jacobian") &&
             c.linear_solver == field("linear_solver");
    };
    const auto last = std::find_if(cells.rbegin(), cells.rend(), its);
    if (last == cells.rend() || last->repetitions.contains(repetition)) {
      cells.push_back({field("analysis"), field("mechanism"), field("formulation"), field("jacobian"),
                       field("linear_solver"), last == cells.rend() ? 0 : last->block + 1});
      for (const char* count : kCounts) cells.back().counts[count] = field(count);
    }
    RawCell& cell = *std::find_if(cells.rbegin(), cells.rend(), its);
    const double us = 1e6 / csv_number(field("steps"));
    RawCell::Repetition one{us * csv_number(field("total_s"))};
    for (std::size_t k = 0; k < kPhaseColumns.size(); ++k) one.phase[k] = us * csv_number(field(kPhaseColumns[k]));
    cell.repetitions.emplace(repetition, one);
  }
  return cells;
}

}  // namespace poinsot::report
