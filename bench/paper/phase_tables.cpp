#include "bench/paper/phase_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "bench/paper/cell_rows.h"
#include "bench/study/range.h"

namespace poinsot::paper {
using namespace study;
namespace {

// "klu, G": the solver that factored most in a run, and which system.
std::string factored(const Cell& cell) {
  if (cell.runs.empty() || cell.runs.front().linear.empty()) return std::string(kNone);
  const LinearWork& most = cell.runs.front().linear.front();
  const std::string by = most.handed_over_by.empty() ? "" : fmt::format(", handed over by {}", most.handed_over_by);
  return fmt::format("{}, {}{}", most.solver, most.system, by);
}

// Which linear solver on which system needs the least time, for how many of the systems (mechanism, formulation,
// jacobian); returns the number of systems.
int count_fastest(std::span<const Cell> cells, std::map<std::string, int>& wins) {
  using System = std::tuple<std::string_view, std::string, std::string>;
  std::map<System, const Cell*> fastest;
  for (const Cell& cell : cells) {
    if (cell.runs.empty()) continue;
    const Cell*& best = fastest[{cell.name, cell.settings.formulation, cell.settings.jacobian}];
    if (!best || us_per_step(cell, total).median < us_per_step(*best, total).median) best = &cell;
  }
  for (const auto& [system, cell] : fastest) ++wins[factored(*cell)];
  return static_cast<int>(fastest.size());
}

}  // namespace

Table phases_table(std::span<const Cell> cells, Analysis analysis) {
  Table table{file_name(analysis, "phases"),
              title(analysis, "time of a step by phase, microseconds"),
              "",
              {"mechanism", "formulation", "jacobian", "total", "spread, %", "assembly", "factorization", "solves",
               "the rest", "iterations", "factorizations"}};
  Range linear_algebra;
  for (const std::string& jacobian : jacobians_of(cells))
    for_rows(
        table, cells, analysis, {jacobian},
        [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const Published*) {
          const Cell& cell = *own[0];
          const Timing whole = us_per_step(cell, total);
          row.push_back(jacobian);
          row.push_back(number(whole.median, 3));
          row.push_back(number(100 * whole.spread, 1));
          for (const PhaseSeconds phase : {assembly, factor, solve, rest})
            row.push_back(number(us_per_step(cell, phase).median, 3));
          row.push_back(number(iterations_per_step(cell), 2));
          if (cell.runs.empty()) return row.push_back(kNone);
          const Statistics& s = cell.runs[0];
          row.push_back(number(static_cast<double>(s.factorizations) / static_cast<double>(s.steps), 2));
          linear_algebra.add(100 * (us_per_step(cell, factor).median + us_per_step(cell, solve).median) / whole.median);
        });
  table.text = "Medians; the spread is the distance of the quartiles of the total.";
  if (!linear_algebra.empty())
    table.text += fmt::format(" Factorization and solves together take {} % of a step; 1 to 4 % in the original codes.",
                              linear_algebra.text(0));
  return table;
}

Table advantage_table(std::span<const Cell> cells, Analysis analysis) {
  constexpr std::pair<std::string_view, PhaseSeconds> phases[] = {
      {"assembly", assembly}, {"factorization", factor}, {"solves", solve}, {"the rest", rest}};
  Table table{file_name(analysis, "advantage"),
              title(analysis, fmt::format("where the time goes that {} saves", kSubject)),
              "",
              {"mechanism", "formulation", "jacobian", fmt::format("slower than {} by, us", kSubject)}};
  for (const auto& [name, phase] : phases) table.header.push_back(fmt::format("{}, us", name));

  double saved[std::size(phases)] = {};
  int faster = 0, compared = 0;
  for (const std::string& jacobian : jacobians_of(cells)) {
    Table part;
    for_rows(part, cells, analysis, {jacobian},
             [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const Published*) {
               const Cell& cell = *own[0];
               const Cell* subject = find(cells, analysis, mechanism_of(cell), kSubject, jacobian);
               const bool missing = !subject || subject->runs.empty() || cell.runs.empty();
               row.push_back(jacobian);
               const auto difference = [&](PhaseSeconds phase) {
                 return us_per_step(cell, phase).median - us_per_step(*subject, phase).median;
               };
               row.push_back(missing ? kNone : fmt::format("{:.3f}", difference(total)));
               for (std::size_t k = 0; k < std::size(phases); ++k) {
                 row.push_back(missing ? kNone : fmt::format("{:.3f}", difference(phases[k].second)));
                 if (!missing) saved[k] += difference(phases[k].second);
               }
               if (!missing && &cell != subject) {
                 ++compared;
                 faster += difference(total) > 0;
               }
             });
    for (auto& row : part.rows)
      if (row[1] != kSubject) table.rows.push_back(std::move(row));
  }
  const double sum = saved[0] + saved[1] + saved[2] + saved[3];
  if (compared == 0) return table;
  table.text = fmt::format("{} is the faster one in {} of {} comparisons.", kSubject, faster, compared);
  if (sum > 0) {
    std::vector<std::string> shares;
    for (std::size_t k = 0; k < std::size(phases); ++k)
      shares.push_back(fmt::format("{:.0f} % in {}", 100 * saved[k] / sum, phases[k].first));
    table.text += fmt::format(" Of all the time it saves, {}.", fmt::join(shares, ", "));
  }
  return table;
}

Table linear_solvers_table(std::span<const Cell> cells) {
  Table table{
      "linear_solvers",
      "Dynamics: all linear solvers, time of a step by phase, microseconds",
      "Medians; the spread is the distance of the quartiles of the total. Factored: by which solver, and which system, "
      "G "
      "alone where there is no degree of freedom or the whole matrix; compare solvers on the same system. Refused: the "
      "solver does not take such matrices.",
      {"mechanism", "formulation", "jacobian", "linear solver", "factored", "total", "spread, %", "assembly",
       "factorization", "solves", "the rest"}};
  for (const Cell& cell : cells) {
    std::vector<std::string> row{std::string(mechanism_of(cell).title), cell.settings.formulation,
                                 cell.settings.jacobian, cell.settings.linear_solver};
    if (cell.refused) {
      row.push_back("refused");
      row.resize(table.header.size());
      table.rows.push_back(std::move(row));
      continue;
    }
    row.push_back(factored(cell));
    const Timing whole = us_per_step(cell, total);
    row.insert(row.end(), {number(whole.median, 3), number(100 * whole.spread, 1)});
    for (const PhaseSeconds phase : {assembly, factor, solve, rest})
      row.push_back(number(us_per_step(cell, phase).median, 3));
    table.rows.push_back(std::move(row));
  }
  std::map<std::string, int> wins;
  const int systems = count_fastest(cells, wins);
  std::vector<std::string> said;
  for (const auto& [solver, count] : wins) said.push_back(fmt::format("{} in {}", solver, count));
  table.text += fmt::format(" The fastest of the {} comparisons: {}.", systems, fmt::join(said, ", "));
  return table;
}

Table raw_table(std::span<const Cell> cells) {
  Table table{"raw",
              "Every repetition",
              "",
              {"analysis", "mechanism", "formulation", "jacobian", "linear_solver", "factored", "repetition", "steps",
               "newton_iterations", "jacobian_evaluations", "factorizations", "solves", "total_s", "assembly_s",
               "factor_s", "solve_s", "other_s"}};
  for (const Cell& cell : cells)
    for (std::size_t r = 0; r < cell.runs.size(); ++r) {
      const Statistics& s = cell.runs[r];
      std::vector<std::string> row{std::string(analysis_name(cell.settings.analysis)), std::string(cell.name),
                                   cell.settings.formulation, cell.settings.jacobian, cell.settings.linear_solver};
      row.push_back(factored(cell));
      row.push_back(std::to_string(r + 1));
      for (const std::int64_t count :
           {s.steps, s.newton_iterations, s.jacobian_evaluations, s.factorizations, s.solves})
        row.push_back(std::to_string(count));
      for (const PhaseSeconds phase : {total, assembly, factor, solve, rest})
        row.push_back(fmt::format("{:.9f}", phase(s)));
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace poinsot::paper
