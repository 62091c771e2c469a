// Numbers with an exponent of 64 bits, and the expressions that need them: finite, while parts of them overflow.
#include "core/wide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/expression.h"

namespace poinsot::test {
namespace {

using W = Wide<double>;

TEST(Wide, AgreesWithDoubles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-5, 5), exponent(-40, 40);
  for (int k = 0; k < 2000; ++k) {
    const double x = any(random) * std::exp(exponent(random)), y = any(random) * std::exp(exponent(random));
    const double z = any(random), n = std::round(z);
    EXPECT_EQ(double(W(x) + W(y)), x + y);
    EXPECT_EQ(double(W(x) - W(y)), x - y);
    EXPECT_EQ(double(W(x) * W(y)), x * y);
    EXPECT_EQ(double(W(x) / W(y)), x / y);
    EXPECT_EQ(W(x) < W(y), x < y);
    EXPECT_EQ(W(x) >= W(y), x >= y);
    EXPECT_EQ(double(sqrt(W(std::abs(x)))), std::sqrt(std::abs(x)));
    EXPECT_EQ(double(pow(W(x), W(n))), std::pow(x, n));
    EXPECT_EQ(double(atan2(W(x), W(y))), std::atan2(x, y));
    EXPECT_DOUBLE_EQ(double(exp(W(40 * z))), std::exp(40 * z));
    EXPECT_NEAR(double(log(W(std::abs(x)))), std::log(std::abs(x)), 1e-14);
    EXPECT_NEAR(double(sinh(W(z))), std::sinh(z), 1e-13);
    EXPECT_NEAR(double(cosh(W(z))), std::cosh(z), 1e-13);
  }
}

TEST(Wide, GoesOnWhereDoublesEnd) {
  const W large = exp(W(1e5)), small = exp(W(-1e5));
  EXPECT_NEAR(double(large * small), 1, 1e-10);
  EXPECT_NEAR(double(log(large)), 1e5, 1e-9);
  EXPECT_NEAR(double(log(pow(large, W(-2.5)))), -2.5e5, 1e-8);
  EXPECT_NEAR(double(log(sqrt(small))), -0.5e5, 1e-9);
  EXPECT_EQ(double(large), std::numeric_limits<double>::infinity());
  EXPECT_EQ(double(-large), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(double(small), 0);
  EXPECT_EQ(double(large + 1 - large), 0);
  EXPECT_NEAR(double(atan2(large, 2 * large)), std::atan(0.5), 1e-15);
}

TEST(Wide, KeepsWhatIsNoNumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(double(W(1) / W(0)), infinity);
  EXPECT_EQ(double(W(infinity) + W(3)), infinity);
  EXPECT_EQ(double(W(3) / W(infinity)), 0);
  EXPECT_EQ(double(exp(W(infinity))), infinity);
  EXPECT_EQ(double(exp(W(-infinity))), 0);
  EXPECT_EQ(double(log(W(0))), -infinity);
  EXPECT_TRUE(std::isnan(double(W(0) * W(infinity))));
  EXPECT_TRUE(std::isnan(double(log(W(-1)))));
  EXPECT_TRUE(std::isnan(double(pow(W(-1), W(2.5)))));
  EXPECT_TRUE(std::isnan(double(W(infinity) - W(infinity))));
}

struct Ramp {
  const char* text;  // with k in the place of the factor
  Jet2<long double> (*exact)(long double k, long double x);
};

// s(kx), its derivative and its second one, without anything large.
Jet2<long double> logistic(long double k, long double x) {
  const long double e = std::exp(-std::abs(k * x)), s = x > 0 ? 1 / (1 + e) : e / (1 + e);
  const long double first = e / ((1 + e) * (1 + e));
  return {s, k * first, k * k * first * (x > 0 ? -1 : 1) * (1 - e) / (1 + e)};
}
Jet2<long double> softplus(long double k, long double x) {
  const Jet2<long double> s = logistic(k, x);
  return {std::max(x, 0.0L) + std::log1p(std::exp(-std::abs(k * x))) / k, s.f, s.fd};
}
Jet2<long double> log_cosh(long double k, long double x) {
  const Jet2<long double> s = logistic(2 * k, x);
  return {std::abs(x) + (std::log1p(std::exp(-2 * std::abs(k * x))) - std::log(2.0L)) / k, 2 * s.f - 1, 2 * s.fd};
}
Jet2<long double> per_cosh(long double k, long double x) {
  const long double e = std::exp(-std::abs(k * x)), f = 2 * e / (1 + e * e);
  const long double T = (x > 0 ? 1 : -1) * (1 - e * e) / (1 + e * e);
  return {f, -k * T * f, k * k * f * (2 * T * T - 1)};
}
// x/√(1 + x²) of x = exp(kx): 1/√(1 + exp(−2kx)).
Jet2<long double> algebraic(long double k, long double x) {
  const Jet2<long double> s = logistic(2 * k, x);
  if (s.f == 0) return {};
  const long double f = std::sqrt(s.f), fd = s.fd / (2 * f);
  return {f, fd, (s.fdd / 2 - fd * fd) / f};
}

TEST(Wide, ExpressionsThatOverflowOnTheWayHaveTheirDerivatives) {
  const Ramp ramps[] = {
      {"1/(1 + exp(-k*t))", logistic},
      {"exp(k*t)/(1 + exp(k*t))", logistic},
      {"exp(k*t)*(1 + exp(k*t))^-1", logistic},
      {"exp(k*t - log(1 + exp(k*t)))", logistic},
      {"(1 + exp(-k*t/3)^3)^-1", logistic},
      {"log(1 + exp(k*t))/k", softplus},
      {"log(cosh(k*t))/k", log_cosh},
      {"1/cosh(k*t)", per_cosh},
      {"exp(k*t)/sqrt(1 + exp(k*t)^2)", algebraic},
      {"exp(k*t)/sqrt(1 + exp(2*k*t))", algebraic},
      {"(1 + exp(-2*k*t))^-0.5", algebraic},
  };
  for (const auto& [text, exact] : ramps) {
    for (const double k : {30.0, 400.0, 1e3, 1e5}) {
      std::string written = text;
      const std::string factor = "(" + std::to_string(k) + ")";
      for (std::size_t at; (at = written.find('k')) != std::string::npos;) written.replace(at, 1, factor);
      const Expression f = Expression::parse(written);
      std::string of_x = written;
      for (std::size_t at = 0; (at = of_x.find('t', at)) != std::string::npos; ++at)
        if (of_x[at + 1] != '(') of_x.replace(at, 1, "x");
      const Expression law = Expression::parse_law(of_x);
      for (const double x : {-2.0, -0.93, -0.45, -0.02, 0.02, 0.45, 0.93, 2.0}) {
        SCOPED_TRACE(written + " at " + std::to_string(x));
        const Jet2<long double> right = exact(static_cast<long double>(k), static_cast<long double>(x));
        const Jet2<double> found = f.at(x);
        // exp(kx) has the digits of kx, and differences the digits of their terms.
        const double off = 1e-15 * (1 + k * std::abs(x));
        EXPECT_NEAR(found.f, double(right.f), off * (1 + double(right.f)));
        EXPECT_NEAR(found.fd, double(right.fd), off * k);
        EXPECT_NEAR(found.fdd, double(right.fdd), off * k * k);
        const LawValue<double> by_x = law.law(Arguments<double>{0, x, 0});
        EXPECT_NEAR(by_x.F_x, double(right.fd), off * k);
      }
    }
  }
}

// What begins at 0 with no slope is flat there: at its kink, and before it.
TEST(Wide, PowersOfWhatVanishesAreFlat) {
  for (const char* text : {"max(0, t - 0.5)^1.5", "max(0, t - 0.5)^1.999", "(max(0, t - 0.5)^2)^1.2"}) {
    const Jet2<double> f = Expression::parse(text).at(0.0);
    EXPECT_EQ(f.f, 0) << text;
    EXPECT_EQ(f.fd, 0) << text;
    EXPECT_EQ(f.fdd, 0) << text;
  }
  EXPECT_FALSE(std::isfinite(Expression::parse("t^1.5").at(0.0).fdd));
  EXPECT_FALSE(std::isfinite(Expression::parse("sqrt(t)").at(0.0).fd));
  EXPECT_FALSE(std::isfinite(Expression::parse("t^2.5").at(-1.0).f));
  EXPECT_FALSE(std::isfinite(Expression::parse("1/t").at(0.0).f));
  EXPECT_FALSE(std::isfinite(Expression::parse("1/(1/t)").at(0.0).fd));
}

}  // namespace
}  // namespace poinsot::test
