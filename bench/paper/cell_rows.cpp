#include "bench/paper/cell_rows.h"

#include <fmt/format.h>

namespace poinsot::paper {
using namespace study;

std::string_view analysis_name(Analysis analysis) {
  return analysis == Analysis::kinematics ? "kinematics" : "dynamics";
}

std::string title(Analysis analysis, std::string_view what) {
  return fmt::format("{}: {}", analysis == Analysis::kinematics ? "Kinematics" : "Dynamics", what);
}

std::string file_name(Analysis analysis, std::string_view what) {
  return fmt::format("{}_{}", analysis_name(analysis), what);
}

const PaperMechanism& mechanism_of(const Cell& cell) {
  return *std::ranges::find(kMechanisms, cell.name, &PaperMechanism::file);
}

const Cell* find(std::span<const Cell> cells, Analysis analysis, const PaperMechanism& mechanism,
                 std::string_view formulation, std::string_view jacobian) {
  for (const Cell& cell : cells)
    if (cell.settings.analysis == analysis && cell.name == mechanism.file && cell.settings.formulation == formulation &&
        cell.settings.jacobian == jacobian)
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

std::string number(double value, int decimals) {
  return value > 0 ? fmt::format("{:.{}f}", value, decimals) : kNone;
}

}  // namespace poinsot::paper
