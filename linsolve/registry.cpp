#include "linsolve/registry.h"

#include "linsolve/back_ends.h"

namespace poinsot {
namespace {

constexpr LinearSolverEntry kEntries[] = {
    {"auto", "picks the fastest of those below by size and structure, as measured, and says which", make_auto, true},
    {"klu", "sparse LU that keeps its pivots while they stay good (SuiteSparse KLU); for systems of every size",
     make_klu, true},
    {"block",
     "elimination over the graph of bodies and constraints, order chosen once; for saddle points of every size, leaves "
     "kinematics matrices, and what it cannot solve well, to klu",
     make_block},
    {"dense",
     "LU with partial pivoting of the full matrix, kernels of fixed size for one or two bodies; refuses more than 2000 "
     "unknowns",
     make_dense, true},
    {"eigen_sparselu", "supernodal sparse LU of Eigen with fresh pivots every time; a reference without SuiteSparse",
     make_eigen_sparselu, true},
#ifdef POINSOT_UMFPACK
    {"umfpack", "multifrontal sparse LU with fresh pivots every time (SuiteSparse UMFPACK, GPL); a reference",
     make_umfpack, true},
#endif
};

constexpr LinearSystemEntry kSystems[] = {
    {"auto", "G alone where it is square and carries everything (no degrees of freedom), else the whole matrix", true},
    {"whole", "always the whole matrix; to compare", false},
};

}  // namespace

Registry<LinearSolverEntry>& linear_solvers() {
  static Registry<LinearSolverEntry> table("linear_solver", kEntries);
  return table;
}

Registry<LinearSystemEntry>& linear_systems() {
  static Registry<LinearSystemEntry> table("linear_system", kSystems);
  return table;
}

}  // namespace poinsot
