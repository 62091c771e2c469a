// The maps of `poinsot stability`: no result is silently wrong over reduced families, verdicts of known edges, closed
// forms against quadrature, and amplification on the code against the known curves.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>

#include "bench/stability/amplification.h"
#include "bench/stability/maps.h"
#include "bench/stability/suite.h"
#include "bench/stability/truths.h"
#include "tests/support/simulation.h"

namespace poinsot::stability {
namespace {

std::vector<Cell> cells(const Family& family, const Extent& extent, int threads) {
  const std::filesystem::path part =
      std::filesystem::path(::testing::TempDir()) / fmt::format("{}_{}_{}.part", family.name, getpid(), threads);
  const FamilyStudy study(family, extent);
  cases::CaseTable table(study.study());
  table.open(part);
  compute(study, table, threads, [] {});
  std::filesystem::remove(part);
  return study.cells(table);
}

std::string text(const Cell& cell) {
  return fmt::format("{} at {:g}, {:g}: error {:.3g}, promised {:.3g}; {}", cell.method(), cell.x, cell.y, cell.error,
                     cell.promised, cell.message);
}

// The quick suite in one formulation; the others are in the suite itself.
class Stability : public ::testing::TestWithParam<std::string> {};
std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const Family& family : families()) names.emplace_back(family.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, Stability, ::testing::ValuesIn(family_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Stability, NothingIsSilentlyWrong) {
  const Family& family = require_family(GetParam());
  const std::vector<Cell> all = cells(family, {true, {}, {}}, 1);
  ASSERT_FALSE(all.empty());
  for (const Cell& cell : all) EXPECT_NE(cell.verdict, Verdict::wrong) << text(cell);
  EXPECT_GT(count(all, Verdict::accurate), static_cast<int>(all.size()) / 2);
}

TEST(StabilityVerdicts, AreWhatIsKnownOfTheEdges) {
  const auto of = [](std::string_view family, const char* integrator, const char* formulation) {
    return cells(require_family(family), {true, {formulation}, {integrator}}, 1);
  };
  for (const Cell& cell : of("euler_angles", "dop853", "rp")) EXPECT_EQ(cell.verdict, Verdict::accurate) << text(cell);
  // Steps that would come to singular Euler angles are made shorter.
  for (const Cell& cell : of("euler_angles", "dop853", "reps")) EXPECT_NE(cell.verdict, Verdict::stop) << text(cell);
  for (const Cell& cell : of("flat_redundant", "generalized_alpha", "rA"))
    EXPECT_EQ(cell.verdict, Verdict::accurate) << text(cell);
  for (const Cell& cell : of("pulse", "dop853", "rA")) EXPECT_EQ(cell.verdict, Verdict::accurate) << text(cell);
  int told = 0;
  for (const Cell& cell : of("pulse", "rattle", "rA")) told += cell.verdict == Verdict::told;
  EXPECT_GT(told, 0);
  // Explicit in the forces: past h w = 2 it is not right, and says so or stops.
  for (const Cell& cell : of("stiffness", "rattle", "rA"))
    EXPECT_EQ(cell.verdict == Verdict::accurate, cell.y * std::sqrt(cell.x) < 2) << text(cell);
  for (const Cell& cell : of("stiffness", "radau5", "rA")) EXPECT_EQ(cell.verdict, Verdict::accurate) << text(cell);
  // A driver of the angle itself has no singularity, nor has an alternate. A bare DP1 that turns round in it could go
  // on either way: that may be told, by stopping.
  for (const Cell& cell : of("dp1_driver", "dop853", "rA")) {
    const bool open = cell.y == 0 && cell.x < 1e-6 && cell.verdict == Verdict::stop;
    EXPECT_TRUE(open || cell.verdict == Verdict::accurate) << text(cell);
  }
  // A state far off is refused.
  for (const Cell& cell : of("inconsistent", "dop853", "reps"))
    EXPECT_EQ(cell.verdict, cell.x > 0.01 ? Verdict::stop : Verdict::accurate) << text(cell);
}

TEST(StabilityVerdicts, OfAWrongResultAreWrong) {
  Family family = require_family("far_away");
  family.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    // Half the gravity where the scene is as far as 1e4 m.
    const auto right = require_family("far_away").truth(at, at.x == 1e4 ? t / std::sqrt(2) : t);
    return right;
  };
  const std::vector<Cell> all = cells(family, {true, {"rA"}, {"dop853"}}, 1);
  for (const Cell& cell : all) {
    if (cell.x > 1e4 || cell.y < 1) continue;
    EXPECT_EQ(cell.verdict, cell.x == 1e4 ? Verdict::wrong : Verdict::accurate) << text(cell);
  }
}

TEST(StabilitySuite, GivesTheSameCellsByOneAndTwoThreads) {
  const Family& family = require_family("flat_planar");
  const Extent extent{true, {"rA", "reps"}, {"dop853", "rattle"}};
  const std::vector<Cell> one = cells(family, extent, 1), two = cells(family, extent, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].values, two[k].values);
    EXPECT_EQ(one[k].verdict, two[k].verdict);
    EXPECT_EQ(text(one[k]), text(two[k]));
  }
}

// ẏ = f(y) in many steps against elliptic functions.
TEST(StabilityTruths, SwingAsRungeKuttaSays) {
  for (const double start : {0.5, 1.5, 3.0}) {
    for (const double t : {0.3, 1.1, 2.9, 10.0}) {
      const Eigen::Vector2d y = runge_kutta<2>(Eigen::Vector2d(start, 0), t, 40000, [](const Eigen::Vector2d& s) {
        return Eigen::Vector2d(s[1], -9 * std::sin(s[0]));
      });
      const Swing exact = swing(3, start, t);
      EXPECT_NEAR(exact.angle, y[0], 1e-9) << start << ' ' << t;
      EXPECT_NEAR(exact.rate, y[1], 1e-8) << start << ' ' << t;
      EXPECT_NEAR(exact.acceleration, -9 * std::sin(y[0]), 1e-8) << start << ' ' << t;
    }
  }
}

TEST(Amplification, IsThatOfTheKnownCurves) {
  const double rho = 0.8;
  for (const bool rotation : {false, true}) {
    for (const bool constrained : {false, true}) {
      for (const double damping : {0.0, 0.5}) {
        const Oscillator oscillator{rotation, constrained, damping};
        for (const std::string& formulation : test::formulation_names()) {
          for (const double hw : {0.1, 1.0, 10.0, 40.0}) {
            SCOPED_TRACE(::testing::Message() << oscillator.name() << ' ' << formulation << ' ' << hw);
            const auto near = [&](const char* integrator, double known) {
              const auto measured = spectral_radius(oscillator, integrator, formulation, hw);
              ASSERT_TRUE(measured) << integrator;
              EXPECT_NEAR(*measured, known, 1e-4) << integrator;
            };
            near("implicit_euler", implicit_euler_radius(hw, damping));
            near("radau5", radau5_radius(hw, damping));
            near("generalized_alpha", generalized_alpha_radius(hw, damping, rho));
            near("generalized_alpha_i2", generalized_alpha_radius(hw, damping, rho));
            if (damping == 0 && hw < 2) near("rattle", verlet_radius(hw));
            if (damping == 0 && hw < 2) near("half_implicit", verlet_radius(hw));
          }
        }
      }
    }
  }
}

TEST(Amplification, OfMethodsWithoutStepsOfTheirOwnIsNone) {
  EXPECT_FALSE(spectral_radius({}, "ida", "rp", 1));
  EXPECT_FALSE(spectral_radius({}, "auto", "rA", 1));
}

}  // namespace
}  // namespace poinsot::stability
