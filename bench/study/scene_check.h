// Whether a scene is sound: degrees of freedom, constraint rows that follow from others or contradict them, how well
// the state it gives satisfies the constraints, whether a run can start from it, and every analytic derivative against
// a computed one.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "formulations/derivative_check.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"

namespace poinsot::study {

struct SceneCheck {
  struct Wrong {
    std::string formulation;
    DerivativeCheck derivative;
  };

  std::shared_ptr<const Model> model;
  std::vector<std::string> notices;  // of reading the scene, and what nobody would mean
  double mass = 0;                   // kg, of all bodies
  Vector3 extent = Vector3::Zero();  // m, of the box around centres of mass and the points that constraints hold
  RankAnalysis rank;                 // where rows conflict, nothing further is checked
  Violation violation;               // of the state as given
  std::string refusal;               // why no run can start from it; what follows is then unknown
  InitialState start;
  // At the start, or at the state as given where the start fails: derivatives that are not finite are why it does.
  std::size_t derivatives = 0;  // compared, in all formulations
  double derivative_error = 0;  // the largest of those that are right
  std::vector<Wrong> wrong;

  bool consistent() const { return violation.position <= kSatisfied && violation.velocity <= kSatisfied; }
  bool sound() const { return rank.conflicts.empty() && refusal.empty() && start.status.ok() && wrong.empty(); }
};

SceneCheck check_scene(const Scene& scene);

// Where rank is looked at: the given pose where it satisfies the constraints, else where it closes, if it does. Off
// them rows that follow from others look independent.
std::vector<BodyState> pose_meant(const std::shared_ptr<const Model>& model);

// No degree of freedom is left and all constraints are of positions: kinematics computes the motion, too.
bool without_freedom(const Scene& scene);

// "turning about its axis": what a joint alone leaves of the motion between its bodies.
std::string_view left_free(const Group& joint);

}  // namespace poinsot::study
