// Hundreds of redundant rows that have to be exchanged on the way, in loops of their own and in loops that lean on one
// another: more than have coefficients (integrators/start/block_choice.h), or than are chosen at once
// (integrators/start/few_groups.h).
#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "integrators/start/loop_rows.h"
#include "integrators/start/rank.h"
#include "integrators/start/reactions.h"
#include "integrators/start/row_blocks.h"
#include "integrators/start/row_choice.h"
#include "integrators/start/row_space.h"
#include "integrators/start/violation.h"
#include "tests/support/carried.h"
#include "tests/support/scene_transform.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr const char* kFixedSteps = "implicit_euler";

struct CarriedMotion {
  Outcome outcome;
  std::vector<BodyState> end;
  std::vector<Vector3> forces;  // of all joints on a body, N: by sample and body
  int exchanges = 0;
};

CarriedMotion carry(const Scene& scene, const Settings& settings) {
  CarriedMotion m;
  m.outcome = simulate(scene, settings, [&](const Sample& sample) {
    m.end.resize(static_cast<std::size_t>(sample.problem.bodies()));
    sample.problem.to_bodies(sample.a, m.end);
    m.exchanges = sample.problem.revision();
    const std::size_t first = m.forces.size();
    m.forces.resize(first + m.end.size(), Vector3::Zero());
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      Vector3 force, moment;
      sample.problem.reaction(static_cast<int>(k), sample.lambda, force, moment);
      const int i = scene.joints[k].i, j = scene.joints[k].j;
      if (i != kGround) m.forces[first + static_cast<std::size_t>(i)] -= force;
      m.forces[first + static_cast<std::size_t>(j)] += force;
    }
  });
  return m;
}

class ManyLoops : public ::testing::TestWithParam<std::string> {};

// Long steps turn the loops by as much as wears a choice of rows out: it has to be made anew before.
TEST_P(ManyLoops, RejectNoStepsForTheirRows) {
  for (const std::string_view name : {"dopri5", "dop853"}) {
    const auto compare = [&](auto&& make, int count, double end, std::int64_t more) {
      SCOPED_TRACE(fmt::format("{} {} of {}", name, GetParam(), count));
      Settings settings = dynamics(GetParam(), 1e-3, end, 1);
      settings.integrator = name;
      settings.rtol = 1e-8;
      const CarriedMotion with = carry(make(count, true), settings), without = carry(make(count, false), settings);
      EXPECT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
      EXPECT_LE(with.outcome.statistics.rejected_steps, without.outcome.statistics.rejected_steps + more);
      EXPECT_LE(static_cast<double>(with.outcome.statistics.steps),
                1.03 * static_cast<double>(without.outcome.statistics.steps));
      EXPECT_GT(with.exchanges, 0);
    };
    for (const int count : {1, 3}) compare(&Carried::four_bars, count, 5, 0);
    compare(&Carried::four_bars, 335, 0.6, 0);  // 1005 redundant rows: chosen loop by loop
    compare(&Carried::ladder, 5, 1.5, 1);       // whose own motion has steps rejected: one more or less
  }
}

