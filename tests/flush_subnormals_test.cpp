// Subnormal numbers are zero in a run, and what calls it keeps its own arithmetic, however the run ends.
#include "core/flush_subnormals.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/support/loops.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// Not folded by the compiler.
double halved(double x) {
  volatile double half = x;
  half = 0.5 * half;
  return half;
}

constexpr double kLeast = std::numeric_limits<double>::min();

TEST(FlushSubnormals, WhileItLives) {
#if !defined(__x86_64__)
  GTEST_SKIP() << "nothing is done on this architecture";
#endif
  EXPECT_GT(halved(kLeast), 0);
  {
    const FlushSubnormals flush;
    EXPECT_EQ(halved(kLeast), 0);
    { const FlushSubnormals again; }
    EXPECT_EQ(halved(kLeast), 0);
    EXPECT_GT(halved(2 * kLeast), 0);
  }
  EXPECT_GT(halved(kLeast), 0);
}

TEST(FlushSubnormals, InARun) {
#if !defined(__x86_64__)
  GTEST_SKIP() << "nothing is done on this architecture";
#endif
  const Scene scene = loop({.links = 5});
  const Settings settings = dynamics("rA", 1e-3, 0.01, 1e-3);
  int samples = 0;
  const Outcome outcome = simulate(scene, settings, [&](const Sample&) {
    ++samples;
    EXPECT_EQ(halved(kLeast), 0);
  });
  EXPECT_TRUE(outcome.status.ok());
  EXPECT_EQ(samples, 11);
  EXPECT_GT(halved(kLeast), 0);
  const Observer fails = [](const Sample&) { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)simulate(scene, settings, fails), std::runtime_error);
  EXPECT_GT(halved(kLeast), 0);
}

}  // namespace
}  // namespace poinsot::test
