// Random numbers of studies: the generator's published answers, the distributions' moments, and that a number depends
// on seed and index alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/cases/draw.h"
#include "bench/cases/random.h"
#include "bench/cases/random_mechanism.h"
#include "bench/cases/variation.h"
#include "core/scene_writer.h"
#include "integrators/simulate.h"

namespace poinsot::cases {
namespace {

// The known answers of Random123's kat_vectors.
TEST(CasesRandom, PhiloxGivesThePublishedAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(CasesRandom, TheInverseOfTheNormalDistributionIsItsInverse) {
  EXPECT_EQ(normal_quantile(0.5), 0);
  for (const double p : {1e-300, 1e-20, 1e-5, 0.01, 0.07, 0.0751, 0.3, 0.6, 0.93, 0.999}) {
    const double x = normal_quantile(p);
    EXPECT_NEAR(std::erfc(-x / std::sqrt(2.0)) / 2 / p, 1, 1e-12 * std::max(1.0, x * x)) << p;
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
}

ParameterAxis axis(bool latin_hypercube, std::uint64_t seed = 5) {
  ParameterAxis a;
  a.names = {"u", "n"};
  a.distributions = {{Distribution::uniform, 2, 5}, {Distribution::normal, -1, 0.5}};
  a.samples = 40'000;
  a.latin_hypercube = latin_hypercube;
  a.seed = seed;
  return a;
}

TEST(CasesRandom, MomentsAreThoseOfTheDistributions) {
  for (const bool latin_hypercube : {false, true}) {
    const ParameterAxis a = axis(latin_hypercube);
    const auto n = static_cast<double>(a.samples);
    double sum[2] = {}, square[2] = {}, product = 0;
    for (std::int64_t k = 0; k < a.samples; ++k) {
      std::vector<double> x;
      a.append(k, x);
      ASSERT_GT(x[0], 2);
      ASSERT_LT(x[0], 5);
      const double centred[] = {x[0] - 3.5, x[1] + 1};
      for (int d = 0; d < 2; ++d) {
        sum[d] += centred[d] / n;
        square[d] += centred[d] * centred[d] / n;
      }
      product += centred[0] * centred[1] / n;
    }
    // Five standard errors of independent samples; of a Latin hypercube the means are far better.
    const double share = latin_hypercube ? 0.05 : 5;
    EXPECT_NEAR(sum[0], 0, share * std::sqrt(0.75 / n));
    EXPECT_NEAR(sum[1], 0, share * 0.5 / std::sqrt(n));
    EXPECT_NEAR(square[0], 0.75, 5 * std::sqrt(0.45 / n));
    EXPECT_NEAR(square[1], 0.25, 5 * 0.25 * std::sqrt(2 / n));
    EXPECT_NEAR(product, 0, 5 * std::sqrt(0.75 * 0.25 / n));
  }
}

TEST(CasesRandom, ALatinHypercubeHasOneSampleInEveryStratum) {
  for (const std::int64_t n : {1, 2, 3, 7, 64, 65, 1000}) {
    ParameterAxis a = axis(true);
    a.samples = n;
    std::set<std::int64_t> strata[2];
    for (std::int64_t k = 0; k < n; ++k) {
      std::vector<double> x;
      a.append(k, x);
      const double p[] = {(x[0] - 2) / 3, std::erfc(-(x[1] + 1) / 0.5 / std::sqrt(2.0)) / 2};
      for (int d = 0; d < 2; ++d) strata[d].insert(static_cast<std::int64_t>(p[d] * static_cast<double>(n)));
    }
    for (const auto& taken : strata) {
      EXPECT_EQ(static_cast<std::int64_t>(taken.size()), n);
      EXPECT_EQ(*taken.begin(), 0);
      EXPECT_EQ(*taken.rbegin(), n - 1);
    }
  }
}

TEST(CasesRandom, ASampleDependsOnSeedAndIndexAlone) {
  const ParameterAxis a = axis(true), b = axis(true), other = axis(true, 6);
  std::vector<double> forward, backward, of_other;
  for (std::int64_t k = 0; k < 100; ++k) a.append(k, forward);
  for (std::int64_t k = 100; k-- > 0;) {
    std::vector<double> x;
    b.append(k, x);
    backward.insert(backward.begin(), x.begin(), x.end());
    other.append(k, of_other);
  }
  EXPECT_EQ(forward, backward);
  EXPECT_NE(forward, of_other);
}

TEST(CasesRandom, StudentsDistributionIsThatOfTheTables) {
  const std::pair<int, double> table[] = {{1, 12.7062}, {2, 4.30265}, {3, 3.18245},
                                          {4, 2.77645}, {9, 2.26216}, {49, 2.00958}};
  for (const auto& [degrees, t] : table) EXPECT_NEAR(student_95(degrees) / t, 1, 2e-3) << degrees;
  const GeometricMean mean = geometric_mean({1, 4, 2, 2});
  EXPECT_NEAR(mean.mean, 2, 1e-14);
  EXPECT_NEAR(mean.high / mean.mean, mean.mean / mean.low, 1e-12);
  EXPECT_NEAR(std::log(mean.high / 2), student_95(3) * std::log(2) * std::sqrt(2.0 / 3) / 2, 1e-12);
}

// Closed ones are assembled, have no dependent constraints, and move.
TEST(CasesRandom, MechanismsRunInEverySize) {
  for (const bool closed : {false, true}) {
    for (const int bodies : {1, 2, 3, 5, 14}) {
      if (closed && bodies == 1) continue;
      const Scene scene = random_mechanism(bodies, closed, static_cast<std::uint64_t>(bodies));
      EXPECT_EQ(scene.bodies.size(), static_cast<std::size_t>(bodies));
      EXPECT_EQ(to_json(scene), to_json(random_mechanism(bodies, closed, static_cast<std::uint64_t>(bodies))));
      Settings settings;
      settings.integrator = "implicit_euler";
      settings.end = 0.05;
      double speed = 0;
      const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
        for (const double v : sample.v) speed = std::max(speed, std::abs(v));
      });
      EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_TRUE(outcome.undetermined_reactions.empty());
      EXPECT_GT(speed, 1e-3) << bodies;
    }
  }
}

}  // namespace
}  // namespace poinsot::cases
