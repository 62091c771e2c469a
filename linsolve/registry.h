// The linear solvers there are. Help texts, error messages, the conformance suite and benchmarks are made from this
// table.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "linsolve/linear_solver.h"

namespace poinsot {

struct LinearSolverEntry {
  std::string_view name;
  std::string_view about;  // one line: what it is, what it is good for, what it needs or refuses
  std::unique_ptr<LinearSolver> (*make)();
};

std::span<const LinearSolverEntry> linear_solvers();
// nullptr where no entry has the name.
const LinearSolverEntry* find_linear_solver(std::string_view name);

}  // namespace poinsot
