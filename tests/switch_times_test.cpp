// Where the arguments of kinks and jumps change their signs: each found once, on numbers beside each other.
#include "integrators/stepping/switch_times.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>
#include <string>
#include <vector>

#include "core/model.h"
#include "tests/support/pushed.h"

namespace poinsot::test {
namespace {

using ::testing::IsEmpty;

std::vector<double> switches(const char* f, double end) {
  const Model model = compile(pushed(f));
  SwitchTimes times(model, end);
  std::vector<double> found;
  for (double t = 0; found.size() < 1000;) {
    const SwitchTimes::Switch next = times.first(t, end);
    if (!(next.before <= end)) break;
    EXPECT_GT(next.after, next.before);
    EXPECT_LE(next.after - next.before, 1e-15 * end);
    found.push_back(next.after);
    t = next.after;
  }
  return found;
}

TEST(SwitchTimes, AreWhereArgumentsChangeTheirSigns) {
  using ::testing::DoubleNear;
  using ::testing::ElementsAre;
  EXPECT_THAT(switches("abs(t - 0.3)", 1), ElementsAre(DoubleNear(0.3, 1e-15)));
  EXPECT_THAT(switches("1000*max(0, 1 - abs(t - 0.5)/0.001)", 1),
              ElementsAre(DoubleNear(0.499, 1e-14), DoubleNear(0.5, 1e-14), DoubleNear(0.501, 1e-14)));
  EXPECT_THAT(switches("max(0, min(1, (t - 5)*1e6))", 10),
              ElementsAre(DoubleNear(5, 1e-14), DoubleNear(5 + 1e-6, 1e-14)));
  EXPECT_EQ(switches("abs(sin(10*pi*t))", 1.05).size(), 11u);  // the start is one
  EXPECT_THAT(switches("abs(t^2 - 4)*exp(-t)", 3), ElementsAre(DoubleNear(2, 1e-14)));
  EXPECT_EQ(switches("acos(cos(10*pi*t))", 1.05).size(), 11u);
  EXPECT_THAT(switches("sqrt(1 - cos(pi*(t - 0.2)))", 3), ElementsAre(DoubleNear(0.2, 1e-15), DoubleNear(2.2, 1e-14)));
}

TEST(SwitchTimes, AreNotWhereNothingChanges) {
  for (const char* smooth : {"sin(t)", "3", "abs(2 + sin(300*t) + cos(300*t))", "abs((t - 0.5)^2)", "max(t, t)",
                             "max(0, -1 - t)", "min(2*t, 5)"})
    EXPECT_THAT(switches(smooth, 1), IsEmpty()) << smooth;
}

// Zero up to rounding is on no side, and hides no switch elsewhere.
TEST(SwitchTimes, AreNotMadeByRounding) {
  using ::testing::DoubleNear;
  using ::testing::ElementsAre;
  for (const char* zero : {"sin(t)^2 + cos(t)^2 - 1", "(t + 0.1) - t - 0.1", "3*t - t - 2*t"}) {
    for (const char* of : {"abs({})", "sign({})", "max(0, {})", "100*step({})"})
      EXPECT_THAT(switches(fmt::format(fmt::runtime(of), zero).c_str(), 7), IsEmpty()) << of << zero;
    EXPECT_THAT(switches(fmt::format("abs({}) + step(t - 4) - step(t - 4.002)", zero).c_str(), 7),
                ElementsAre(DoubleNear(4, 1e-14), DoubleNear(4.002, 1e-14)))
        << zero;
  }
  // Flat at its zero: a kink, not a swarm of them.
  EXPECT_THAT(switches("abs(t^3 - 1.5*t^2 + 0.75*t - 0.125)", 1), ElementsAre(DoubleNear(0.5, 1e-4)));
}

// Arguments that rounding makes zero at a few times in a row.
TEST(SwitchTimes, LeadOnToTheOtherSide) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> size(0.5, 5);
  for (int k = 0; k < 500; ++k) {
    const std::string text = fmt::format("abs({:.4g} - {:.4g}*t)", size(random), size(random));
    const Model model = compile(pushed(text.c_str()));
    const SwitchTimes::Switch found = SwitchTimes(model, 10).first(0, 10);
    ASSERT_LT(found.before, 10) << text;
    const Expression f = Expression::parse(text);
    EXPECT_EQ(f.at(found.after).fd, -f.at(found.before).fd) << text;
  }
}

}  // namespace
}  // namespace poinsot::test
