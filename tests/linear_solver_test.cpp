// Every linear solver of the registry: it solves, again and again, and is called as its contract says.
#include <thread>

#include "core/index.h"
#include "tests/support/linear_solver_suite.h"

namespace poinsot::test {
namespace {

// Systems of all shapes; more are added here.
std::vector<SampleSystem> systems(std::mt19937_64& random) {
  std::vector<SampleSystem> all;
  for (const BodyKind kind : {BodyKind::six, BodyKind::seven}) {
    for (const Mechanism& m : {chain(1, 5), chain(2, 5), chain(12, 5), chain(9, 1), chain(5, 6), tree(10, random),
                               tree(14, random), ladder(1), ladder(4)})
      all.push_back(saddle_point(m, kind, random));
  }
  return all;
}

TEST_P(LinearSolvers, SolvesSaddlePoints) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (const SampleSystem& made : systems(random)) {
      const SampleSystem s = made;
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
  const SampleSystem s = saddle_point(chain(4, 5), BodyKind::six, random);
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
  SampleSystem s = saddle_point(mechanism, BodyKind::six, random);
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("factorization " + std::to_string(k));
    s = saddle_point(mechanism, BodyKind::six, random);
    if (k % 3 == 2) {
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
  SampleSystem s = saddle_point(chain(6, 5), BodyKind::six, random);
  const auto solver = make();
  ASSERT_TRUE(solver->analyze(s.pattern).ok());
  for (int k = 0; k < 30; ++k) {
    SCOPED_TRACE("factorization " + std::to_string(k));
    SampleSystem changed = s;
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

// To the same bytes as without, whether pivots are kept or not, and values and right-hand side stay as they are. Where
// a solve was to be the only one and is not, others cost a factorization and are the same, too.
TEST_P(LinearSolvers, FactorForARightHandSideThatIsKnown) {
  std::mt19937_64 random(23);
  std::int64_t made_again = 0;
  for (const SampleSystem& s :
       {saddle_point(chain(40, 5), BodyKind::six, random), saddle_point(chain(3, 5), BodyKind::seven, random),
        saddle_point(ladder(8), BodyKind::six, random)}) {
    SCOPED_TRACE(s.name);
    const auto before = make(), along = make();
    ASSERT_TRUE(before->analyze(s.pattern).ok() && along->analyze(s.pattern).ok());
    int solved = 0;
    std::int64_t again = 0;  // factorizations for solves that were not to come
    for (int k = 0; k < 100; ++k) {
      SampleSystem changed = s;
      const double decades = k % 10 == 9 ? 6 : 0.2;  // far off, pivots are examined anew
      for (double& x : changed.values) x *= std::pow(10.0, std::uniform_real_distribution(0.0, decades)(random));
      for (LinearSolver* solver : {before.get(), along.get()}) write(changed, *solver);
      const std::vector<double> asked = random_vector(s.pattern.n, random);
      std::vector<double> b = asked, x = asked;
      const LinearStatus status = before->factor();
      ASSERT_EQ(status.ok(), along->factor({b, k % 3 > 0}).ok());
      if (!status.ok()) continue;
      EXPECT_EQ(b, asked);
      const std::int64_t made = along->statistics().refactorizations;
      bool ok = true;
      for (int solves = 0; ok && solves <= k % 3 / 2; ++solves) {
        b = x = asked;
        ok = before->solve(x).ok();
        ASSERT_EQ(ok, along->solve(b).ok());
        if (ok) {
          EXPECT_EQ(b, x) << k;
        }
      }
      again += along->statistics().refactorizations - made;
      if (ok) ++solved;
    }
    EXPECT_GT(solved, 80);
    EXPECT_EQ(before->statistics().refactorizations + again, along->statistics().refactorizations);
    made_again += again;
  }
  EXPECT_EQ(made_again > 0, GetParam().name == "block" || GetParam().name == "auto");
}

// What a thread knows of structures it met before changes no byte: a chain and a ladder by turns, a body of which
// becomes singular by itself and changes the order, against the same in a thread of its own.
TEST_P(LinearSolvers, AnswersDoNotDependOnWhatWasSolvedBefore) {
  std::mt19937_64 random(19);
  std::vector<SampleSystem> all;
  for (int round = 0; round < 2; ++round)
    for (const Mechanism& mechanism : {chain(3, 5), ladder(2)})
      all.push_back(saddle_point(mechanism, BodyKind::six, random));
  for (std::size_t m = 0; m < all[1].pattern.blocks.size(); ++m)
    if (const Block& block = all[1].pattern.blocks[m]; block.row == 6 && block.col == 6)
      std::ranges::fill(all[1].block(m), 0.0);
  const auto answer = [&](const SampleSystem& s) {
    const auto solver = make();
    std::vector<double> b(static_cast<std::size_t>(s.pattern.n), 1.0);
    if (!prepare(*solver, s).ok() || !solver->solve(b).ok()) b.clear();
    return b;
  };
  for (const SampleSystem& s : all) {
    std::vector<double> alone;
    std::thread([&] { alone = answer(s); }).join();
    EXPECT_EQ(answer(s), alone) << s.name;
  }
}

TEST_P(LinearSolvers, TwoSolversDoNotDisturbEachOther) {
  std::mt19937_64 random(17);
  const SampleSystem s = saddle_point(chain(3, 5), BodyKind::six, random);
  const SampleSystem t = saddle_point(ladder(2), BodyKind::seven, random);
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
    const SampleSystem s = saddle_point(chain(bodies, 5), BodyKind::six, random);
    ASSERT_TRUE(prepare(*solver, s).ok());
    expect_solves(*solver, s, random);
  }
}

SampleSystem transposed(const SampleSystem& s) {
  SampleSystem t{s.name + " transposed", {s.pattern.n, {}, s.pattern.node}, {}};
  std::size_t first = 0;
  for (const Block& b : s.pattern.blocks) {
    std::vector<double> entries;
    for (int i = 0; i < b.rows; ++i)
      for (int j = 0; j < b.cols; ++j) entries.push_back(s.values[first + index(j * b.rows + i)]);
    t.add({b.col, b.row, b.cols, b.rows}, entries);
    first += entries.size();
  }
  return t;
}

TEST_P(LinearSolvers, SolveWithTheTransposedMatrixOrSayThatTheyDoNot) {
  std::mt19937_64 random(29);
  for (const Mechanism& mechanism : {chain(1, 5), chain(2, 5), chain(8, 5), ladder(2)})
    for (const BodyKind kind : {BodyKind::six, BodyKind::seven}) {
      const SampleSystem s = badly_scaled(mechanism, kind, true, random);
      const auto solver = make();
      ASSERT_TRUE(solver->analyze(s.pattern, Workload::transposed).ok());
      write(s, *solver);
      ASSERT_TRUE(solver->factor().ok());
      for (int k = 0; k < 2; ++k) {  // the second factorization keeps pivots
        const std::vector<double> b = random_vector(s.pattern.n, random);
        std::vector<double> x = b;
        const LinearStatus status = solver->solve_transposed(x);
        if (!GetParam().takes_jacobian) {
          EXPECT_EQ(status.failure, LinearFailure::refused);
          return;
        }
        ASSERT_TRUE(status.ok()) << status.message;
        expect_solved(transposed(s), x, b);
        ASSERT_TRUE(solver->factor().ok());
      }
    }
}

TEST_P(LinearSolvers, AddsBlocksThatOverlap) {
  std::mt19937_64 random(23);
  SampleSystem s = saddle_point(chain(3, 5), BodyKind::six, random);
  // The same body block a second time, and one that reaches over two bodies.
  s.add({6, 6, 6, 6}, random_vector(36, random));
  s.add({3, 9, 3, 3}, random_vector(9, random));
  s.add({9, 3, 3, 3}, random_vector(9, random));
  s.add({4, 4, 6, 6}, random_vector(36, random));
  const auto solver = make();
  ASSERT_TRUE(prepare(*solver, s).ok());
  expect_solves(*solver, s, random);
}

TEST_P(LinearSolvers, TakesARightHandSideWithExtremeEntries) {
  std::mt19937_64 random(29);
  const SampleSystem s = saddle_point(chain(3, 5), BodyKind::six, random);
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

TEST_P(LinearSolvers, ThrowsOnCallsOutOfOrderAndWrongSizes) {
  std::mt19937_64 random(43);
  const SampleSystem s = saddle_point(chain(2, 5), BodyKind::six, random);
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
  std::vector<double> other = b;
  EXPECT_THROW((void)solver->factor({std::span(b).first(b.size() - 1)}), std::logic_error);
  ASSERT_TRUE(solver->factor({b}).ok());
  EXPECT_THROW((void)solver->solve(other), std::logic_error);
  ASSERT_TRUE(solver->solve(b).ok());
  ASSERT_TRUE(solver->solve(other).ok());

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
    const LinearSolverEntry* found = linear_solvers().find(entry.name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->name, entry.name);
    EXPECT_FALSE(entry.about.empty());
    EXPECT_NE(entry.make(), nullptr);
  }
  EXPECT_EQ(linear_solvers().find("no such solver"), nullptr);
}

}  // namespace
}  // namespace poinsot::test
