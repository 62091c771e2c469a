// Rows of a model alone, on the bodies they act on: those that are set aside. Time grows with these rows, not with the
// mechanism. In rA, whose residuals need no sines; Φ does not depend on the formulation.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "formulations/problem.h"

namespace poinsot {

// Of `aside` those that no row of `kept` says word for word, as a joint does that is there twice: what holds there
// holds here to the last bit. Rows of the model, ascending.
std::vector<int> not_said_twice(const Model& model, const std::vector<int>& aside, const std::vector<int>& kept);

class RowsAside {
 public:
  // `rows` of the model, ascending.
  RowsAside(const Model& model, std::vector<int> rows);

  const std::vector<int>& rows() const { return rows_; }
  // By row, where the model's bodies stand in a problem of theirs; the rate where Φ was asked for last.
  std::span<const double> position_residual(double t, const Problem& of_model);
  std::span<const double> velocity_residual(std::span<const BodyState> of_model);

 private:
  std::vector<int> rows_, body_;  // of the model
  std::unique_ptr<Problem> problem_;
  std::vector<double> q_, v_, residual_;
};

}  // namespace poinsot
