#include "app/paper_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "app/range.h"
#include "core/model.h"
#include "formulations/registry.h"

namespace poinsot::app {
namespace {

constexpr std::string_view kBaseline = "rp";  // of the paper's speed-ups
constexpr std::string_view kSubject = "rA";   // the formulation the paper proposes
constexpr const char* kNone = "-";

const Cell* find(std::span<const Cell> cells, Analysis analysis, const Mechanism& mechanism,
                 std::string_view formulation, std::string_view jacobian) {
  for (const Cell& cell : cells)
    if (cell.settings.analysis == analysis && cell.mechanism == &mechanism &&
        cell.settings.formulation == formulation && cell.settings.jacobian == jacobian)
      return &cell;
  return nullptr;
}

std::vector<std::string> jacobians_of(std::span<const Cell> cells) {
  std::vector<std::string> names;
  for (const Cell& cell : cells)
    if (std::find(names.begin(), names.end(), cell.settings.jacobian) == names.end())
      names.push_back(cell.settings.jacobian);
  return names;
}

std::string figure(double value, int decimals) {
  return value > 0 ? fmt::format("{:.{}f}", value, decimals) : kNone;
}

std::string printed(const PaperFigures* figures, double PaperFigures::*member, int decimals) {
  return figures ? figure(figures->*member, decimals) : kNone;
}

double speed_up(std::span<const Cell> cells, const Cell& cell) {
  const Cell* baseline = find(cells, cell.settings.analysis, *cell.mechanism, kBaseline, cell.settings.jacobian);
  if (!baseline || baseline->runs.empty() || cell.runs.empty()) return 0;
  return us_per_step(*baseline, total).median / us_per_step(cell, total).median;
}

// Which linear solver needs the least time, for how many of the systems (mechanism, formulation, jacobian); returns the
// number of systems.
int count_fastest(std::span<const Cell> cells, std::map<std::string, int>& wins) {
  using System = std::tuple<std::string_view, std::string, std::string>;
  std::map<System, const Cell*> fastest;
  for (const Cell& cell : cells) {
    if (cell.runs.empty()) continue;
    const Cell*& best = fastest[{cell.mechanism->file, cell.settings.formulation, cell.settings.jacobian}];
    if (!best || us_per_step(cell, total).median < us_per_step(*best, total).median) best = &cell;
  }
  for (const auto& [system, cell] : fastest) ++wins[cell->settings.linear_solver];
  return static_cast<int>(fastest.size());
}

// One row for every mechanism and formulation that has cells; `fill` adds the columns after the first two.
template <class Fill>
void for_rows(Table& table, std::span<const Cell> cells, Analysis analysis, const std::vector<std::string>& jacobians,
              Fill&& fill) {
  for (const Mechanism& mechanism : kMechanisms) {
    if (analysis == Analysis::kinematics && !mechanism.driven) continue;
    for (const FormulationEntry& formulation : formulations()) {
      std::vector<std::string> row{std::string(mechanism.title), std::string(formulation.name)};
      std::vector<const Cell*> own;
      for (const std::string& jacobian : jacobians)
        own.push_back(find(cells, analysis, mechanism, formulation.name, jacobian));
      if (std::count(own.begin(), own.end(), nullptr) > 0) continue;
      fill(row, own, find_paper_figures(analysis, mechanism.file, formulation.name));
      table.rows.push_back(std::move(row));
    }
  }
}

std::string title(Analysis analysis, std::string_view what) {
  return fmt::format("{}: {}", analysis == Analysis::kinematics ? "Kinematics" : "Dynamics", what);
}

std::string file_name(Analysis analysis, std::string_view what) {
  return fmt::format("{}_{}", analysis_name(analysis), what);
}

}  // namespace

std::string_view analysis_name(Analysis analysis) {
  return analysis == Analysis::kinematics ? "kinematics" : "dynamics";
}

Table constraint_counts(std::span<const Scene> scenes) {
  Table table{
      "constraint_counts",
      "Constraints of the mechanisms",
      "Ours are counted in the compiled models; the paper's table leaves the double pendulum out, its counts are "
      "those of the original codes' model file.",
      {"mechanism", "CD", "DP1", "DP2", "D", "CD (paper)", "DP1 (paper)", "DP2 (paper)", "D (paper)"},
      {}};
  for (std::size_t m = 0; m < kMechanisms.size(); ++m) {
    const Model model = compile(scenes[m]);
    std::vector<std::string> row{std::string(kMechanisms[m].title)};
    for (const RowType type : {RowType::CD, RowType::DP1, RowType::DP2, RowType::D})
      row.push_back(std::to_string(
          std::count_if(model.rows.begin(), model.rows.end(), [&](const Row& r) { return r.type == type; })));
    const PaperCounts& paper = paper_counts()[m];
    for (const int count : {paper.cd, paper.dp1, paper.dp2, paper.d}) row.push_back(std::to_string(count));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table speed_up_table(std::span<const Cell> cells, Analysis analysis) {
  const std::vector<std::string> jacobians = jacobians_of(cells);
  Table table{file_name(analysis, "speed_up"),
              title(analysis, fmt::format("speed-up relative to {}", kBaseline)),
              "",
              {"mechanism", "formulation"},
              {}};
  for (const std::string& jacobian : jacobians) table.header.push_back("ours, " + jacobian);
  table.header.insert(table.header.end(), {"paper C1", "paper C2"});

  std::vector<Range> ours(jacobians.size());
  Range paper;
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const PaperFigures* figures) {
             for (std::size_t j = 0; j < own.size(); ++j) {
               const double ratio = speed_up(cells, *own[j]);
               row.push_back(figure(ratio, 2));
               if (ratio > 0 && own[j]->settings.formulation == kSubject) ours[j].add(ratio);
             }
             if (figures && figures->formulation == kSubject) {
               paper.add(figures->speedup_c1);
               paper.add(figures->speedup_c2);
             }
             row.push_back(printed(figures, &PaperFigures::speedup_c1, 2));
             row.push_back(printed(figures, &PaperFigures::speedup_c2, 2));
           });
  std::vector<std::string> said;
  for (std::size_t j = 0; j < jacobians.size(); ++j)
    if (!ours[j].empty()) said.push_back(fmt::format("{} with the {} matrix", ours[j].text(2), jacobians[j]));
  if (!said.empty())
    table.text = fmt::format("{} against {}: {} here; {} in the paper.", kSubject, kBaseline, fmt::join(said, ", "),
                             paper.text(2));
  return table;
}

Table iterations_table(std::span<const Cell> cells, Analysis analysis) {
  const std::vector<std::string> jacobians = jacobians_of(cells);
  const bool kinematics = analysis == Analysis::kinematics;
  Table table{file_name(analysis, "iterations"),
              title(analysis, "iterations to convergence, average over the steps"),
              kinematics
                  ? "Of the position analysis. C1 and C2 are the paper's figures."
                  : "The paper prints no such table for dynamics; C1 and C2 are measured on its codes over 1 s, C2 "
                    "held to order 1.",
              {"mechanism", "formulation"},
              {}};
  for (const std::string& jacobian : jacobians) table.header.push_back("ours, " + jacobian);
  table.header.insert(table.header.end(), {kinematics ? "paper C1" : "C1", kinematics ? "paper C2" : "C2"});
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const PaperFigures* figures) {
             for (const Cell* cell : own) row.push_back(figure(iterations_per_step(*cell), 2));
             row.push_back(printed(figures, &PaperFigures::iterations_c1, 2));
             row.push_back(printed(figures, &PaperFigures::iterations_c2, 2));
           });
  return table;
}

