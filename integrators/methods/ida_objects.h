// What SUNDIALS wants made for a run of IDA: its context, vectors, memory, and the shells of a matrix and of a linear
// solver. The shells are empty: the matrix is written and factored when IDA wants a new one, so that all it asks them
// for is to solve.
#pragma once

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <memory>
#include <span>
#include <type_traits>

namespace poinsot {

template <class T, void (*release)(T)>
struct Release {
  void operator()(T x) const { release(x); }
};
template <class T, void (*release)(T)>
using Owned = std::unique_ptr<std::remove_pointer_t<T>, Release<T, release>>;

inline void free_context(SUNContext context) {
  SUNContext_Free(&context);
}
inline void free_ida(void* ida) {
  IDAFree(&ida);
}

struct IdaObjects {
  using Vector = Owned<N_Vector, N_VDestroy>;

  // For so many unknowns; `solve` is the linear solver's and finds `user` in its content.
  IdaObjects(int unknowns, void* user, int (*solve)(SUNLinearSolver, SUNMatrix, N_Vector, N_Vector, double));

  static std::span<double> values(N_Vector x) {
    return {N_VGetArrayPointer(x), static_cast<std::size_t>(N_VGetLength(x))};
  }

  Owned<SUNContext, free_context> context;
  Vector y, y_dot, inner;  // inner: within the last step
  Owned<SUNMatrix, SUNMatFreeEmpty> matrix;
  Owned<SUNLinearSolver, SUNLinSolFreeEmpty> linear;
  std::unique_ptr<void, Release<void*, free_ida>> ida;
};

}  // namespace poinsot
