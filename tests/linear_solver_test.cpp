// One conformance suite for every linear solver of the registry.
#include "linsolve/linear_solver.h"

#include <gtest/gtest.h>

#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/registry.h"
#include "linsolve_systems.h"

namespace poinsot::test {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

LinearStatus prepare(LinearSolver& solver, const LinearSystem& s);

// Some solvers take symmetric systems only; they refuse the others, and are tested with the symmetric parts of bodies.
class LinearSolvers : public testing::TestWithParam<LinearSolverEntry> {
 protected:
  LinearSolvers() {
    std::mt19937_64 random(1);
    const LinearStatus status = prepare(*make(), saddle_point(chain(2, 5), BodyKind::six, random));
    symmetric_only_ = status.failure == LinearFailure::refused;
    EXPECT_EQ(status.message.empty(), !symmetric_only_);
  }
  static std::unique_ptr<LinearSolver> make() { return GetParam().make(); }
  bool symmetric_only() const { return symmetric_only_; }

  LinearSystem suited(LinearSystem s) const {
    for (std::size_t m = 0; symmetric_only_ && m < s.pattern.blocks.size(); ++m) {
      const Block& b = s.pattern.blocks[m];
      const auto n = static_cast<std::size_t>(b.rows);
      if (b.row != b.col || b.rows != b.cols) continue;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j)
          s.block(m)[j * n + i] = s.block(m)[i * n + j] = 0.5 * (s.block(m)[j * n + i] + s.block(m)[i * n + j]);
    }
    return s;
  }

 private:
  bool symmetric_only_ = false;
};

INSTANTIATE_TEST_SUITE_P(Registry, LinearSolvers, testing::ValuesIn(linear_solvers()),
                         [](const auto& entry) { return std::string(entry.param.name); });

std::vector<double> random_vector(int n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> b(static_cast<std::size_t>(n));
  for (double& x : b) x = normal(random);
  return b;
}

// Systems of all shapes; more are added here.
std::vector<LinearSystem> systems(std::mt19937_64& random) {
  std::vector<LinearSystem> all;
  for (const BodyKind kind : {BodyKind::six, BodyKind::seven}) {
    for (const Mechanism& m : {chain(1, 5), chain(2, 5), chain(12, 5), chain(9, 1), chain(5, 6), tree(10, random),
                               tree(14, random), ladder(1), ladder(4)})
      all.push_back(saddle_point(m, kind, random));
  }
  return all;
}

