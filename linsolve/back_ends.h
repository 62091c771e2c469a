// The makers of the linear solvers that stand in the registry, one file each.
#pragma once

#include <memory>

#include "linsolve/linear_solver.h"

namespace poinsot {

std::unique_ptr<LinearSolver> make_auto();
std::unique_ptr<LinearSolver> make_block();
std::unique_ptr<LinearSolver> make_dense();
std::unique_ptr<LinearSolver> make_eigen_sparselu();
std::unique_ptr<LinearSolver> make_klu();
std::unique_ptr<LinearSolver> make_umfpack();  // only with POINSOT_UMFPACK

}  // namespace poinsot
