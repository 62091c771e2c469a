// Bounds of expressions over a stretch of time: they hold what the expression and its derivatives come to at any time
// of it, and are close where it is short.
#include "core/expression_range.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/expression.h"

namespace poinsot::test {
namespace {

// Every function, of something that bends, in the middle of where it is defined.
std::vector<std::string> texts() {
  std::vector<std::string> all{"3 - t + 2*t^2 - t^3/4",
                               "(1.5 + sin(t))^(t/3)",
                               "(2 + t)^-1.5",
                               "sin(t)/(2 + cos(3*t))",
                               "acos(cos(5*t))",
                               "asin(sin(5*t))",
                               "acos(sin(2*t^2))",
                               "sqrt(1 - cos(4*t))",
                               "sqrt(1 - sin(3*t)^2)",
                               "abs(sin(4*t))*exp(-t)",
                               "max(t, t^2)*min(sin(t), 0.3)",
                               "1e3*(t - 0.5) - 1e3*t + tanh(5*t)"};
  for (const std::string_view name : Expression::function_names()) {
    const bool two = name == "atan2" || name == "pow" || name == "min" || name == "max";
    const bool above_zero = name == "log" || name == "sqrt" || name == "pow" || name == "atan2";
    const std::string argument = above_zero ? "2 + t + sin(3*t)/4" : "sin(3*t)/4 + t/4";
    all.push_back(fmt::format("{}({}{})", name, argument, two ? ", 0.4*cos(t) - t/7" : ""));
  }
  return all;
}

bool holds(Bounds b, double x) {
  const double rounding = 1e-13 * (1 + std::abs(x));
  return b.is_unknown() || (b.least <= x + rounding && x - rounding <= b.most);
}

TEST(ExpressionRange, HoldsWhatTheExpressionComesTo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> time(-1, 1), part(0, 1), digits(-6, 0);
  for (const std::string& text : texts()) {
    const Expression f = Expression::parse(text);
    std::vector<double> switches(static_cast<std::size_t>(f.switch_count()));
    for (int k = 0; k < 300; ++k) {
      const double from = time(random), to = from + std::pow(10, digits(random));
      const Arguments<Bounds> at{{from, to}, {}, {}};
      const Jet2<Bounds> bounds = f.range(at);
      for (int n = 0; n < 10; ++n) {
        const double t = n == 0 ? from : n == 1 ? to : from + part(random) * (to - from);
        const Jet2<double> jet = f.at(t);
        ASSERT_TRUE(holds(bounds.f, jet.f)) << text << ", " << from << " to " << to << ", f at " << t;
        ASSERT_TRUE(holds(bounds.fd, jet.fd)) << text << ", " << from << " to " << to << ", df/dt at " << t;
        ASSERT_TRUE(holds(bounds.fdd, jet.fdd)) << text << ", " << from << " to " << to << ", d2f/dt2 at " << t;
        f.switches(t, switches);
        for (std::size_t s = 0; s < switches.size(); ++s)
          ASSERT_TRUE(holds(f.switch_range(static_cast<int>(s), at), switches[s])) << text << ", switch at " << t;
      }
    }
  }
}

// Of a stretch of 1e-5 s some times what the derivatives make of it, but where terms cancel that are a thousand times
// as large; of an angle's value no more than a turn is known.
TEST(ExpressionRange, IsCloseOverAShortStretch) {
  constexpr double h = 1e-5;
  for (const std::string& text : texts()) {
    if (text.starts_with("1e3")) continue;
    const Expression f = Expression::parse(text);
    for (const double t : {-0.731, -0.212, 0.113, 0.547, 0.893}) {
      const Jet2<Bounds> bounds = f.range({{t, t + h}, {}, {}});
      const Jet2<double> jet = f.at(t);
      const double steep = 10 * (1 + std::abs(jet.fd) + std::abs(jet.fdd));
      if (!text.starts_with("atan2")) {
        EXPECT_LT(bounds.f.most - bounds.f.least, 10 * steep * h) << text << " at " << t;
      }
      EXPECT_LT(bounds.fd.most - bounds.fd.least, 100 * steep * h) << text << " at " << t;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