// The factors D_r, D_c in whose norms a badly scaled system is judged.
struct Scaled {
  explicit Scaled(const LinearSystem& s) {
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
long double backward_error(const LinearSystem& s, const Scaled& scaled, std::span<const double> x,
                           std::span<const double> b) {
  std::vector<long double> r = s.times(x);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = static_cast<long double>(b[i]) - r[i];
  return scaled.of_row(std::span<const long double>(r)) / (scaled.norm * scaled.of_solution(x) + scaled.of_row(b));
}

// Backward error at rounding level, forward error no more than the condition makes of it.
void expect_solved(const LinearSystem& s, std::span<const double> x, std::span<const double> b) {
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

// analyze, write, factor; the status of the first that fails.
LinearStatus prepare(LinearSolver& solver, const LinearSystem& s) {
  if (LinearStatus status = solver.analyze(s.pattern); !status.ok()) return status;
  write(s, solver);
  return solver.factor();
}

void expect_solves(LinearSolver& solver, const LinearSystem& s, std::mt19937_64& random) {
  const std::vector<double> b = random_vector(s.pattern.n, random);
  std::vector<double> x = b;
  const LinearStatus status = solver.solve(x);
  ASSERT_TRUE(status.ok()) << s.name << ": " << status.message;
  expect_solved(s, x, b);
}

TEST_P(LinearSolvers, SolvesSaddlePoints) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (const LinearSystem& made : systems(random)) {
      const LinearSystem s = suited(made);
      const auto solver = make();
      const LinearStatus status = prepare(*solver, s);
      ASSERT_TRUE(status.ok()) << s.name << ": " << status.message;
      EXPECT_EQ(solver->state(), LinearSolver::State::factored);
      EXPECT_EQ(solver->size(), s.pattern.n);
      expect_solves(*solver, s, random);
      expect_solves(*solver, s, random);
      EXPECT_EQ(solver->statistics().solves, 2);
      EXPECT_EQ(solver->statistics().analyses, 1);
      EXPECT_GE(solver->statistics().factorizations, 1);
      EXPECT_GT(solver->statistics().nonzeros, 0);
      EXPECT_GT(solver->statistics().factor_nonzeros, 0);
    }
  }
}

TEST_P(LinearSolvers, LeavesTheValuesAsTheyWere) {
  std::mt19937_64 random(7);
  const LinearSystem s = suited(saddle_point(chain(4, 5), BodyKind::six, random));
  const auto solver = make();
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  write(s, *solver);
  const std::vector<double> before(solver->values().begin(), solver->values().end());
  ASSERT_TRUE(solver->factor().ok());
  std::vector<double> b = random_vector(s.pattern.n, random);
  ASSERT_TRUE(solver->solve(b).ok());
  EXPECT_TRUE(std::ranges::equal(before, solver->values()));
}

TEST_P(LinearSolvers, FactorsAgainWithNewValues) {
  std::mt19937_64 random(11);
  const Mechanism mechanism = ladder(2);
  const auto solver = make();
  LinearSystem s = suited(saddle_point(mechanism, BodyKind::six, random));
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("factorization " + std::to_string(k));
    s = suited(saddle_point(mechanism, BodyKind::six, random));
    if (k % 3 == 2 && !symmetric_only()) {
      // One body's block becomes a permutation without a diagonal: exact zeros on pivots that were good before.
      const int body = (k / 3) % mechanism.bodies;
      for (std::size_t m = 0; m < s.pattern.blocks.size(); ++m) {
        const Block& block = s.pattern.blocks[m];
        if (block.row != 6 * body || block.col != 6 * body) continue;
        std::ranges::fill(s.block(m), 0.0);
        for (std::size_t c = 0; c < 6; ++c) s.block(m)[6 * c + (c + 1) % 6] = 1;
      }
    }
    write(s, *solver);
    const LinearStatus status = solver->factor();
    ASSERT_TRUE(status.ok()) << status.message;
    expect_solves(*solver, s, random);
  }
  EXPECT_EQ(solver->statistics().analyses, 1);
  EXPECT_GE(solver->statistics().factorizations + solver->statistics().refactorizations, 100);
}

TEST_P(LinearSolvers, FactorsAgainWhereValuesChangeByDecades) {
  std::mt19937_64 random(13);
  LinearSystem s = suited(saddle_point(chain(6, 5), BodyKind::six, random));
  const auto solver = make();
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  for (int k = 0; k < 30; ++k) {
    SCOPED_TRACE("factorization " + std::to_string(k));
    LinearSystem changed = s;
    const double factor = std::pow(10.0, std::uniform_real_distribution(-8.0, 8.0)(random));
    for (std::size_t m = 0; m < s.pattern.blocks.size(); ++m)
      if (s.pattern.node[static_cast<std::size_t>(s.pattern.blocks[m].row)] ==
          s.pattern.node[static_cast<std::size_t>(s.pattern.blocks[m].col)])
        for (double& x : changed.block(m)) x *= factor;
    write(changed, *solver);
    const LinearStatus status = solver->factor();
    ASSERT_TRUE(status.ok()) << status.message;
    expect_solves(*solver, changed, random);
  }
}

TEST_P(LinearSolvers, TwoSolversDoNotDisturbEachOther) {
  std::mt19937_64 random(17);
  const LinearSystem s = suited(saddle_point(chain(3, 5), BodyKind::six, random));
  const LinearSystem t = suited(saddle_point(ladder(2), BodyKind::seven, random));
  const auto first = make(), second = make();
  ASSERT_TRUE(first->analyze(s.pattern).ok());
  ASSERT_TRUE(second->analyze(t.pattern).ok());
  write(s, *first);
  write(t, *second);
  ASSERT_TRUE(first->factor().ok());
  ASSERT_TRUE(second->factor().ok());
  for (int k = 0; k < 3; ++k) {
    expect_solves(*first, s, random);
    expect_solves(*second, t, random);
  }
}

TEST_P(LinearSolvers, TakesANewPattern) {
  std::mt19937_64 random(19);
  const auto solver = make();
  for (const int bodies : {5, 2, 9}) {
    const LinearSystem s = suited(saddle_point(chain(bodies, 5), BodyKind::six, random));
    ASSERT_TRUE(prepare(*solver, s).ok());
    expect_solves(*solver, s, random);
  }
}

