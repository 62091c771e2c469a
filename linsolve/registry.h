// The linear solvers there are. Help texts, error messages, the conformance suite and benchmarks are made from this
// table.
#pragma once

#include <memory>
#include <string_view>

#include "core/registry.h"
#include "linsolve/linear_solver.h"

namespace poinsot {

struct LinearSolverEntry {
  std::string_view name;
  std::string_view about;  // one line: what it is, what it is good for, what it needs or refuses
  std::unique_ptr<LinearSolver> (*make)();
};

Registry<LinearSolverEntry>& linear_solvers();

}  // namespace poinsot
