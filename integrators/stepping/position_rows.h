// The constraints of positions by themselves: a problem without its velocity rows (pfaffian), and what puts positions
// onto them.
//
//   M δq + G_Φᵀμ = 0,   G_Φ δq = −Φ
//
// Velocity rows leave positions as they are. That they be moved along these, Ψ δq = 0, is as good as any other choice
// elsewhere; where velocity rows come to depend on one another, or on the others, it would lead afar.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/all_but.h"
#include "core/index.h"
#include "formulations/problem.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {

class PositionRows {
 public:
  explicit PositionRows(const Problem& of)
      : revision_(of.revision()), rows_(of.clone_without(others(of))), consistent_(*rows_, LinearChoice{}) {}

  // Of the rows as they are chosen now.
  bool are_those_of(const Problem& problem) const { return revision_ == problem.revision(); }
  // Consistent's, beside the run.
  Status project_position(double t, std::span<double> q, std::span<double> moved) {
    return consistent_.project_position(t, q, moved);
  }

 private:
  static std::vector<int> others(const Problem& problem) {
    const std::vector<Row>& rows = problem.model().rows;
    std::vector<int> of_positions;
    for (const int k : problem.model_rows())
      if (rows[index(k)].type != RowType::pfaffian) of_positions.push_back(k);
    return all_but(rows.size(), of_positions);
  }

  int revision_;
  std::unique_ptr<Problem> rows_;
  Consistent consistent_;
};

}  // namespace poinsot
