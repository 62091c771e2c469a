// The rows that constrain velocities only (pfaffian), in the problem's numbering.
#pragma once

#include <vector>

#include "formulations/problem.h"

namespace poinsot {

inline std::vector<int> velocity_rows(const Problem& problem) {
  std::vector<int> rows;
  const std::vector<int>& model_rows = problem.model_rows();
  for (std::size_t k = 0; k < model_rows.size(); ++k) {
    if (problem.model().rows[static_cast<std::size_t>(model_rows[k])].type == RowType::pfaffian) {
      rows.push_back(static_cast<int>(k));
    }
  }
  return rows;
}

}  // namespace poinsot