TEST_P(LinearSolvers, AddsBlocksThatOverlap) {
  std::mt19937_64 random(23);
  LinearSystem s = suited(saddle_point(chain(3, 5), BodyKind::six, random));
  // The same body block a second time, and one that reaches over two bodies.
  s.add({6, 6, 6, 6}, random_vector(36, random));
  s.add({3, 9, 3, 3}, random_vector(9, random));
  s.add({9, 3, 3, 3}, random_vector(9, random));
  s.add({4, 4, 6, 6}, random_vector(36, random));
  const auto solver = make();
  if (symmetric_only()) GTEST_SKIP() << prepare(*solver, s).message;
  ASSERT_TRUE(prepare(*solver, s).ok());
  expect_solves(*solver, s, random);
}

TEST_P(LinearSolvers, TakesARightHandSideWithExtremeEntries) {
  std::mt19937_64 random(29);
  const LinearSystem s = suited(saddle_point(chain(3, 5), BodyKind::six, random));
  const auto solver = make();
  ASSERT_TRUE(prepare(*solver, s).ok());
  std::vector<double> b = random_vector(s.pattern.n, random);
  for (std::size_t i = 0; i < b.size(); ++i) b[i] *= i % 3 == 0 ? 1e-250 : i % 3 == 1 ? 1 : 1e250;
  std::vector<double> x = b;
  ASSERT_TRUE(solver->solve(x).ok());
  expect_solved(s, x, b);

  std::ranges::fill(x, 0.0);
  ASSERT_TRUE(solver->solve(x).ok());
  for (const double xi : x) EXPECT_EQ(xi, 0);
}

// Masses from 1e-5 to 1e3 and constraint rows over h², h = 1e-6.
LinearSystem badly_scaled(const Mechanism& mechanism, BodyKind kind, bool both, std::mt19937_64& random) {
  LinearSystem s = saddle_point(mechanism, kind, random);
  const double h = 1e-6;
  for (std::size_t m = 0; m < s.pattern.blocks.size(); ++m) {
    const Block& b = s.pattern.blocks[m];
    const int row = s.pattern.node[static_cast<std::size_t>(b.row)],
              col = s.pattern.node[static_cast<std::size_t>(b.col)];
    double factor = 1;
    if (row == col && b.rows == b.cols) factor = row % 3 == 0 ? 1e-5 : row % 3 == 1 ? 1 : 1e3;
    if (row != col && row >= mechanism.bodies) factor = 1 / (h * h);
    if (row != col && col >= mechanism.bodies && both) factor = 1 / (h * h);
    for (double& x : s.block(m)) x *= factor;
  }
  return s;
}

TEST_P(LinearSolvers, PassesBadlyScaledRegularMatrices) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (const BodyKind kind : {BodyKind::six, BodyKind::seven})
      for (const Mechanism& m : {chain(1, 5), chain(8, 5), tree(9, random), ladder(2)})
        for (const bool both : {false, true}) {
          const LinearSystem s = suited(badly_scaled(m, kind, both, random));
          if (symmetric_only() && !both) continue;
          const auto solver = make();
          const LinearStatus status = prepare(*solver, s);
          ASSERT_TRUE(status.ok()) << s.name << ": " << status.message;
          expect_solves(*solver, s, random);
        }
  }
}

// Makes constraint row `to` repeat a multiple of row `from`, which acts on the same bodies, in G and Gᵀ.
void repeat_row(LinearSystem& s, const Mechanism& mechanism, int b, int from, int to, double factor) {
  for (int body = 0; body < mechanism.bodies; ++body)
    for (int c = b * body; c < b * (body + 1); ++c) {
      double *g = nullptr, *gt = nullptr, g_from = 0;
      std::size_t v = 0;
      for (const Block& block : s.pattern.blocks)
        for (int j = block.col; j < block.col + block.cols; ++j)
          for (int i = block.row; i < block.row + block.rows; ++i, ++v) {
            if (i == to && j == c) g = &s.values[v];
            if (i == c && j == to) gt = &s.values[v];
            if (i == from && j == c) g_from = s.values[v];
          }
      if (g) *g = *gt = factor * g_from;
    }
}

struct Redundant {
  LinearSystem regular, singular;
  std::vector<int> nodes;  // the two joints and their bodies
};

