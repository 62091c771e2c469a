// The linear solvers there are, and what they may be given. Help texts, error messages, the conformance suite and
// benchmarks are made from this table.
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
  bool takes_jacobian = false;  // a constraint Jacobian alone: matrices of any structure, and their transpose
};

Registry<LinearSolverEntry>& linear_solvers();

// Which matrix the linear solver gets (linsolve/linear_system.h).
struct LinearSystemEntry {
  std::string_view name;
  std::string_view about;
  bool square_jacobian;  // G alone where it is square
};

Registry<LinearSystemEntry>& linear_systems();

}  // namespace poinsot
