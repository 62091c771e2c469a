// What is kept of the block solver's analysis from one matrix to the next.
#include "linsolve/block/schedules.h"

#include <gtest/gtest.h>

#include <vector>

#include "linsolve/csc_layout.h"
#include "tests/support/linear_solver_systems.h"

namespace poinsot::test {
namespace {

std::shared_ptr<const block::Schedule> of_chain(int bodies, block::Fronts kind = block::Fronts::cheap) {
  std::mt19937_64 random(1);
  const SampleSystem s = saddle_point(chain(bodies, 5), BodyKind::six, random);
  CscLayout layout;
  EXPECT_TRUE(layout.build(s.pattern).ok());
  return block::schedule_of(layout, s.pattern.node, std::vector<int>(2 * static_cast<std::size_t>(bodies), -1), kind);
}

TEST(Schedules, ServeTheNextOfTheSamePattern) {
  for (const int bodies : {2, 90}) {
    const auto first = of_chain(bodies);
    ASSERT_TRUE(first);
    EXPECT_EQ(of_chain(bodies + 1)->n, 11 * (bodies + 1));
    EXPECT_NE(of_chain(bodies, block::Fronts::calm), first);
    EXPECT_EQ(of_chain(bodies), first);
  }
}

TEST(Schedules, AreKeptAsLongAsTheyAreFewAndSmall) {
  const std::weak_ptr<const block::Schedule> first = of_chain(20);
  for (int bodies = 21; bodies < 29; ++bodies) (void)of_chain(bodies);
  EXPECT_FALSE(first.expired());
  (void)of_chain(29);
  EXPECT_TRUE(first.expired());

  const std::weak_ptr<const block::Schedule> large = of_chain(1000), larger = of_chain(1001);
  EXPECT_TRUE(large.expired()) << "together they have 22 000 unknowns";
  EXPECT_FALSE(larger.expired());
  const std::weak_ptr<const block::Schedule> largest = of_chain(2000);
  EXPECT_TRUE(largest.expired()) << "it has more alone";
  EXPECT_FALSE(larger.expired()) << "and drives nothing out";
}

}  // namespace
}  // namespace poinsot::test
