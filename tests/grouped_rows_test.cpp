// Which joints are opened where a mechanism is constrained too often.
#include "integrators/start/grouped_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "core/model.h"
#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/support/carried.h"
#include "tests/support/loops.h"

namespace poinsot {
namespace {

using test::Carried;
using test::Frames;
using ::testing::ElementsAre;

// The joints that give rows, numbered as the scene does.
std::set<int> opened(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  std::set<int> groups;
  for (const int row : analyze_rank(model, given_state(*model), RankNames::none).aside)
    groups.insert(model->rows[static_cast<std::size_t>(row)].group);
  return groups;
}

TEST(OpenedJoints, AreTheLastButOneOfALoopOnTheGround) {
  EXPECT_THAT(opened(test::loop({5, Frames::drawn, false, true})), ElementsAre(3));
  EXPECT_THAT(opened(test::loop({6, Frames::quarter_turns, false, true})), ElementsAre(4));
  EXPECT_THAT(opened(test::loop({8, Frames::random, false, true})), ElementsAre(6));
}

// The last of its two, if it has more than four links.
TEST(OpenedJoints, AreOnTheBodyThatCarriesALoop) {
  for (const int links : {4, 5, 6, 8})
    EXPECT_THAT(opened(test::loop({links, Frames::quarter_turns, true, true})), ElementsAre(links > 4 ? links : 1))
        << links;
}

// The last cell has none beyond: its rung meets as many joints.
TEST(OpenedJoints, AreBetweenTheCellsOfALadder) {
  EXPECT_THAT(opened(Carried::ladder(5, true)), ElementsAre(1, 5, 9, 13, 15));
}

TEST(OpenedJoints, HaveTurnsOfTheirOwn) {
  const Model model = compile(Carried::four_bars(2, true));
  const std::vector<int> turns = opening_turns(model);
  EXPECT_EQ(std::set<int>(turns.begin(), turns.end()).size(), model.groups.size());
  EXPECT_EQ(turns[0], 8);  // on the ground
  EXPECT_LT(turns[1], turns[2]);
  EXPECT_LT(turns[8], turns[7]);
}

}  // namespace
}  // namespace poinsot
