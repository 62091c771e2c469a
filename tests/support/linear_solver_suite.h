// The conformance suite of linear solvers: one fixture over the registry, and how a solution is judged.
#pragma once

#include <gtest/gtest.h>

#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/registry.h"
#include "tests/support/linear_solver_systems.h"

namespace poinsot::test {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();

// analyze, write, factor; the status of the first that fails.
inline LinearStatus prepare(LinearSolver& solver, const SampleSystem& s) {
  if (LinearStatus status = solver.analyze(s.pattern); !status.ok()) return status;
  write(s, solver);
  return solver.factor();
}

class LinearSolvers : public testing::TestWithParam<LinearSolverEntry> {
 protected:
  static std::unique_ptr<LinearSolver> make() { return GetParam().make(); }
};

INSTANTIATE_TEST_SUITE_P(Registry, LinearSolvers, testing::ValuesIn(linear_solvers()),
                         [](const auto& entry) { return std::string(entry.param.name); });

// The factors D_r, D_c in whose norms a badly scaled system is judged.
struct Scaled {
  explicit Scaled(const SampleSystem& s) {
    CscLayout layout;
    EXPECT_TRUE(layout.build(s.pattern).ok());
    std::vector<double> values(static_cast<std::size_t>(layout.nonzeros()), 0.0);
    std::size_t v = 0, c = 0;
    for (const Block& b : s.pattern.blocks)
      for (int j = 0; j < b.cols; ++j, ++c)
        for (int i = 0; i < b.rows; ++i) values[static_cast<std::size_t>(layout.slots[c] + i)] += s.values[v++];
    factors.resize(layout.n);
    EXPECT_TRUE(factors.find(layout, values));
    std::vector<double> sums(static_cast<std::size_t>(layout.n), 0.0);
    EXPECT_TRUE(std::isfinite(factors.scale(layout, values, values)));
    for (std::size_t k = 0; k < values.size(); ++k)
      sums[static_cast<std::size_t>(layout.row[k])] += std::abs(values[k]);
    norm = *std::ranges::max_element(sums);
  }
  template <class T>
  long double of_row(std::span<const T> r) const {
    return largest(r, factors.row(), false);
  }
  template <class T>
  long double of_solution(std::span<const T> x) const {
    return largest(x, factors.col(), true);
  }

  Equilibration factors;
  double norm = 0;  // ‖D_r A D_c‖∞

 private:
  template <class T>
  static long double largest(std::span<const T> v, std::span<const double> d, bool divide) {
    long double m = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto di = static_cast<long double>(d[i]);
      m = std::max(m, std::abs(static_cast<long double>(v[i])) * (divide ? 1 / di : di));
    }
    return m;
  }
};

// ‖D_r (b − A x)‖ / (‖D_r A D_c‖ ‖D_c⁻¹ x‖ + ‖D_r b‖), largest entries.
inline long double backward_error(const SampleSystem& s, const Scaled& scaled, std::span<const double> x,
                                  std::span<const double> b) {
  std::vector<long double> r = s.times(x);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = static_cast<long double>(b[i]) - r[i];
  return scaled.of_row(std::span<const long double>(r)) / (scaled.norm * scaled.of_solution(x) + scaled.of_row(b));
}

// Backward error at rounding level, forward error no more than the condition makes of it.
inline void expect_solved(const SampleSystem& s, std::span<const double> x, std::span<const double> b) {
  const Scaled scaled(s);
  EXPECT_LE(backward_error(s, scaled, x, b), 8 * kEps * s.pattern.n) << s.name;

  // ‖D_c⁻¹ A⁻¹ D_r⁻¹‖ from below: what it makes of a few right-hand sides of size one.
  const Reference reference(s);
  std::mt19937_64 random(1);
  long double inverse_norm = 0;
  for (int k = 0; k < 4; ++k) {
    std::vector<double> sign(b.size());
    for (std::size_t i = 0; i < sign.size(); ++i) sign[i] = (random() & 1 ? 1 : -1) / scaled.factors.row()[i];
    inverse_norm = std::max(
        inverse_norm, scaled.of_solution(std::span<const long double>(reference.solve(std::span<const double>(sign)))));
  }
  const std::vector<long double> exact = reference.solve(b);
  std::vector<long double> error(exact.size());
  for (std::size_t i = 0; i < error.size(); ++i) error[i] = static_cast<long double>(x[i]) - exact[i];
  EXPECT_LE(scaled.of_solution(std::span<const long double>(error)),
            100 * static_cast<long double>(kEps) * scaled.norm * inverse_norm *
                scaled.of_solution(std::span<const long double>(exact)))
      << s.name;
}

inline void expect_solves(LinearSolver& solver, const SampleSystem& s, std::mt19937_64& random) {
  const std::vector<double> b = random_vector(s.pattern.n, random);
  std::vector<double> x = b;
  const LinearStatus status = solver.solve(x);
  ASSERT_TRUE(status.ok()) << s.name << ": " << status.message;
  expect_solved(s, x, b);
}

}  // namespace poinsot::test
