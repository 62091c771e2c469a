// Every linear solver of the registry: regular matrices pass, however badly they are scaled or conditioned.
#include "tests/support/linear_solver_suite.h"

namespace poinsot::test {
namespace {

TEST_P(LinearSolvers, PassesBadlyScaledRegularMatrices) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (const BodyKind kind : {BodyKind::six, BodyKind::seven})
      for (const Mechanism& m : {chain(1, 5), chain(8, 5), tree(9, random), ladder(2)})
        for (const bool both : {false, true}) {
          const SampleSystem s = badly_scaled(m, kind, both, random);
          const auto solver = make();
          const LinearStatus status = prepare(*solver, s);
          ASSERT_TRUE(status.ok()) << s.name << ": " << status.message;
          expect_solves(*solver, s, random);
        }
  }
}

// The rigid rods of a chain along y, hinged about x: its condition grows as N⁴ and passes 1e16, its pivots stay good.
SampleSystem straight_chain(int bodies) {
  SampleSystem s;
  s.name = "straight_chain_" + std::to_string(bodies);
  s.pattern.n = 11 * bodies;
  const auto add = [&](int row, int col, int rows, int cols, std::initializer_list<double> by_rows) {
    std::vector<double> g(by_rows), t(g.size());
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < cols; ++c)
        t[static_cast<std::size_t>(c * rows + r)] = g[static_cast<std::size_t>(r * cols + c)];
    s.add({row, col, rows, cols}, t);
    if (row != col) s.add({col, row, cols, rows}, g);
  };
  for (int k = 0; k < bodies; ++k) {
    add(6 * k, 6 * k, 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    add(6 * k + 3, 6 * k + 3, 3, 3, {1. / 12, 0, 0, 0, 1e-3, 0, 0, 0, 1. / 12});
    for (int u = 0; u < 6; ++u) s.pattern.node.push_back(k);
  }
  for (int k = 0; k < bodies; ++k) {
    const int row = 6 * bodies + 5 * k;
    for (const int body : {k - 1, k}) {
      if (body < 0) continue;
      const double sign = body == k ? 1 : -1, y = body == k ? -0.5 : 0.5;  // hinge at ∓½ of the rod
      add(row, 6 * body, 3, 3, {sign, 0, 0, 0, sign, 0, 0, 0, sign});
      add(row, 6 * body + 3, 3, 3, {0, 0, -sign * y, 0, 0, 0, sign * y, 0, 0});  // −ỹ
      add(row + 3, 6 * body + 3, 2, 3, {0, sign, 0, 0, 0, sign});
    }
    for (int u = 0; u < 5; ++u) s.pattern.node.push_back(bodies + k);
  }
  return s;
}

TEST_P(LinearSolvers, PassesALongChain) {
  const SampleSystem s = straight_chain(10000);
  const auto solver = make();
  const LinearStatus status = prepare(*solver, s);
  if (status.failure == LinearFailure::refused) GTEST_SKIP() << status.message;
  ASSERT_TRUE(status.ok()) << status.message;
  // The chain let go from rest: gravity along z.
  std::vector<double> b(static_cast<std::size_t>(s.pattern.n), 0.0);
  for (std::size_t k = 0; k < 10000; ++k) b[6 * k + 2] = -9.81;
  std::vector<double> x = b;
  ASSERT_TRUE(solver->solve(x).ok());
  EXPECT_LE(backward_error(s, Scaled(s), x, b), 1e-13);
}

}  // namespace
}  // namespace poinsot::test
