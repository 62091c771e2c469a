#include "integrators/methods/ida_objects.h"

#include "core/check.h"

namespace poinsot {
namespace {

SUNMatrix_ID matrix_id(SUNMatrix) {
  return SUNMATRIX_CUSTOM;
}
int zero_matrix(SUNMatrix) {
  return 0;
}
SUNLinearSolver_Type solver_type(SUNLinearSolver) {
  return SUNLINEARSOLVER_DIRECT;
}
SUNLinearSolver_ID solver_id(SUNLinearSolver) {
  return SUNLINEARSOLVER_CUSTOM;
}
int nothing_to_do(SUNLinearSolver) {
  return SUNLS_SUCCESS;
}
int already_factored(SUNLinearSolver, SUNMatrix) {
  return SUNLS_SUCCESS;
}

}  // namespace

IdaObjects::IdaObjects(int unknowns, void* user, int (*solve)(SUNLinearSolver, SUNMatrix, N_Vector, N_Vector, double)) {
  SUNContext made = nullptr;
  check(SUNContext_Create(nullptr, &made) == 0, "SUNDIALS gives a context");
  context.reset(made);
  y.reset(N_VNew_Serial(unknowns, made));
  y_dot.reset(N_VNew_Serial(unknowns, made));
  inner.reset(N_VNew_Serial(unknowns, made));
  matrix.reset(SUNMatNewEmpty(made));
  linear.reset(SUNLinSolNewEmpty(made));
  ida.reset(IDACreate(made));
  check(y && y_dot && inner && matrix && linear && ida, "SUNDIALS gives its objects");
  matrix->ops->getid = matrix_id;
  matrix->ops->zero = zero_matrix;
  linear->content = user;
  linear->ops->gettype = solver_type;
  linear->ops->getid = solver_id;
  linear->ops->initialize = nothing_to_do;
  linear->ops->setup = already_factored;
  linear->ops->solve = solve;
}

}  // namespace poinsot