Table phases_table(std::span<const Cell> cells, Analysis analysis) {
  Table table{file_name(analysis, "phases"),
              title(analysis, "time of a step by phase, microseconds"),
              "",
              {"mechanism", "formulation", "jacobian", "total", "spread, %", "assembly", "factorization", "solves",
               "the rest", "iterations", "factorizations"},
              {}};
  Range linear_algebra;
  for (const std::string& jacobian : jacobians_of(cells))
    for_rows(
        table, cells, analysis, {jacobian},
        [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const PaperFigures*) {
          const Cell& cell = *own[0];
          const Timing whole = us_per_step(cell, total);
          row.push_back(jacobian);
          row.push_back(figure(whole.median, 3));
          row.push_back(figure(100 * whole.spread, 1));
          for (const Phase phase : {assembly, factor, solve, rest})
            row.push_back(figure(us_per_step(cell, phase).median, 3));
          row.push_back(figure(iterations_per_step(cell), 2));
          if (cell.runs.empty()) return row.push_back(kNone);
          const Statistics& s = cell.runs[0];
          row.push_back(figure(static_cast<double>(s.factorizations) / static_cast<double>(s.steps), 2));
          linear_algebra.add(100 * (us_per_step(cell, factor).median + us_per_step(cell, solve).median) / whole.median);
        });
  table.text = "Medians; the spread is the distance of the quartiles of the total.";
  if (!linear_algebra.empty())
    table.text += fmt::format(" Factorization and solves together take {} % of a step; 1 to 4 % in the original codes.",
                              linear_algebra.text(0));
  return table;
}