TEST_P(ManyLoops, MoveAsWithoutRedundancy) {
  for (const std::string_view name : {"dopri5", kFixedSteps}) {
    Settings settings = dynamics(GetParam(), 4e-3, 0.6, 1);
    settings.integrator = name;
    settings.tolerance = 1e-9;
    settings.rtol = 1e-8;
    for (const auto make : {&Carried::four_bars, &Carried::ladder}) {
      SCOPED_TRACE(fmt::format("{} {} {}", make == &Carried::ladder ? "ladder" : "four-bars", name, GetParam()));
      // 870 redundant rows are chosen anew as a whole, 207 one by one.
      const int cells = name == kFixedSteps && make == &Carried::ladder ? 290 : 69;
      const CarriedMotion with = carry(make(cells, true), settings), without = carry(make(cells, false), settings);
      ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
      ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
      double apart = 0;
      for (std::size_t b = 0; b < with.end.size(); ++b)
        apart = std::max(apart, (with.end[b].r - without.end[b].r).norm());
      EXPECT_LT(apart, 1e-6);
      if (name == kFixedSteps) {  // the same times
        double largest = 0, off = 0;
        for (std::size_t k = 0; k < with.forces.size(); ++k) {
          largest = std::max(largest, without.forces[k].norm());
          off = std::max(off, (with.forces[k] - without.forces[k]).norm());
        }
        EXPECT_LT(off, 1e-5 * largest);
      }
      EXPECT_LT(with.outcome.statistics.violation.position, 1e-11);
      EXPECT_GT(with.exchanges, 0);
      EXPECT_LE(static_cast<double>(with.outcome.statistics.steps),
                1.1 * static_cast<double>(without.outcome.statistics.steps));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ManyLoops, ::testing::Values("rA", "rp", "reps"));

// Rows that are nearly combinations of others may come first: their order alone must not decide about rank. Ladders of
// 40 cells and more were called singular. Of 1300 on, some row has less than kIndependent left wherever the ladder
// stands: that is its length, not a position.
TEST(Rank, OfACarriedLadder) {
  Transform turned;
  turned.R = exp_so3(Vector3(1e-3, -2e-3, 1.5e-3));
  for (const int cells : {20, 41, 50, 72, 110, 1400})
    for (const bool tilted : {false, true}) {
      SCOPED_TRACE(fmt::format("{} cells{}", cells, tilted ? ", tilted" : ""));
      const Scene scene = Carried::ladder(cells, true);
      const auto model = std::make_shared<const Model>(compile(tilted ? turned.apply(scene) : scene));
      const RankAnalysis found = analyze_rank(model, given_state(*model), RankNames::none);
      EXPECT_EQ(found.degrees_of_freedom(), cells + 1);
      EXPECT_EQ(found.aside.size(), static_cast<std::size_t>(3 * cells));
      EXPECT_TRUE(found.singular.empty());
      EXPECT_EQ(found.doubt.part, 0);
    }
}

// What redundant joints may add to one another's reactions loads no body, found by full and by sparse matrices, in one
// loop and in a ladder that is longer than coefficients reach.
TEST(RowChoice, NullVectorsLoadNoBody) {
  for (const auto make : {&Carried::four_bars, &Carried::ladder})
    for (const int count : {1, 4, 60}) {
      SCOPED_TRACE(fmt::format("{} {}", make == &Carried::ladder ? "ladder" : "four-bars", count));
      const auto model = std::make_shared<const Model>(compile(make(count, true)));
      const std::vector<BodyState> states = given_state(*model);
      RowChoice choice(model, loop_rows(model, 0, states), analyze_rank(model, states, RankNames::none).aside);
      const std::vector<SparseEntries> vectors = choice.null_vectors(0, states);
      EXPECT_EQ(vectors.size(), static_cast<std::size_t>(3 * count));
      RowSpace all = all_rows(model, 0, states);
      for (const SparseEntries& z : vectors) {
        Eigen::VectorXd load = Eigen::VectorXd::Zero(all.columns().rows());
        double largest = 0;
        for (const auto& [row, value] : z) {
          const double force = value * all.lengths()[static_cast<std::size_t>(row)];  // on a unit vector
          load += force * all.columns().col(row);
          largest = std::max(largest, std::abs(force));
        }
        EXPECT_LT(load.cwiseAbs().maxCoeff(), 1e-11 * largest);
      }
    }
}

// Reactions of very many rows are in balance, but not the least ones: a run that is asked for them says so, once.
TEST(Reactions, OfMoreThanCanBeTheLeastAreSaidNotToBe) {
  const auto said = [](const Scene& scene, bool asked) {
    Settings settings = dynamics("rA", 1e-3, 2e-3);
    settings.reactions = asked;
    std::optional<Reactions> reactions;
    const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
      if (!reactions) reactions.emplace(sample.problem);
      reactions->update(sample);
    });
    EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
    const auto notices = std::ranges::count_if(
        outcome.notices, [](const std::string& notice) { return notice.find("not the least") != std::string::npos; });
    return std::pair(notices, reactions->least());
  };
  EXPECT_EQ(said(Carried::ladder(67, true), true), std::pair(1L, false));  // 201 redundant rows
  EXPECT_EQ(said(Carried::ladder(67, true), false), std::pair(0L, false));
  EXPECT_EQ(said(Carried::ladder(66, true), true), std::pair(0L, true));
  EXPECT_EQ(said(Carried::four_bars(67, true), true), std::pair(0L, true));  // each loop by itself
}

// Loops that share a body are apart, those that share two are not; a joint outside of loops is alone.
TEST(RowBlocks, AreLoopsThatShareTwoBodies) {
  const auto sizes = [](const Scene& scene) {
    const Model model = compile(scene);
    std::vector<int> rows(model.rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<int>(k);
    const Lists blocks = row_blocks(model, rows);
    std::vector<std::size_t> of;
    for (int b = 0; b < blocks.size(); ++b) of.push_back(blocks[b].size());
    return of;
  };
  EXPECT_THAT(sizes(Carried::four_bars(3, true)), ::testing::UnorderedElementsAre(5, 20, 20, 20));
  EXPECT_THAT(sizes(Carried::ladder(4, true)), ::testing::UnorderedElementsAre(5, 80));
}

}  // namespace
}  // namespace poinsot::test
