#include "integrators/stepping/stabilized_index2.h"

#include <algorithm>

#include "core/check.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {

StabilizedIndex2::StabilizedIndex2(Problem& problem)
    : problem_(problem),
      nv_(problem.nv()),
      nc_(problem.nc()),
      velocity_rows_(velocity_rows(problem)),
      linear_(problem) {
  check(problem.nq() == problem.nv(), "velocities are the rates of the coordinates");
  check(rates_layout_.build(problem.pattern(MatrixKind::rates)).ok(), "an assembled matrix fits 32-bit indices");
  rates_.resize(static_cast<std::size_t>(rates_layout_.nonzeros()));
}

void StabilizedIndex2::start(const State& state, std::span<double> y, std::span<double> y_dot) const {
  std::ranges::fill(y, 0.0);
  std::ranges::fill(y_dot, 0.0);
  std::ranges::copy(state.q, y.begin());
  std::ranges::copy(state.v, y.subspan(nv()).begin());
  std::ranges::copy(state.lambda(), y.subspan(2 * nv()).begin());
  std::ranges::copy(state.v, y_dot.begin());
  std::ranges::copy(state.a(), y_dot.subspan(nv()).begin());
}

void StabilizedIndex2::stand(double t, std::span<const double> y) {
  problem_.set_position(t, q(y));
  problem_.set_velocity(v(y));
}

void StabilizedIndex2::residual(double t, std::span<const double> y, std::span<const double> y_dot,
                                std::span<double> F) {
  stand(t, y);
  problem_.constraint_forces(mu(y), F.first(nv()));
  for (std::size_t k = 0; k < nv(); ++k) F[k] += y_dot[k] - v(y)[k];
  problem_.equations_of_motion(y_dot.subspan(nv(), nv()), lambda(y), F.subspan(nv(), nv()));
  problem_.velocity_residual(F.subspan(2 * nv(), nc()));
  problem_.position_residual(F.last(nc()));
  for (int row : velocity_rows_) F.last(nc())[static_cast<std::size_t>(row)] = mu(y)[static_cast<std::size_t>(row)];
}

template <class Sink>
void StabilizedIndex2::write(double alpha, Sink&& entry) const {
  const int v = nv_, lambda = 2 * nv_, mu = 2 * nv_ + nc_;
  for (int k = 0; k < nv_; ++k) {
    entry(k, k, alpha);
    entry(k, v + k, -1.0);
  }
  linear_.visit(
      [&](int i, int j, double M, double D, double K) {
        entry(v + i, v + j, alpha * M + D);
        entry(v + i, j, K);
      },
      [&](int row, int j, double G) {
        entry(j, mu + row, G);
        entry(v + j, lambda + row, G);
        entry(lambda + row, v + j, G);
        if (!std::ranges::binary_search(velocity_rows_, row)) entry(mu + row, j, G);
      });
  for (int j = 0; j < nv_; ++j) {
    const std::size_t column = static_cast<std::size_t>(j);
    for (int k = rates_layout_.start[column]; k < rates_layout_.start[column + 1]; ++k) {
      entry(lambda + rates_layout_.row[static_cast<std::size_t>(k)], j, rates_[static_cast<std::size_t>(k)]);
    }
  }
  for (int row : velocity_rows_) entry(mu + row, mu + row, 1.0);
}

Pattern StabilizedIndex2::pattern() {
  const std::vector<int> node = problem_.pattern(MatrixKind::consistent).node;
  Pattern pattern;
  pattern.n = size();
  for (int k : unknowns()) pattern.node.push_back(node[static_cast<std::size_t>(k)]);
  write(1, EntryRecorder{pattern.blocks});
  return pattern;
}

std::vector<int> StabilizedIndex2::unknowns() const {
  std::vector<int> of;
  for (int k = 0; k < 2 * nv_; ++k) of.push_back(k % nv_);
  for (int k = 0; k < 2 * nc_; ++k) of.push_back(nv_ + k % nc_);
  return of;
}

void StabilizedIndex2::assemble(double t, double alpha, std::span<const double> y, std::span<const double> y_dot,
                                std::span<const int> slots, std::span<double> values) {
  stand(t, y);
  linear_.assemble(problem_, y_dot.subspan(nv(), nv()), lambda(y));
  problem_.assemble(MatrixKind::rates, {}, {}, {}, {}, rates_layout_.slots, rates_);
  write(alpha, EntryWriter(slots, values));
}

}  // namespace poinsot
