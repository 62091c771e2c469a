#include "integrators/stepping/linearization.h"

#include "core/check.h"

namespace poinsot {

Linearization::Linearization(const Problem& problem) : nv_(problem.nv()) {
  check(layout_.build(problem.pattern(MatrixKind::exact)).ok(), "an assembled matrix fits 32-bit indices");
  for (std::vector<double>* values : {&M_, &D_, &K_}) values->resize(static_cast<std::size_t>(layout_.nonzeros()));
}

// G is taken from D: the velocity rows' part of it depends on the ratio of the scales, which is 0 there.
void Linearization::assemble(Problem& problem, std::span<const double> a, std::span<const double> lambda) {
  problem.assemble(MatrixKind::exact, {1, 0, 0}, {}, a, lambda, layout_.slots, M_);
  problem.assemble(MatrixKind::exact, {0, 1, 0}, {}, a, lambda, layout_.slots, D_);
  problem.assemble(MatrixKind::exact, {0, 0, 1}, {}, a, lambda, layout_.slots, K_);
}

void Linearization::add_forces(std::span<const double> dv, std::span<const double> dq, std::span<double> out) const {
  visit([&](int i, int j, double, double D, double K) { out[index(i)] += D * dv[index(j)] + K * dq[index(j)]; },
        [](int, int, double) {});
}

}  // namespace poinsot
