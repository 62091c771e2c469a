// What expressions hold beside a function of time: laws in x, v and t, switches, tables, and why a value is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "core/expression.h"

namespace poinsot {
namespace {

using testing::ElementsAre;

class Names : public ExpressionNames {
 public:
  std::map<std::string, double, std::less<>> parameters;
  std::map<std::string, std::shared_ptr<const Spline>, std::less<>> tables;

  std::optional<double> parameter(std::string_view name) override {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::nullopt : std::optional(found->second);
  }
  std::shared_ptr<const Spline> table(std::string_view name) override {
    const auto found = tables.find(name);
    return found == tables.end() ? nullptr : found->second;
  }
  std::string listed() const override { return ", the parameter l and the table road"; }
};

Names names() {
  Names names;
  names.parameters = {{"l", 1.5}, {"rate", -2}};
  names.tables = {{"road", std::make_shared<const Spline>("road", std::vector{0.0, 1.0, 2.0, 4.0},
                                                          std::vector{0.0, 1.0, 0.5, -1.0})}};
  return names;
}

template <class Parse>
std::string error_in(Parse parse) {
  try {
    (void)parse();
  } catch (const ExpressionError& error) {
    return error.what();
  }
  return "";
}

// Central differences in long double: truncation and rounding both stay near 1e-13.
TEST(ExpressionLaw, has_the_partial_derivatives_of_its_function) {
  Names with = names();
  const char* laws[] = {"1e3*x + 5e4*x^3 + 10*v",
                        "l*sin(x*v) + v^2*t",
                        "exp(-x^2)*tanh(rate*v)/(1 + t^2)",
                        "road(x + 1)*v + max(x, v)",
                        "2",
                        "x",
                        "sign(v)*(1 + 0.5*exp(-abs(v)))"};
  constexpr unsigned kSeed = 11;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<long double> number(-0.9L, 0.9L);
  for (const char* text : laws) {
    const Expression law = Expression::parse_law(text, &with);
    for (int k = 0; k < 30; ++k) {
      const Arguments<long double> at{number(random), number(random), number(random)};
      const LawValue<long double> value = law.law(at);
      constexpr long double h = 1e-6L;
      const auto slope = [&](long double Arguments<long double>::*member) {
        Arguments<long double> before = at, after = at;
        before.*member -= h, after.*member += h;
        return (law.law(after).F - law.law(before).F) / (2 * h);
      };
      const long double F_x = slope(&Arguments<long double>::x), F_v = slope(&Arguments<long double>::v);
      EXPECT_NEAR(static_cast<double>(value.F_x), static_cast<double>(F_x), 1e-9 * (1 + std::abs(double(F_x)))) << text;
      EXPECT_NEAR(static_cast<double>(value.F_v), static_cast<double>(F_v), 1e-9 * (1 + std::abs(double(F_v)))) << text;
    }
  }
  EXPECT_TRUE(Expression::parse_law("x + v").depends_on_rate());
  EXPECT_FALSE(Expression::parse_law("x + t").depends_on_rate());
  EXPECT_TRUE(Expression::parse_law("x + t").depends_on_time());
  EXPECT_FALSE(Expression::parse_law("x + v").depends_on_time());
  EXPECT_EQ(Expression::parse_law("x + 2*v + 4*t").law<double>({1, 2, 3}).F, 12);
}

TEST(ExpressionLaw, uses_the_names_of_the_scene) {
  Names with = names();
  EXPECT_EQ(Expression::parse_constant("2*l", &with).at(0.0).f, 3);
  EXPECT_EQ(Expression::parse("l*t + rate", &with).at(2.0).f, 1);
  EXPECT_EQ(Expression::parse_constant("road(l - 0.5)", &with).at(0.0).f, 1);
  EXPECT_EQ(Expression::parse("road(2*t)", &with).at(0.5).f, 1);
  EXPECT_THAT(error_in([&] { return Expression::parse("2*m", &with); }),
              testing::StartsWith("unknown name 'm' at character 3; known are t, pi, e, the parameter l and the table "
                                  "road and the functions sin, "));
  EXPECT_THAT(error_in([&] { return Expression::parse("x", &with); }), testing::StartsWith("unknown name 'x'"));
  EXPECT_EQ(error_in([&] { return Expression::parse_constant("road(5)", &with); }),
            "table 'road' has no value at 5: its points go from 0 to 4");
  EXPECT_EQ(error_in([&] { return Expression::parse_constant("road(4 + 1e-12)", &with); }),
            "table 'road' has no value at 4.0000000000010001: its points go from 0 to 4");
  EXPECT_EQ(error_in([&] { return Expression::parse("road", &with); }), "expected '(' at character 5, found the end");
  with.parameters["v"] = 3;
  EXPECT_EQ(Expression::parse("v*t", &with).at(2.0).f, 6);
  EXPECT_EQ(error_in([&] { return Expression::parse_law("x + v", &with); }),
            "'v' at character 5 is a parameter, and in a law the rate; give the parameter another name");
  for (const char* free : {"l", "x", "v", "l_1", "_", "Pi", "stiffness"}) EXPECT_EQ(Expression::why_no_name(free), "");
  for (const char* no : {"", "2l", "l-1", "é"})
    EXPECT_EQ(Expression::why_no_name(no), "no name that expressions can hold (letters, digits and _, a letter first)");
  EXPECT_EQ(Expression::why_no_name("t"), "the time in expressions");
  EXPECT_EQ(Expression::why_no_name("pi"), "a constant of expressions");
  EXPECT_EQ(Expression::why_no_name("step"), "a function of expressions");
}

TEST(ExpressionLaw, tells_where_it_switches) {
  const auto switches = [](const char* text, double t) {
    const Expression f = Expression::parse(text);
    std::vector<double> values(static_cast<std::size_t>(f.switch_count()));
    f.switches(t, values);
    return values;
  };
  EXPECT_THAT(switches("abs(t - 1)", 3), ElementsAre(2.0));
  EXPECT_THAT(switches("max(t, 2) + sign(1 - t)*step(2*t - 8)", 3), ElementsAre(1.0, -2.0, -2.0));
  EXPECT_THAT(switches("min(t, abs(t - 5))", 1), ElementsAre(-4.0, -3.0));
  EXPECT_THAT(switches("sin(t)^2 + abs(-3)", 1), ElementsAre());
  EXPECT_THAT(switches("7", 1), ElementsAre());
  const Expression law = Expression::parse_law("max(0, x) + 3*sign(v)");
  std::vector<double> values(2);
  law.switches({0, -0.5, 0.25}, values);
  EXPECT_THAT(values, ElementsAre(0.5, 0.25));
}

TEST(ExpressionLaw, steps_where_its_argument_changes_sign) {
  const Expression step = Expression::parse("step(t - 1)"), sign = Expression::parse("sign(t - 1)");
  const double before = std::nextafter(1.0, 0.0);
  EXPECT_EQ(step.at(before).f, 0);
  EXPECT_EQ(step.at(1.0).f, 1);
  EXPECT_EQ(step.at(1.0).fd, 0);
  EXPECT_EQ(sign.at(before).f, -1);
  EXPECT_EQ(sign.at(1.0).f, 0);
  EXPECT_EQ(sign.at(2.0).f, 1);
}

// No function makes a number of what is none: a table asked outside its points stays visible.
TEST(ExpressionLaw, keeps_what_is_not_a_number) {
  Names with = names();
  for (const char* text :
       {"min(road(t), 0)", "min(0, road(t))", "max(road(t), 9)", "max(9, road(t))", "road(t)^0", "1^road(t)",
        "road(t)^t", "sign(road(t))", "step(road(t))", "abs(road(t))", "atan2(1, road(t))"})
    EXPECT_TRUE(std::isnan(Expression::parse(text, &with).at(4.5).f)) << text;
}

TEST(ExpressionLaw, says_why_a_value_is_not_finite) {
  Names with = names();
  EXPECT_EQ(Expression::parse("1/(t - 1)").fault(1, 2), "'1/(t - 1)' is not finite");
  EXPECT_EQ(Expression::parse("1/(t - 1)").fault(2, 2), "");
  EXPECT_EQ(Expression::parse("sqrt(t)").fault(0, 0), "");
  EXPECT_EQ(Expression::parse("sqrt(t)").fault(0, 2), "the first derivative of 'sqrt(t)' is not finite");
  EXPECT_EQ(Expression::parse("t^1.5").fault(0, 2), "the second derivative of 't^1.5' is not finite");
  EXPECT_EQ(Expression::parse("2 + road(2*t)", &with).fault(3, 2),
            "'2 + road(2*t)': table 'road' has no value at 6: its points go from 0 to 4");
  const Expression law = Expression::parse_law("sqrt(x) + v");
  EXPECT_EQ(law.law_fault({0, 1, 0}), "");
  EXPECT_EQ(law.law_fault({0, -1, 2}), "'sqrt(x) + v' is not finite at x = -1, v = 2");
  EXPECT_EQ(law.law_fault({0, 0, 2}), "the derivative with x of 'sqrt(x) + v' is not finite at x = 0, v = 2");
}

}  // namespace
}  // namespace poinsot
