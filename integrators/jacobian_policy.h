// Which matrix Newton's method iterates with, and when it is made anew: the configuration's key "jacobian".
#pragma once

#include <string_view>

#include "core/registry.h"
#include "formulations/problem.h"
#include "linsolve/linear_solver.h"

namespace poinsot {

enum class Refresh {
  every_iteration,
  every_step,   // once, at the first iterate of the step
  before_step,  // once, where the last step ended; integrators that say nothing else do as for every_step
  when_slow,    // kept over iterations and steps until corrections shrink too slowly
};

struct JacobianEntry {
  std::string_view name;
  std::string_view about;
  MatrixKind matrix;  // of dynamics; in kinematics the matrix is always G
  Refresh refresh;

  Workload workload() const { return refresh == Refresh::when_slow ? Workload::solves : Workload::factorizations; }
};

// Whether the matrix is made anew in iteration k of a step. `worn`: one kept from before serves no more, or there is
// none.
bool due(Refresh refresh, int k, bool worn);

Registry<JacobianEntry>& jacobians();

}  // namespace poinsot
