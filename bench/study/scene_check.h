// Whether a scene is sound: degrees of freedom, constraint rows that follow from others or contradict them, how well
// the state it gives satisfies the constraints, whether a run can start from it, and every analytic derivative against
// a computed one.
//
// With the independent rows satisfied (positions and velocities projected onto them), a dependent row either holds,
// too, or cannot hold together with them: that is a conflict.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/scene.h"
#include "formulations/derivative_check.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"

namespace poinsot::study {

struct Conflict {
  int row;        // of the model
  double by;      // |Φ| or |G v − ν| where the independent rows hold
  bool position;  // of the positions, or of the velocities
};

std::vector<Conflict> find_conflicts(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                                     const RankAnalysis& analysis);

struct SceneCheck {
  struct Wrong {
    std::string formulation;
    DerivativeCheck derivative;
  };

  std::shared_ptr<const Model> model;
  RankAnalysis rank;
  std::vector<Conflict> conflicts;  // by row; where there are any, nothing further is checked
  Violation violation;              // of the state as given
  std::string refusal;              // why no run can start from it; what follows is then unknown
  InitialState start;
  // At the start, or at the state as given where the start fails: derivatives that are not finite are why it does.
  std::size_t derivatives = 0;  // compared, in all formulations
  double derivative_error = 0;  // the largest of those that are right
  std::vector<Wrong> wrong;

  bool consistent() const { return violation.position <= kSatisfied && violation.velocity <= kSatisfied; }
  bool sound() const { return conflicts.empty() && refusal.empty() && start.status.ok() && wrong.empty(); }
};

SceneCheck check_scene(const Scene& scene);

}  // namespace poinsot::study