// Two joints between the same bodies, and one row of the one a multiple of a row of the other or of its own.
Redundant redundant(unsigned seed, std::mt19937_64& random, bool scaled) {
  Mechanism m = chain(3 + static_cast<int>(seed % 9), 4);
  const auto joint = static_cast<std::size_t>(std::uniform_int_distribution(0, m.bodies - 1)(random));
  m.joints.push_back({m.joints[joint].i, m.joints[joint].j, 2});
  const BodyKind kind = seed % 2 ? BodyKind::six : BodyKind::seven;
  const int b = kind == BodyKind::six ? 6 : 7;
  Redundant r{scaled ? badly_scaled(m, kind, true, random) : saddle_point(m, kind, random),
              {},
              {m.joints[joint].i, m.joints[joint].j, m.bodies + static_cast<int>(joint), 2 * m.bodies}};
  r.singular = r.regular;
  const int first = b * m.bodies + 4 * static_cast<int>(joint), extra = b * m.bodies + 4 * m.bodies;
  // 1/3 and 0.1 are not binary fractions: the rows are dependent only up to rounding.
  const double factor = seed % 3 == 0 ? 1.0 : seed % 3 == 1 ? 1.0 / 3 : 0.1;
  if (seed % 4 < 2)
    repeat_row(r.singular, m, b, first, extra, factor);
  else
    repeat_row(r.singular, m, b, first, first + 3, factor);
  return r;
}

TEST_P(LinearSolvers, NeverPassesARedundantConstraint) {
  for (unsigned seed = 1; seed <= 60; ++seed)
    for (const bool scaled : {false, true}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + (scaled ? ", badly scaled" : ""));
      std::mt19937_64 random(seed);
      const Redundant r = redundant(seed, random, scaled);
      const auto solver = make();
      const LinearStatus status = prepare(*solver, suited(r.singular));
      ASSERT_EQ(status.failure, LinearFailure::singular) << status.message;
      EXPECT_FALSE(status.message.empty());
      if (status.unknown >= 0 && !scaled) {
        const int node = r.singular.pattern.node[static_cast<std::size_t>(status.unknown)];
        EXPECT_TRUE(std::ranges::find(r.nodes, node) != r.nodes.end())
            << "node " << node << " is blamed, not " << testing::PrintToString(r.nodes) << status.message;
      }
      EXPECT_EQ(solver->state(), LinearSolver::State::analyzed);
    }
}

TEST_P(LinearSolvers, NeverPassesAMatrixThatBecomesSingular) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Redundant r = redundant(seed, random, seed % 5 == 0);
    r.regular = suited(r.regular), r.singular = suited(r.singular);
    const auto solver = make();
    ASSERT_TRUE(prepare(*solver, r.regular).ok());
    expect_solves(*solver, r.regular, random);
    write(r.singular, *solver);
    EXPECT_EQ(solver->factor().failure, LinearFailure::singular);
    EXPECT_EQ(solver->state(), LinearSolver::State::analyzed);
    write(r.regular, *solver);
    ASSERT_TRUE(solver->factor().ok()) << "regular again";
    expect_solves(*solver, r.regular, random);
  }
}

TEST_P(LinearSolvers, NeverPassesARedundantLoop) {
  // The rows of a closing joint are combinations of the rows of the other two joints of a triangle of bodies.
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Mechanism m{"triangle", 3, {{-1, 0, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 1}}};
    LinearSystem s = suited(saddle_point(m, BodyKind::six, random));
    // Row 0 of joint (0,1): (−g, g) and of joint (1,2): (−g, g); their sum is (−g, g) of joint (0,2).
    const std::vector<double> g = random_vector(6, random);
    const int rows[] = {18 + 2, 18 + 5, 18 + 8};
    const int bodies[][2] = {{0, 1}, {1, 2}, {0, 2}};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t c = 0; c < 6; ++c) {
          const int column = 6 * bodies[k][side] + static_cast<int>(c);
          std::size_t v = 0;
          for (const Block& block : s.pattern.blocks)
            for (int j = block.col; j < block.col + block.cols; ++j)
              for (int i = block.row; i < block.row + block.rows; ++i, ++v)
                if ((i == rows[k] && j == column) || (j == rows[k] && i == column))
                  s.values[v] = (side ? 1.0 : -1.0) * (k == 2 ? 0.7 : 1.0) * g[c];
        }
    const auto solver = make();
    EXPECT_EQ(prepare(*solver, s).failure, LinearFailure::singular);
  }
}

