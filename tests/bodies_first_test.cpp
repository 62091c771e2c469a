// The elimination of few bodies before all their constraints (linsolve/block/schur.h), by itself and in the block
// solver.
#include <gtest/gtest.h>

#include "linsolve/block/schur.h"
#include "linsolve/registry.h"
#include "linsolve/residual.h"
#include "tests/support/linear_solver_systems.h"
#include "tests/support/start_system.h"

namespace poinsot::test {
namespace {

void expect_solved_by_schur(const SampleSystem& s, block::Schur& schur, std::mt19937_64& random) {
  const std::vector<double> x = random_vector(s.pattern.n, random);
  const std::vector<long double> exact = s.times(x);
  std::vector<double> b(exact.begin(), exact.end());
  schur.solve(b);
  for (std::size_t k = 0; k < x.size(); ++k)
    EXPECT_NEAR(b[k], x[k], 1e-7) << k;  // of random ones the worst has a condition of some 1e7
}

TEST(BodiesFirst, AreEliminatedWhereTheyAndTheirConstraintsAreFew) {
  std::mt19937_64 random(5);
  for (const BodyKind kind : {BodyKind::six, BodyKind::seven})
    for (const Mechanism& mechanism : {chain(1, 5), chain(2, 3), chain(2, 5), chain(2, 6)}) {
      SCOPED_TRACE(mechanism.name + (kind == BodyKind::six ? " six" : " seven"));
      SampleSystem s = saddle_point(mechanism, kind, random);
      CscLayout layout;
      ASSERT_TRUE(layout.build(s.pattern).ok());
      const std::vector<double> ones(static_cast<std::size_t>(s.pattern.n), 1);
      block::Schur schur;
      ASSERT_TRUE(schur.lay_out(s.pattern, layout));
      write(s, schur);
      ASSERT_TRUE(schur.choose(ones));
      EXPECT_TRUE(schur.factor(10));
      expect_solved_by_schur(s, schur, random);
      for (double& value : s.values) value *= 1.25;  // every pivot with them
      write(s, schur);
      EXPECT_TRUE(schur.factor(1.5));
      expect_solved_by_schur(s, schur, random);
      EXPECT_FALSE(schur.factor(1.2));
      s.values.back() = std::numeric_limits<double>::quiet_NaN();
      write(s, schur);
      EXPECT_FALSE(schur.factor(1e300));
    }
}

// Along a motion, long enough to be tried, and with bodies so different in mass that they may not serve.
TEST(BodiesFirst, AreTakenWhereSolutionsStayAsGood) {
  std::mt19937_64 random(7);
  for (const BodyKind kind : {BodyKind::six, BodyKind::seven})
    for (const double heavier : {1.0, 1e6, 1e12}) {
      SCOPED_TRACE(heavier);
      SampleSystem s = saddle_point(chain(2, 5), kind, random);
      std::size_t v = 0;
      for (const Block& block : s.pattern.blocks)
        for (int k = 0; k < block.rows * block.cols; ++k, ++v)
          if (block.row == block.col && block.row == 0) s.values[v] *= heavier;
      CscLayout layout;
      ASSERT_TRUE(layout.build(s.pattern).ok());
      Residual residual;
      residual.resize(layout);
      const std::vector<double> ones(static_cast<std::size_t>(s.pattern.n), 1);
      const auto solver = linear_solvers().require("block").make();
      ASSERT_TRUE(solver->analyze(s.pattern).ok());
      for (int step = 0; step < 200; ++step) {
        for (double& value : s.values) value *= 1 + 1e-3 * std::uniform_real_distribution(-1.0, 1.0)(random);
        std::ranges::fill(solver->values(), 0.0);
        std::vector<double> values(static_cast<std::size_t>(layout.nonzeros()), 0);
        std::size_t n = 0, slot = 0;
        for (const Block& block : s.pattern.blocks)
          for (int c = 0; c < block.cols; ++c, ++slot)
            for (int r = 0; r < block.rows; ++r, ++n) {
              values[static_cast<std::size_t>(layout.slots[slot] + r)] += s.values[n];
              solver->values()[static_cast<std::size_t>(solver->slots()[slot] + r)] += s.values[n];
            }
        ASSERT_TRUE(solver->factor().ok()) << step;
        residual.measure_by(ones, ones);
        const std::vector<long double> exact = s.times(random_vector(s.pattern.n, random));
        const std::vector<double> b(exact.begin(), exact.end());
        std::vector<double> x = b;
        ASSERT_TRUE(solver->solve(x).ok()) << step;
        EXPECT_LT(residual.size(layout, values, b, x), 1e-13) << step;
      }
    }
}

TEST(BodiesFirst, AreLeftToOthersWhereTheyAreMoreOrHangOnLittle) {
  std::mt19937_64 random(5);
  for (const Mechanism& mechanism : {chain(3, 4), chain(2, 7), ladder(1), chain(1, 3)}) {
    const SampleSystem s = saddle_point(mechanism, BodyKind::six, random);
    CscLayout layout;
    ASSERT_TRUE(layout.build(s.pattern).ok());
    EXPECT_FALSE(block::Schur().lay_out(s.pattern, layout)) << mechanism.name;
  }
}

// Whether the block solver has places of another layout for its values after so many solutions of one system.
bool taken_after(int solutions, std::string_view formulation) {
  const StartSystem start(scene_of("double_pendulum"), formulation);
  const SampleSystem& s = start.matrix;
  const auto solver = linear_solvers().require("block").make();
  EXPECT_TRUE(solver->analyze(s.pattern).ok());
  const int* slots = solver->slots().data();
  const std::vector<long double> exact = s.times(start.solution);
  for (int k = 0; k < solutions; ++k) {
    write(s, *solver);
    EXPECT_TRUE(solver->factor().ok());
    std::vector<double> b(exact.begin(), exact.end());
    EXPECT_TRUE(solver->solve(b).ok());
    for (std::size_t i = 0; i < b.size(); ++i)
      EXPECT_NEAR(b[i], start.solution[i], 1e-10 * (1 + std::abs(start.solution[i]))) << k;
  }
  EXPECT_TRUE(solver->factor().ok());  // of the same values once more, wherever they stand by now
  std::vector<double> b(exact.begin(), exact.end());
  EXPECT_TRUE(solver->solve(b).ok());
  EXPECT_NEAR(b[0], start.solution[0], 1e-10 * (1 + std::abs(start.solution[0])));
  return solver->slots().data() != slots;
}

TEST(BodiesFirst, AreTakenOnceManySolutionsWereGood) {
  for (const int solutions : {62, 63, 64, 200}) EXPECT_EQ(taken_after(solutions, "rA"), solutions >= 64) << solutions;
  EXPECT_FALSE(taken_after(200, "rp"));  // bodies' matrices K are too uneven there
}

}  // namespace
}  // namespace poinsot::test
