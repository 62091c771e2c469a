#include "bench/paper/paper_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/paper/cell_rows.h"
#include "bench/study/range.h"
#include "core/model.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr std::string_view kBaseline = "rp";  // of the paper's speed-ups

std::string printed(const PaperFigures* figures, double PaperFigures::*member, int decimals) {
  return figures ? figure(figures->*member, decimals) : kNone;
}

double speed_up(std::span<const Cell> cells, const Cell& cell) {
  const Cell* baseline = find(cells, cell.settings.analysis, mechanism_of(cell), kBaseline, cell.settings.jacobian);
  if (!baseline || baseline->runs.empty() || cell.runs.empty()) return 0;
  return us_per_step(*baseline, total).median / us_per_step(cell, total).median;
}

}  // namespace

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

}  // namespace poinsot::paper
