// Every linear solver of the registry: what is singular or not finite never passes, and the status says where.
#include "tests/support/linear_solver_suite.h"

namespace poinsot::test {
namespace {

// Makes constraint row `to` repeat a multiple of row `from`, which acts on the same bodies, in G and Gᵀ.
void repeat_row(SampleSystem& s, const Mechanism& mechanism, int b, int from, int to, double factor) {
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
  SampleSystem regular, singular;
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
      const LinearStatus status = prepare(*solver, r.singular);
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

// As beside a singular position that a run looks at from ever nearer, and from afar: what one matrix was scaled by is
// not the beginning for the next.
TEST_P(LinearSolvers, PassOverSingularMatricesAgainAndAgain) {
  std::mt19937_64 random(7);
  const Redundant r = redundant(8, random, false);
  const auto solver = make();
  ASSERT_TRUE(prepare(*solver, r.regular).ok());
  for (int k = 0; k < 300; ++k) {
    SampleSystem between = r.regular;
    const double apart = std::pow(10.0, -1 - k % 13);
    for (std::size_t v = 0; v < between.values.size(); ++v)
      between.values[v] = apart * r.regular.values[v] + (1 - apart) * r.singular.values[v];
    write(between, *solver);
    if (!solver->factor().ok()) {
      EXPECT_LT(apart, 1e-8) << "round " << k;
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_solves(*solver, between, random)) << "round " << k << ", " << apart;
  }
  write(r.regular, *solver);
  ASSERT_TRUE(solver->factor().ok());
  expect_solves(*solver, r.regular, random);
}

TEST_P(LinearSolvers, NeverPassesARedundantLoop) {
  // The rows of a closing joint are combinations of the rows of the other two joints of a triangle of bodies.
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Mechanism m{"triangle", 3, {{-1, 0, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 1}}};
    SampleSystem s = saddle_point(m, BodyKind::six, random);
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

TEST_P(LinearSolvers, ReportsAStructurallySingularMatrix) {
  std::mt19937_64 random(31);
  const SampleSystem too_many_rows =
      saddle_point({"one body, 7 rows", 1, {{-1, 0, 5}, {-1, 0, 2}}}, BodyKind::six, random);
  SampleSystem empty_row = saddle_point(chain(2, 5), BodyKind::six, random);
  empty_row.pattern.n += 1;
  empty_row.pattern.node.push_back(4);
  for (const SampleSystem& s : {too_many_rows, empty_row}) {
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
  SampleSystem s = saddle_point(chain(2, 5), BodyKind::six, random);
  std::ranges::fill(s.values, 0.0);
  EXPECT_EQ(prepare(*make(), s).failure, LinearFailure::singular);
}

TEST_P(LinearSolvers, ReportsWhatIsNotFinite) {
  std::mt19937_64 random(41);
  const SampleSystem good = saddle_point(ladder(2), BodyKind::six, random);
  const auto solver = make();
  ASSERT_TRUE(prepare(*solver, good).ok());
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const std::size_t where : {std::size_t{0}, good.values.size() / 2, good.values.size() - 1}) {
      SampleSystem s = good;
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

}  // namespace
}  // namespace poinsot::test
