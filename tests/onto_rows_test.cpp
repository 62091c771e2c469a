// Two ways to put a mechanism onto the rows that are kept: by the equations of motion, and by the decomposition alone.
#include "integrators/start/onto_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <random>
#include <vector>

#include "core/body_sizes.h"
#include "core/index.h"
#include "integrators/start/few_groups.h"
#include "integrators/start/loop_rows.h"
#include "integrators/start/violation.h"
#include "tests/support/large_scenes.h"

namespace poinsot::test {
namespace {

constexpr double kMoved = 1e-6;  // of a body's size

// A mechanism, its rows of loops and what both ways leave out.
struct TwoWays {
  explicit TwoWays(const Scene& scene)
      : model(std::make_shared<const Model>(compile(scene))), space(all_rows(model, 0, given_state(*model))) {
    sizes = body_sizes(*model);
    space.keep(loop_rows(*model, space));
    decomposition = few_null_vectors(space.columns(), kIndependent, {nullptr, true}).decomposition;
    if (!decomposition) return;
    for (const int column : decomposition->dependent()) without.push_back(space.rows()[index(column)]);
    std::ranges::sort(without);
    auto unit = std::make_shared<Model>(*model);
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      unit->bodies[b].mass = 1;
      unit->bodies[b].inertia = sizes[b] * sizes[b] * Matrix3::Identity();
    }
    by_motion = onto_rows_by_motion(unit, space, without, sizes);
    by_decomposition = onto_rows_by_decomposition(decomposition, space, sizes);
    q.resize(index(space.problem().nq())), v.resize(index(space.problem().nv()));
    space.problem().from_bodies(given_state(*model), q, v);
  }

  Eigen::MatrixXd random_moves(int count) {
    Eigen::MatrixXd moves(count, static_cast<Eigen::Index>(v.size()));
    for (Eigen::Index j = 0; j < moves.cols(); ++j)
      for (Eigen::Index k = 0; k < count; ++k) moves(k, j) = normal(random) * (j % 6 < 3 ? sizes[index(j / 6)] : 1);
    return moves;
  }
  std::vector<double> moved(double by) {
    const Eigen::MatrixXd moves = by * random_moves(1);
    std::vector<double> there(q.size());
    space.problem().retract(q, std::span(moves.data(), v.size()), there);
    return there;
  }

  std::shared_ptr<const Model> model;
  RowSpace space;
  std::vector<double> sizes, q, v;
  std::shared_ptr<FrontQr> decomposition;
  std::vector<int> without;
  std::unique_ptr<OntoRows> by_motion, by_decomposition;
  std::mt19937 random{1};
  std::normal_distribution<double> normal;
};

double apart(std::span<const double> x, std::span<const double> y) {
  double most = 0;
  for (std::size_t k = 0; k < x.size(); ++k) most = std::max(most, std::abs(x[k] - y[k]));
  return most;
}

class OntoRowsOf : public ::testing::TestWithParam<LargeKind> {};

TEST_P(OntoRowsOf, ComesToTheSameBothWays) {
  constexpr int kBodies = 24;  // no row is wide
  TwoWays of(GetParam().make(kBodies));
  ASSERT_TRUE(of.decomposition);
  ASSERT_EQ(of.space.rows().size(), of.model->rows.size());  // of others the decomposition knows nothing
  std::vector<double> q = of.q, other = of.q;
  ASSERT_TRUE(of.by_motion->position(0, q) && of.by_decomposition->position(0, other));
  EXPECT_LT(apart(q, other), 1e-11);

  std::vector<double> v(of.v.size()), other_v;
  std::ranges::generate(v, [&] { return of.normal(of.random); });
  other_v = v;
  ASSERT_TRUE(of.by_motion->velocity(0, q, v) && of.by_decomposition->velocity(0, q, other_v));
  EXPECT_LT(apart(v, other_v), 1e-9);

  const Eigen::MatrixXd asked = of.random_moves(2);
  Eigen::MatrixXd moves = asked, other_moves = asked;
  ASSERT_TRUE(of.by_motion->leave_free(0, moves) && of.by_decomposition->leave_free(0, other_moves));
  EXPECT_LT((moves - other_moves).cwiseAbs().maxCoeff(), 1e-9 * asked.cwiseAbs().maxCoeff());
  EXPECT_GT((moves - asked).cwiseAbs().maxCoeff(), 0.1);

  // Moved off, both come back to the constraints, and all that was left out follows there.
  for (OntoRows* way : {of.by_motion.get(), of.by_decomposition.get()}) {
    std::vector<double> there = of.moved(kMoved), off(of.space.rows().size());
    of.space.move(0, there);
    of.space.distances(off);
    EXPECT_GT(apart(off, std::vector<double>(off.size())), 0.1 * kMoved);
    ASSERT_TRUE(way->position(0, there));
    of.space.stand_at(0, there);
    of.space.distances(off);
    EXPECT_LT(apart(off, std::vector<double>(off.size())), 1e-11);
    EXPECT_TRUE(way->all_follow(0));
  }
}

// All rows of which are of loops.
std::vector<LargeKind> kinds_of_loops() {
  std::vector<LargeKind> kinds(std::begin(kLargeKinds), std::end(kLargeKinds));
  std::erase_if(kinds, [](const LargeKind& kind) { return kind.name == "grid"; });
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(, OntoRowsOf, ::testing::ValuesIn(kinds_of_loops()),
                         [](const auto& kind) { return std::string(kind.param.name); });

// Folded flat it has a row that follows there and beside it does not.
TEST(OntoRows, TellOfARowThatIsSingular) {
  Rods made;
  const Vector3 p(0, 0, 0), q(1, 0, 0), r(2, 0, 0), s(0.5, 0, 0);  // 1 + 0.5 = 2 − 0.5, all on a line
  const int crank = made.rod(p, q), coupler = made.rod(q, r), rocker = made.rod(r, s);
  made.join(kGround, crank, p);
  made.join(crank, coupler, q);
  made.join(coupler, rocker, r);
  made.join(rocker, kGround, s);
  TwoWays of(made.scene);
  ASSERT_TRUE(of.decomposition);
  for (OntoRows* way : {of.by_motion.get(), of.by_decomposition.get()}) {
    std::vector<double> there = of.q;
    ASSERT_TRUE(way->position(0, there));
    of.space.stand_at(0, there);
    EXPECT_TRUE(way->all_follow(0));
    Eigen::MatrixXd move = of.random_moves(1);
    ASSERT_TRUE(way->leave_free(0, move));
    move *= 1e-3 / move.cwiseAbs().maxCoeff();
    of.space.problem().retract(there, std::span(move.data(), of.v.size()), there);
    ASSERT_TRUE(way->position(0, there));
    of.space.stand_at(0, there);
    EXPECT_FALSE(way->all_follow(0));
  }
}

TEST(OntoRows, DecompositionLeadsNoFartherThanItCan) {
  TwoWays of(Carried::ladder(20, true));
  std::vector<double> there = of.moved(1);
  EXPECT_FALSE(of.by_decomposition->position(0, there));
}

}  // namespace
}  // namespace poinsot::test