Table advantage_table(std::span<const Cell> cells, Analysis analysis) {
  constexpr std::pair<std::string_view, Phase> phases[] = {
      {"assembly", assembly}, {"factorization", factor}, {"solves", solve}, {"the rest", rest}};
  Table table{file_name(analysis, "advantage"),
              title(analysis, fmt::format("where the time goes that {} saves", kSubject)),
              "",
              {"mechanism", "formulation", "jacobian", fmt::format("slower than {} by, us", kSubject)},
              {}};
  for (const auto& [name, phase] : phases) table.header.push_back(fmt::format("{}, us", name));

  double saved[std::size(phases)] = {};
  int faster = 0, compared = 0;
  for (const std::string& jacobian : jacobians_of(cells)) {
    Table part;
    for_rows(part, cells, analysis, {jacobian},
             [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const PaperFigures*) {
               const Cell& cell = *own[0];
               const Cell* subject = find(cells, analysis, *cell.mechanism, kSubject, jacobian);
               const bool missing = !subject || subject->runs.empty() || cell.runs.empty();
               row.push_back(jacobian);
               const auto difference = [&](Phase phase) {
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

Table against_original_table(std::span<const Cell> cells, Analysis analysis) {
  const std::vector<std::string> jacobians = jacobians_of(cells);
  Table table{file_name(analysis, "against_original"),
              title(analysis, "speed-up over the faster of the original Python codes"),
              "",
              {"mechanism", "formulation", "Python, us a step"},
              {}};
  for (const std::string& jacobian : jacobians) {
    table.header.push_back(fmt::format("{}, us a step", jacobian));
    table.header.push_back(fmt::format("speed-up, {}", jacobian));
  }
  std::vector<Range> ranges(jacobians.size());
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const PaperFigures* figures) {
             const double python = figures ? figures->fastest_us() : 0;
             row.push_back(figure(python, 0));
             for (std::size_t j = 0; j < own.size(); ++j) {
               const double us = us_per_step(*own[j], total).median;
               row.push_back(figure(us, 3));
               row.push_back(us > 0 ? figure(python / us, 0) : kNone);
               if (us > 0 && python > 0) ranges[j].add(python / us);
             }
           });
  std::vector<std::string> said;
  for (std::size_t j = 0; j < jacobians.size(); ++j)
    if (!ranges[j].empty()) said.push_back(fmt::format("{} times with the {} matrix", ranges[j].text(0), jacobians[j]));
  table.text = fmt::format(
      "{}. The Python codes use the simplified matrix, factored once a step; they were measured elsewhere: {}. "
      "Machines "
      "differ, so these ratios say an order of magnitude.",
      said.empty() ? "No figures" : fmt::format("Faster {}", fmt::join(said, ", ")), kOriginalMachine);
  return table;
}

Table linear_solvers_table(std::span<const Cell> cells) {
  Table table{
      "linear_solvers",
      "Dynamics: all linear solvers, time of a step by phase, microseconds",
      "Medians; the spread is the distance of the quartiles of the total. Refused: the solver does not take such "
      "matrices.",
      {"mechanism", "formulation", "jacobian", "linear solver", "total", "spread, %", "assembly", "factorization",
       "solves", "the rest"},
      {}};
  for (const Cell& cell : cells) {
    std::vector<std::string> row{std::string(cell.mechanism->title), cell.settings.formulation, cell.settings.jacobian,
                                 cell.settings.linear_solver};
    if (cell.refused) {
      row.push_back("refused");
      row.resize(table.header.size());
      table.rows.push_back(std::move(row));
      continue;
    }
    const Timing whole = us_per_step(cell, total);
    row.insert(row.end(), {figure(whole.median, 3), figure(100 * whole.spread, 1)});
    for (const Phase phase : {assembly, factor, solve, rest}) row.push_back(figure(us_per_step(cell, phase).median, 3));
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
  Table table{
      "raw",
      "Every repetition",
      "",
      {"analysis", "mechanism", "formulation", "jacobian", "linear_solver", "repetition", "steps", "newton_iterations",
       "jacobian_evaluations", "factorizations", "solves", "total_s", "assembly_s", "factor_s", "solve_s", "other_s"},
      {}};
  for (const Cell& cell : cells)
    for (std::size_t r = 0; r < cell.runs.size(); ++r) {
      const Statistics& s = cell.runs[r];
      std::vector<std::string> row{std::string(analysis_name(cell.settings.analysis)),
                                   std::string(cell.mechanism->file), cell.settings.formulation, cell.settings.jacobian,
                                   cell.settings.linear_solver};
      row.push_back(std::to_string(r + 1));
      for (const std::int64_t count :
           {s.steps, s.newton_iterations, s.jacobian_evaluations, s.factorizations, s.solves})
        row.push_back(std::to_string(count));
      for (const Phase phase : {total, assembly, factor, solve, rest}) row.push_back(fmt::format("{:.9f}", phase(s)));
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace poinsot::app
