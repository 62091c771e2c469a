#include "bench/paper/paper_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/paper/cell_rows.h"
#include "bench/paper/original_codes.h"
#include "bench/study/range.h"
#include "core/model.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr std::string_view kBaseline = "rp";  // of the paper's speed-ups

std::string printed(const Published* published, double Published::*member, int decimals) {
  return published ? number(published->*member, decimals) : kNone;
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
      {"mechanism", "CD", "DP1", "DP2", "D", "CD (paper)", "DP1 (paper)", "DP2 (paper)", "D (paper)"}};
  for (std::size_t m = 0; m < kMechanisms.size(); ++m) {
    const Model model = compile(scenes[m]);
    std::vector<std::string> row{std::string(kMechanisms[m].title)};
    for (const RowType type : {RowType::CD, RowType::DP1, RowType::DP2, RowType::D})
      row.push_back(std::to_string(
          std::count_if(model.rows.begin(), model.rows.end(), [&](const Row& r) { return r.type == type; })));
    const PublishedCounts& paper = published_counts()[m];
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
              {"mechanism", "formulation"}};
  for (const std::string& jacobian : jacobians) table.header.push_back("ours, " + jacobian);
  table.header.insert(table.header.end(), {"paper C1", "paper C2"});

  std::vector<Range> ours(jacobians.size());
  Range paper;
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const Published* published) {
             for (std::size_t j = 0; j < own.size(); ++j) {
               const double ratio = speed_up(cells, *own[j]);
               row.push_back(number(ratio, 2));
               if (ratio > 0 && own[j]->settings.formulation == kSubject) ours[j].add(ratio);
             }
             if (published && published->formulation == kSubject) {
               paper.add(published->speedup_c1);
               paper.add(published->speedup_c2);
             }
             row.push_back(printed(published, &Published::speedup_c1, 2));
             row.push_back(printed(published, &Published::speedup_c2, 2));
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
              {"mechanism", "formulation"}};
  for (const std::string& jacobian : jacobians) table.header.push_back("ours, " + jacobian);
  table.header.insert(table.header.end(), {kinematics ? "paper C1" : "C1", kinematics ? "paper C2" : "C2"});
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const Published* published) {
             for (const Cell* cell : own) row.push_back(number(iterations_per_step(*cell), 2));
             row.push_back(printed(published, &Published::iterations_c1, 2));
             row.push_back(printed(published, &Published::iterations_c2, 2));
           });
  return table;
}

Table against_original_table(std::span<const Cell> cells, Analysis analysis, std::string_view processor) {
  const OriginalMachine* machine = original_machine(processor);
  const std::vector<std::string> jacobians = jacobians_of(cells);
  Table table{file_name(analysis, "against_original"),
              title(analysis, "speed-up over the faster of the original Python codes"),
              "The Python codes use the simplified matrix, factored once a step. ",
              {"mechanism", "formulation", "Python, us a step"}};
  for (const std::string& jacobian : jacobians) {
    table.header.push_back(fmt::format("{}, us a step", jacobian));
    table.header.push_back(fmt::format("speed-up, {}", jacobian));
  }
  std::vector<Range> ranges(jacobians.size());
  for_rows(table, cells, analysis, jacobians,
           [&](std::vector<std::string>& row, const std::vector<const Cell*>& own, const Published*) {
             const Cell& first = *own.front();
             const OriginalTime* theirs =
                 machine ? machine->find(analysis, first.name, first.settings.formulation) : nullptr;
             const double python = theirs ? theirs->fastest() : 0;
             row.push_back(number(python, 0));
             for (std::size_t j = 0; j < own.size(); ++j) {
               const double us = us_per_step(*own[j], total).median;
               row.push_back(number(us, 3));
               row.push_back(us > 0 ? number(python / us, 0) : kNone);
               if (us > 0 && python > 0) ranges[j].add(python / us);
             }
           });
  if (!machine) {
    std::vector<std::string_view> known;
    for (const OriginalMachine& one : original_machines()) known.push_back(one.processor);
    table.text += fmt::format(
        "Of the processor at hand, {}, there are no times of them, only of {}: times of two processors are not "
        "divided, so there are no ratios.",
        processor, fmt::join(known, " and "));
    return table;
  }
  std::vector<std::string> said;
  for (std::size_t j = 0; j < jacobians.size(); ++j)
    if (!ranges[j].empty()) said.push_back(fmt::format("{} times with the {} matrix", ranges[j].text(0), jacobians[j]));
  if (!said.empty()) table.text += fmt::format("Faster {}. ", fmt::join(said, ", "));
  table.text += fmt::format("Their times were measured on a processor of the same name, {}: {}.", machine->processor,
                            machine->about);
  return table;
}

}  // namespace poinsot::paper
