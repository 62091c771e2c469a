// Bodies with many joints: their rank, what a factorization costs, how they move.
#include "tests/support/hubs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"
#include "linsolve/block/cancellation.h"
#include "linsolve/block/fusion.h"
#include "linsolve/block/schedules.h"
#include "linsolve/linear_system.h"
#include "tests/scale.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::IsEmpty;

// A hub's rows are left out of the decomposition where they reach too many columns; what they hold is found by null
// vectors where these are asked for, else without. At 200 to 290 arms some of its rows are left out and others are not,
// beyond that all.
TEST(Hubs, RankIsFound) {
  for (const HubKind& kind : kHubs)
    for (const int count : {60, 205, 260, 290, std::max(400, scaled(1200))})
      for (const RankNames names : {RankNames::all, RankNames::none}) {
        if (names == RankNames::all && count > 60) continue;
        SCOPED_TRACE(fmt::format("{} {}", count, kind.name));
        const auto model = std::make_shared<const Model>(compile(hub(kind.hub, count)));
        const RankAnalysis found = analyze_rank(model, given_state(*model), names);
        EXPECT_EQ(found.rank, 6 * static_cast<int>(model->bodies.size()) - kind.freedoms(count));
        EXPECT_EQ(found.aside.size(), model->rows.size() - index(found.rank));
        EXPECT_EQ(found.doubt.part, 0);
        EXPECT_THAT(found.singular, IsEmpty());
        EXPECT_THAT(found.conflicts, IsEmpty());
      }
}

// Factors of a step's matrix grow with the number of joints, not with its square, and block needs no help.
TEST(Hubs, FactorsGrowWithTheirJoints) {
  const int few = std::max(75, scaled(150));
  for (const HubKind& kind : kHubs) {
    SCOPED_TRACE(kind.name);
    double entries[2];
    for (const int k : {0, 1}) {
      const auto model = std::make_shared<const Model>(compile(hub(kind.hub, k == 0 ? few : 4 * few)));
      const RankAnalysis rank = analyze_rank(model, given_state(*model), RankNames::none);
      const auto problem = intrinsic_formulation().make(model, rank.aside);
      std::vector<double> q(index(problem->nq())), v(index(problem->nv()));
      problem->from_bodies(given_state(*model), q, v);
      problem->set_position(0, q);
      problem->set_velocity(v);
      LinearSystem system({"block", "whole"});
      ASSERT_TRUE(system.analyze(problem->pattern(MatrixKind::simplified)).ok());
      std::ranges::fill(system.values(), 0.0);
      const std::vector<double> none(v.size() + index(problem->nc()), 0.0);
      problem->assemble(MatrixKind::simplified, {1, 1e-3, 1e-6}, {}, std::span(none).first(v.size()),
                        std::span(none).subspan(v.size()), system.slots(), system.values());
      ASSERT_TRUE(system.factor().ok());
      EXPECT_EQ(system.statistics().handed_over, 0);
      entries[k] = static_cast<double>(system.statistics().factor_nonzeros);
    }
    EXPECT_LT(entries[1], 4.5 * entries[0]);
  }
}

// Groups whose rows hold a hub are known by counting: the first order of elimination serves.
TEST(Hubs, AreHeldByRowsThatAreCounted) {
  for (const HubKind& kind : {kHubs[5], kHubs[6], kHubs[7]}) {
    SCOPED_TRACE(kind.name);
    const auto model = std::make_shared<const Model>(compile(hub(kind.hub, 150)));
    const std::vector<BodyState> states = given_state(*model);
    const auto problem = intrinsic_formulation().make(model, analyze_rank(model, states, RankNames::none).aside);
    std::vector<double> q(index(problem->nq())), v(index(problem->nv()));
    problem->from_bodies(states, q, v);
    problem->set_position(0, q);
    problem->set_velocity(v);
    const Pattern pattern = problem->pattern(MatrixKind::consistent);
    CscLayout layout;
    ASSERT_TRUE(layout.build(pattern).ok());
    std::vector<double> values(index(layout.nonzeros()));
    problem->assemble(MatrixKind::consistent, {}, {}, {}, {}, layout.slots, values);
    const auto cancelled = [&](const std::vector<int>& fused) {
      const auto schedule = block::schedule_of(layout, pattern.node, fused, block::Fronts::cheap);
      return block::cancelled_pivots(*schedule, values, std::vector<double>(index(layout.n), 1.0), 1e-6).pivots.size();
    };
    std::vector<int> fused(1 + index(*std::ranges::max_element(pattern.node)), -1);
    EXPECT_GT(cancelled(fused), 0u);
    block::fuse_with_hubs(layout, pattern.node, fused);
    EXPECT_EQ(cancelled(fused), 0u);
  }
}

// The cranks go past the position where they turn in the direction of the rows that hold the coupler. By block it moves
// on hinges and on balls as it does on hinges by klu.
TEST(Hubs, MoveAsOne) {
  const auto end = [](Hub kind, std::string_view solver) {
    Settings settings = dynamics("rA", 1e-3, 2, 1);
    settings.integrator = "dop853";
    settings.linear_solver = solver;
    settings.rtol = 1e-9;
    return motion(hub(kind, 60), settings).back();
  };
  const Snapshot reference = end(Hub::cranks, "klu");
  EXPECT_LT(reference.bodies[0].r.y(), -0.2);  // it stood 1 m above the cranks' hinges
  for (const Hub kind : {Hub::cranks, Hub::ball_cranks}) {
    const Snapshot found = end(kind, "block");
    for (std::size_t b = 0; b < reference.bodies.size(); ++b)
      EXPECT_LT((found.bodies[b].r - reference.bodies[b].r).norm(), 1e-7) << b;
  }
}

}  // namespace
}  // namespace poinsot::test
