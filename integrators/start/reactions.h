// Multipliers and joint reactions of a sample, by the scene's names, also where redundant rows leave them undetermined.
//
//   std::optional<Reactions> reactions;               // outside the observer
//   if (!reactions) reactions.emplace(sample.problem);
//   reactions->update(sample);
//   reactions->of_group(group, force, moment);        // of sample.problem.model().groups: constraints, joints, drivers
//
// Where rows were set aside, every λ with Gᵀλ equal to the computed generalized reaction is right. They differ by null
// vectors of Gᵀ, one for each row set aside (row_choice.h); with these as the columns of N, given is the least one,
//
//   λ − N (NᵀN)⁻¹ Nᵀ λ
//
// Where no null vector loads a joint its reaction is the only one (integrators/start/undetermined.h). The cost grows
// linearly with the mechanism for a given number of redundant rows in a loop; of loops that hang together with more
// than BlockChoice::kMostNull of them the reactions of the rows kept are given, and so where a null vector would leave
// a body out of balance: given are reactions in balance, and least() says whether they are the least.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/start/row_choice.h"
#include "integrators/start/undetermined.h"

namespace poinsot {

class Reactions {
 public:
  // The problem stands at a sample.
  explicit Reactions(const Problem& problem);

  void update(const Sample& sample);
  double lambda(int model_row) const { return lambda_[static_cast<std::size_t>(model_row)]; }
  // Of all that are in balance, those given.
  bool least() const { return least_; }
  // Of the sample: the groups that have other reactions, too, which are as right. Where too many loops hang together,
  // all that are in a loop.
  std::vector<Undetermined> undetermined() const;
  // Of any sample: the groups, ascending, that are in a loop with redundant rows.
  std::vector<int> may_be_undetermined() const;
  // Force (N, global) and moment about the group's point (N m, global) on body j.
  void of_group(int group, Vector3& force, Vector3& moment) const;

 private:
  void make_least();

  std::unique_ptr<Problem> whole_;           // with the rows that were set aside; null where there are none
  std::optional<RowChoice> choice_;          // of the rows the problem keeps
  int revision_ = 0;                         // of these
  std::vector<SparseEntries> null_vectors_;  // at the sample
  std::vector<double> q_, v_;                // where it stands
  std::vector<BodyState> states_;
  const Problem* problem_ = nullptr;
  bool least_ = true;
  std::vector<double> lambda_;
};

}  // namespace poinsot
