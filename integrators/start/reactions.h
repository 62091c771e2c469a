// Multipliers and joint reactions of a sample, by the scene's names, also where dependent rows leave them undetermined.
//
//   std::optional<Reactions> reactions;               // outside the observer
//   if (!reactions) reactions.emplace(sample.problem);
//   reactions->update(sample);
//   reactions->of_group(group, force, moment);        // of sample.problem.model().groups: constraints, joints, drivers
//
// Where rows were set aside, every λ with Gᵀλ equal to the computed generalized reaction is right; given is the one of
// least norm over all rows, by a complete orthogonal decomposition of Gᵀ.
#pragma once

#include <memory>
#include <vector>

#include "integrators/integrator.h"

namespace poinsot {

class Reactions {
 public:
  explicit Reactions(const Problem& problem);

  void update(const Sample& sample);
  double lambda(int model_row) const { return lambda_[static_cast<std::size_t>(model_row)]; }
  // Force (N, global) and moment about the group's point (N m, global) on body j.
  void of_group(int group, Vector3& force, Vector3& moment) const;

 private:
  std::unique_ptr<Problem> whole_;  // with the rows that were set aside; null where there are none
  std::vector<double> q_, v_;       // where it stands
  const Problem* problem_ = nullptr;
  std::vector<double> lambda_;
};

}  // namespace poinsot
