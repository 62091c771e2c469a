// What is kept of a long mechanism does not depend on all that comes before it more and more.
#include "linsolve/front_qr.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/index.h"
#include "core/model.h"
#include "integrators/start/loop_rows.h"
#include "integrators/start/rank.h"
#include "integrators/start/row_space.h"
#include "integrators/start/violation.h"
#include "tests/support/large_scenes.h"

namespace poinsot::test {
namespace {

// Enough is left of each column that is kept, but loads are 1e41 times as large at one end of this net as at the other
// where columns are taken by their order, and still 5e10 times where the clearest are.
TEST(FrontQr, KeepsRowsThatNumbersDoNotGrowAlong) {
  constexpr int kRows = 391, kBodiesOfRow = 13, kFollowing = 18;  // of the net
  const auto model = std::make_shared<const Model>(compile(grid(kRows * kBodiesOfRow)));
  RowSpace space = all_rows(model, 0, given_state(*model));
  space.keep(loop_rows(*model, space));
  const std::vector<char> none(index(space.columns().rows()), 0);
  const FrontQr kept(space.columns(), none, kIndependent, FrontQr::Choice::calmest, 0);
  const FrontQr clear(space.columns(), none, kIndependent, FrontQr::Choice::clearest, 0);
  EXPECT_EQ(kept.dependent().size(), kFollowing * (kRows - 1));
  EXPECT_LT(kept.growth(), 1e7);
  EXPECT_GT(clear.growth(), 1e10);
}

// Their other ends could not be put back onto rows of the net, and seemed to have other ranks beside.
TEST(FrontQr, NetsOfThousandsOfRodsAreRegular) {
  for (const int rows : {615, 769}) {
    const auto model = std::make_shared<const Model>(compile(grid(13 * rows)));
    const RankAnalysis found = analyze_rank(model, given_state(*model), RankNames::none);
    EXPECT_EQ(found.degrees_of_freedom(), rows + 12);
    EXPECT_TRUE(found.singular.empty());
  }
}

// Of columns in the order of their lengths, some twice.
TEST(FrontQr, SolvesNormalEquationsOfWhatIsKept) {
  constexpr Eigen::Index kRows = 30, kColumns = 20, kSides = 3;
  srand(1);
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(kRows, kColumns);
  A = (A.array().abs() < 0.6).select(0, A);  // sparse
  A.col(7) = A.col(3), A.col(15) = A.col(2) + A.col(11);
  A.colwise().normalize();
  FrontQr qr(A.sparseView(), std::vector<char>(kRows, 0), 1e-9, FrontQr::Choice::by_order, kColumns);
  ASSERT_EQ(qr.dependent().size(), 2u);
  Eigen::MatrixXd kept = A;
  for (const int column : qr.dependent()) kept.col(column).setZero();
  Eigen::MatrixXd y = Eigen::MatrixXd::Random(kSides, kColumns);
  for (const int column : qr.dependent()) y.col(column).setZero();
  Eigen::MatrixXd b = y * kept.transpose() * kept;
  for (const int column : qr.dependent()) b.col(column).setConstant(7);  // passed over
  qr.solve_normal_equations(b);
  EXPECT_LT((b - y).cwiseAbs().maxCoeff(), 1e-11);
}

}  // namespace
}  // namespace poinsot::test
