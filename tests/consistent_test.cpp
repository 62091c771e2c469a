// Projections onto the constraints: to rounding, in no more corrections than that takes.
#include "integrators/stepping/consistent.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/start/initial_state.h"
#include "tests/support/loops.h"

namespace poinsot::test {
namespace {

// From 1e-4 off corrections are some 1e-4, 1e-8 and 1e-16, from 1e-6 off 1e-6 and 1e-12: what comes after the last of
// these would be rounding, and is not looked for.
TEST(Consistent, PositionsAreProjectedToRoundingByFewCorrections) {
  const auto model = std::make_shared<const Model>(compile(loop({4, Frames::random, false, false})));
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, {});
  std::vector<double> q(index(problem->nq())), v(index(problem->nv())), rows(index(problem->nc()));
  problem->from_bodies(given_state(*model), q, v);
  for (const auto& [off, corrections] : {std::pair(1e-4, 3), std::pair(1e-6, 2)}) {
    LinearSystem linear((LinearChoice()));
    Statistics statistics;
    PhaseClock clock;
    Consistent consistent(*problem, linear, statistics, clock);
    std::vector<double> moved = q;
    moved[0] += off;
    ASSERT_TRUE(consistent.project_position(0, moved).ok());
    problem->position_residual(rows);
    for (const double row : rows) EXPECT_LT(std::abs(row), 1e-14);
    EXPECT_LE(statistics.factorizations, corrections) << off;
  }
}

// What the factors at hand lead to needs one matrix of its own to be there to rounding; where they lead nowhere, from
// half a turn away, as many as ever.
TEST(Consistent, PositionsNearbyAreProjectedByTheFactorsAtHand) {
  const auto model = std::make_shared<const Model>(compile(loop({4, Frames::random, false, false})));
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, {});
  std::vector<double> q(index(problem->nq())), v(index(problem->nv())), rows(index(problem->nc()));
  problem->from_bodies(given_state(*model), q, v);
  for (const double off : {1e-6, 1e-3, 0.3}) {
    LinearSystem linear((LinearChoice()));
    Statistics statistics;
    PhaseClock clock;
    Consistent consistent(*problem, linear, statistics, clock);
    std::vector<double> moved = q;
    ASSERT_TRUE(consistent.project_nearby(0, moved).ok());  // no factors yet
    moved[0] += off;
    std::vector<double> anew = moved;
    const auto before = statistics.factorizations;
    ASSERT_TRUE(consistent.project_nearby(0, moved).ok()) << off;
    const auto nearby = statistics.factorizations - before;
    problem->position_residual(rows);
    for (const double row : rows) EXPECT_LT(std::abs(row), 1e-14) << off;
    if (off < 0.1) {
      EXPECT_EQ(nearby, 1) << off;
    }
    ASSERT_TRUE(consistent.project_position(0, anew).ok());
    for (std::size_t k = 0; k < anew.size(); ++k) EXPECT_NEAR(moved[k], anew[k], 3 * off * off + 1e-14) << off;
  }
}

}  // namespace
}  // namespace poinsot::test
