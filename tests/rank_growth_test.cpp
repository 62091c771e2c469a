// What the analysis of rank takes grows with the mechanism, not with its square, whatever it is built of.
//
// Time is not measured; counted are the bytes of memory that are asked for. Matrices, lists, fronts and vectors of
// numbers are made where there is work, so that what is done for each joint over all joints shows; what is only
// searched again and again, without any memory, does not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/model.h"
#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/support/allocations.h"
#include "tests/support/large_scenes.h"

namespace poinsot::test {
namespace {

double bytes_for(const LargeKind& kind, int bodies) {
  const auto model = std::make_shared<const Model>(compile(kind.make(bodies)));
  EXPECT_NEAR(static_cast<double>(model->bodies.size()), bodies, 0.02 * bodies);
  const std::vector<BodyState> states = given_state(*model);
  const long before = allocated_bytes();
  const RankAnalysis found = analyze_rank(model, states, RankNames::none);
  const long after = allocated_bytes();
  EXPECT_TRUE(found.conflicts.empty());
  EXPECT_TRUE(found.singular.empty());
  EXPECT_GT(found.aside.size(), 1000u);
  return static_cast<double>(after - before);
}

class RankGrowth : public ::testing::TestWithParam<LargeKind> {};

// Both have more redundant rows than are looked at together (integrators/start/few_groups.h).
TEST_P(RankGrowth, IsThatOfTheMechanism) {
  constexpr int kFew = 1125;
  EXPECT_LT(bytes_for(GetParam(), 4 * kFew), 5 * bytes_for(GetParam(), kFew));
}

INSTANTIATE_TEST_SUITE_P(Of, RankGrowth, ::testing::ValuesIn(kLargeKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace poinsot::test
