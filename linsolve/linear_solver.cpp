#include "linsolve/linear_solver.h"

#include <new>
#include <utility>

#include "core/check.h"
#include "core/index.h"
#include "linsolve/finite.h"

namespace poinsot {
namespace {

// Libraries and containers say in many ways that there is no memory left; a caller sees one.
template <class Work>
LinearStatus guarded(Work&& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return {LinearFailure::out_of_memory, -1, "not enough memory for the linear solver"};
  }
}

bool fits(const Pattern& pattern) {
  if (pattern.n < 1 || pattern.node.size() != index(pattern.n)) return false;
  for (const Block& b : pattern.blocks)
    if (b.rows < 1 || b.cols < 1 || b.row < 0 || b.col < 0 || b.row > pattern.n - b.rows || b.col > pattern.n - b.cols)
      return false;
  for (const int node : pattern.node)
    if (node < 0) return false;
  return true;
}

}  // namespace

LinearStatus LinearSolver::analyze(Pattern pattern, Workload workload) {
  check(fits(pattern), "every block of a pattern lies in its matrix, and every unknown has a node");
  state_ = State::empty;
  n_ = pattern.n;
  workload_ = workload;
  ++statistics_.analyses;
  LinearStatus status = guarded([&] { return do_analyze(std::move(pattern)); });
  if (status.ok()) state_ = State::analyzed;
  return status;
}

LinearStatus LinearSolver::factor(Ahead ahead) {
  const std::span<const double> b = ahead.b;
  check(state_ != State::empty, "LinearSolver::factor comes after analyze");
  check(b.empty() || b.size() == index(n_), "LinearSolver::factor gets one number for each unknown, or none");
  state_ = State::analyzed;
  next_ = b.data();
  LinearStatus status = guarded([&] { return b.empty() ? do_factor() : do_factor_for(ahead); });
  if (status.ok()) state_ = State::factored;
  return status;
}

LinearStatus LinearSolver::solve(std::span<double> b) {
  return solved(b, [&] { return do_solve(b); });
}

LinearStatus LinearSolver::solve_transposed(std::span<double> b) {
  return solved(b, [&] { return do_solve_transposed(b); });
}

LinearStatus LinearSolver::do_solve_transposed(std::span<double>) {
  return {LinearFailure::refused, -1, "this linear solver does not solve with the transposed matrix"};
}

template <class Work>
LinearStatus LinearSolver::solved(std::span<double> b, Work&& work) {
  check(state_ == State::factored, "LinearSolver::solve comes after a factor that was ok");
  check(b.size() == index(n_), "LinearSolver::solve gets one number for each unknown");
  check(next_ == nullptr || next_ == b.data(), "LinearSolver::solve gets the right-hand side that factor was given");
  next_ = nullptr;
  ++statistics_.solves;
  LinearStatus status = guarded(work);
  if (status.ok() && picked().empty() && !all_finite(b))  // a pick has looked itself
    status = {LinearFailure::not_finite, -1, "the solution of the linear system is not finite"};
  if (!status.ok()) state_ = State::analyzed;
  return status;
}

}  // namespace poinsot
