// Redundant rows on the way. Those that are kept wear out at their own pace: error control is not to creep up to where
// they depend on one another while the mechanism is regular. And what they cost beside none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/start/rank.h"
#include "integrators/start/row_space.h"
#include "integrators/start/rows_aside.h"
#include "integrators/start/violation.h"
#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

class RowWear : public ::testing::TestWithParam<std::string> {};

// Its kept rows change little up to half way to where three of them fall together.
TEST_P(RowWear, IsSeenWhereItBeginsLate) {
  const Scene scene = read_scene(POINSOT_SOURCE_DIR "/tests/scenes/sarrus_four_legs.json");
  for (const char* integrator : {"radau5", "dop853"})
    for (const double rtol : {1e-8, 1e-10}) {
      const Recorded r = run(scene, controlled(integrator, GetParam(), rtol, 0.3, 0.3));
      EXPECT_TRUE(r.outcome.status.ok()) << integrator << ' ' << rtol << ": " << r.outcome.status.message;
    }
}

// Steps that are rejected again and again, or that get shorter and shorter, ask for others; and what steps have left of
// rows that are kept from now on is not an error of steps to come.
TEST_P(RowWear, StopsNoTolerancesOfErrorControl) {
  const Scene scene = read_scene(POINSOT_SOURCE_DIR "/tests/scenes/parallel_cranks.json");
  for (const char* integrator : {"auto", "dopri5", "dop853", "radau5"})
    for (const double rtol : {1e-8, 2e-9, 1.74e-9, 5e-10, 1e-10, 5e-11, 3e-11, 1e-11, 3e-12, 1e-12}) {
      const Recorded r = run(scene, controlled(integrator, GetParam(), rtol, 1, 1));
      EXPECT_TRUE(r.outcome.status.ok()) << integrator << ' ' << rtol << ": " << r.outcome.status.message;
    }
}

// In thousands of instructions of a loop of four links: assembly and factorization, a solution, one that is looked at
// and corrected.
double cost(const Outcome& outcome) {
  double sum = 0;
  for (const LinearWork& work : outcome.statistics.linear)
    sum += 19.0 * static_cast<double>(work.factorizations + work.refactorizations) +
           2.5 * static_cast<double>(work.solves) + 4.6 * static_cast<double>(work.refinements);
  return sum;
}

// The same loop without redundancy takes as many factorizations and solutions; of these about as many are refined.
TEST_P(RowWear, CostsLittle) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    if (integrator.name == "ida") continue;  // how many steps it takes hangs on rounding, by more than that
    for (const bool carried : {false, true}) {
      Settings settings = dynamics(GetParam(), 2e-3, 0.5, 0.5);
      settings.integrator = integrator.name;
      settings.tolerance = 1e-8;
      settings.rtol = 1e-7;
      const auto of = [&](bool redundant) {
        return cost(run(loop({4, Frames::random, carried, redundant}), settings).outcome);
      };
      EXPECT_LT(of(true), 1.1 * of(false)) << integrator.name << (carried ? ", carried" : "");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RowWear, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// After every step those rows are measured that no row kept says word for word: none of a joint that is there twice,
// all of a loop's.
TEST(RowsAside, AreMeasuredUnlessTheyAreSaidTwice) {
  const auto measured = [](const Scene& scene) {
    const auto model = std::make_shared<const Model>(compile(scene));
    const std::vector<int> aside = analyze_rank(model, given_state(*model), RankNames::none).aside;
    EXPECT_FALSE(aside.empty());
    return std::pair(not_said_twice(*model, aside, all_but(model->rows.size(), aside)), aside);
  };
  Scene twice = loop({4, Frames::random, true, false});
  twice.joints.insert(twice.joints.end(), twice.joints.begin(), twice.joints.end());
  for (std::size_t k = 0; k < twice.joints.size(); ++k) twice.joints[k].name = fmt::format("joint {}", k);
  EXPECT_THAT(measured(twice).first, ::testing::IsEmpty());
  const auto [all, aside] = measured(loop({4, Frames::random, false, true}));
  EXPECT_EQ(all, aside);
}

// What differs by less than one is not the same.
TEST(RowsAside, OfOtherRightHandSidesAreMeasured) {
  Scene scene = scene_of("free_body");
  for (const double f : {0.25, 0.75, 0.25}) {
    Constraint& row = scene.constraints.emplace_back();
    row.type = ConstraintType::CD, row.j = 0, row.c = {1, 0, 0}, row.f = Expression(f);
  }
  const Model model = compile(scene);
  EXPECT_THAT(not_said_twice(model, {1, 2}, {0}), ::testing::ElementsAre(1));
}

}  // namespace
}  // namespace poinsot::test