// The rigid rods of a chain along y, hinged about x: its condition grows as N⁴ and passes 1e16, its pivots stay good.
LinearSystem straight_chain(int bodies) {
  LinearSystem s;
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
  const LinearSystem s = straight_chain(10000);
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

TEST_P(LinearSolvers, ReportsAStructurallySingularMatrix) {
  std::mt19937_64 random(31);
  const LinearSystem too_many_rows =
      saddle_point({"one body, 7 rows", 1, {{-1, 0, 5}, {-1, 0, 2}}}, BodyKind::six, random);
  LinearSystem empty_row = suited(saddle_point(chain(2, 5), BodyKind::six, random));
  empty_row.pattern.n += 1;
  empty_row.pattern.node.push_back(4);
  for (const LinearSystem& s : {too_many_rows, empty_row}) {
    const auto solver = make();
    const LinearStatus status = solver->analyze(s.pattern);
    EXPECT_EQ(status.failure, LinearFailure::structurally_singular) << s.name;
    EXPECT_GE(status.unknown, 0);
    EXPECT_LT(status.unknown, s.pattern.n);
    EXPECT_FALSE(status.message.empty());
    EXPECT_EQ(solver->state(), LinearSolver::State::empty);
  }
}

TEST_P(LinearSolvers, ReportsAZeroMatrix) {
  std::mt19937_64 random(37);
  LinearSystem s = suited(saddle_point(chain(2, 5), BodyKind::six, random));
  std::ranges::fill(s.values, 0.0);
  EXPECT_EQ(prepare(*make(), s).failure, symmetric_only() ? LinearFailure::refused : LinearFailure::singular);
}

TEST_P(LinearSolvers, ReportsWhatIsNotFinite) {
  std::mt19937_64 random(41);
  const LinearSystem good = suited(saddle_point(ladder(2), BodyKind::six, random));
  const auto solver = make();
  ASSERT_TRUE(prepare(*solver, good).ok());
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const std::size_t where : {std::size_t{0}, good.values.size() / 2, good.values.size() - 1}) {
      LinearSystem s = good;
      s.values[where] = bad;
      EXPECT_EQ(prepare(*make(), s).failure, LinearFailure::not_finite);
      write(s, *solver);
      EXPECT_EQ(solver->factor().failure, LinearFailure::not_finite);
      EXPECT_EQ(solver->state(), LinearSolver::State::analyzed);
      write(good, *solver);
      ASSERT_TRUE(solver->factor().ok());
      expect_solves(*solver, good, random);
    }
    std::vector<double> b = random_vector(good.pattern.n, random);
    b[5] = bad;
    EXPECT_EQ(solver->solve(b).failure, LinearFailure::not_finite);
    EXPECT_EQ(solver->state(), LinearSolver::State::analyzed);
    ASSERT_TRUE(solver->factor().ok());
  }
}

TEST_P(LinearSolvers, ThrowsOnCallsOutOfOrderAndWrongSizes) {
  std::mt19937_64 random(43);
  const LinearSystem s = suited(saddle_point(chain(2, 5), BodyKind::six, random));
  std::vector<double> b = random_vector(s.pattern.n, random);
  const auto solver = make();
  EXPECT_THROW((void)solver->factor(), std::logic_error);
  EXPECT_THROW((void)solver->solve(b), std::logic_error);
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  EXPECT_EQ(solver->state(), LinearSolver::State::analyzed);
  EXPECT_THROW((void)solver->solve(b), std::logic_error);
  write(s, *solver);
  ASSERT_TRUE(solver->factor().ok());
  EXPECT_THROW((void)solver->solve(std::span(b).first(b.size() - 1)), std::logic_error);
  ASSERT_TRUE(solver->solve(b).ok());

  for (const Block& outside :
       {Block{-1, 0, 1, 1}, Block{0, s.pattern.n, 1, 1}, Block{s.pattern.n - 1, 0, 2, 1}, Block{0, 0, 0, 1}}) {
    Pattern p = s.pattern;
    p.blocks.push_back(outside);
    EXPECT_THROW((void)solver->analyze(p), std::logic_error);
  }
  Pattern p = s.pattern;
  p.node.pop_back();
  EXPECT_THROW((void)solver->analyze(p), std::logic_error);
}

TEST(LinearSolverRegistry, FindsEveryEntryByItsName) {
  for (const LinearSolverEntry& entry : linear_solvers()) {
    const LinearSolverEntry* found = find_linear_solver(entry.name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->name, entry.name);
    EXPECT_FALSE(entry.about.empty());
    EXPECT_NE(entry.make(), nullptr);
  }
  EXPECT_EQ(find_linear_solver("no such solver"), nullptr);
}

}  // namespace
}  // namespace poinsot::test
