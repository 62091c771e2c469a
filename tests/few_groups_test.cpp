// Of very many redundant rows, in loops that have few each: which are set aside.
#include "integrators/start/few_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "core/index.h"
#include "integrators/start/loop_rows.h"
#include "integrators/start/violation.h"
#include "tests/support/large_scenes.h"

namespace poinsot::test {
namespace {

class FewGroups : public ::testing::TestWithParam<LargeKind> {};

TEST_P(FewGroups, AreTheSameByTheDecompositionOfAllAndByThatOfEachLoop) {
  constexpr int kBodies = 4500;
  const auto model = std::make_shared<const Model>(compile(GetParam().make(kBodies)));
  RowSpace space = all_rows(model, 0, given_state(*model));
  space.keep(loop_rows(*model, space));
  NullSpace null = few_null_vectors(space.columns(), kIndependent, {nullptr, true});
  ASSERT_TRUE(many(null) && null.decomposition);
  const auto chosen = [&] { return rows_of_few_groups(*model, space.rows(), space.columns(), null, kIndependent); };
  const auto groups = [&](const std::vector<int>& rows) {
    std::set<int> of;
    for (const int k : rows) of.insert(model->rows[index(space.rows()[index(k)])].group);
    return of.size();
  };
  std::vector<int> by_all = chosen();
  null.decomposition = nullptr;
  std::vector<int> by_loops = chosen();
  EXPECT_LT(groups(by_all), groups(null.columns));
  std::ranges::sort(by_all);
  std::ranges::sort(by_loops);
  EXPECT_EQ(by_all, by_loops);
}

INSTANTIATE_TEST_SUITE_P(Of, FewGroups,
                         ::testing::Values(LargeKind{"chain_of_four_bars", &chain_of_four_bars},
                                           LargeKind{"doubled_tree", &doubled_tree}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace poinsot::test
