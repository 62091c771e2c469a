// Functions of time: values, exact derivatives, and the sentence that answers to text that is no expression.
#include "core/expression.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace poinsot {
namespace {

using std::numbers::pi;

TEST(Expression, follows_the_grammar) {
  const std::pair<const char*, double> cases[] = {{"1", 1},
                                                  {"-4.61538", -4.61538},
                                                  {".5", 0.5},
                                                  {"1e-3", 1e-3},
                                                  {" 2 * pi ", 2 * pi},
                                                  {"e", std::numbers::e},
                                                  {"1 - 2 - 3", -4},
                                                  {"8/4/2", 1},
                                                  {"1 + 2*3", 7},
                                                  {"(1 + 2)*3", 9},
                                                  {"-2^2", -4},
                                                  {"(-2)^2", 4},
                                                  {"(-2)^3", -8},
                                                  {"2^3^2", 512},
                                                  {"2^-1", 0.5},
                                                  {"2*-3", -6},
                                                  {"--2", 2},
                                                  {"+2", 2},
                                                  {"0^0", 1},
                                                  {"sqrt(2)/2", std::sqrt(2.0) / 2},
                                                  {"atan2(1, -1)", 3 * pi / 4},
                                                  {"pow(2, 0.5)", std::sqrt(2.0)},
                                                  {"min(1, max(-2, -3))", -2},
                                                  {"abs(-3)", 3}};
  for (const auto& [text, value] : cases) {
    EXPECT_DOUBLE_EQ(Expression::parse_constant(text).at(0.0).f, value) << text;
    EXPECT_TRUE(Expression::parse(text).is_constant()) << text;
    EXPECT_EQ(Expression::parse(text).at(7.0).fd, 0) << text;
  }
  EXPECT_EQ(Expression().at(1.0).f, 0);
  EXPECT_EQ(Expression(0.1).at(1.0).f, 0.1);
  EXPECT_EQ(Expression(0.1).text(), "0.1");
  EXPECT_EQ(Expression::parse("cos(pi*t)").text(), "cos(pi*t)");
  EXPECT_FALSE(Expression::parse("0*t").is_constant());
}

TEST(Expression, knows_derivatives_exactly) {
  struct Case {
    const char* text;
    double t, f, fd, fdd;
  };
  const Case cases[] = {
      {"t", 3, 3, 1, 0},
      {"t^2", 0, 0, 0, 2},
      {"t^3", -2, -8, 12, -12},
      {"t^1", 0, 0, 1, 0},
      {"t^0", 0, 1, 0, 0},
      {"t^-1", 2, 0.5, -0.25, 0.25},
      {"t^2.5", 4, 32, 20, 7.5},
      {"t^t", 1, 1, 1, 2},
      {"1/t", 2, 0.5, -0.25, 0.25},
      {"sqrt(t)", 4, 2, 0.25, -1.0 / 32},
      {"exp(2*t)", 0, 1, 2, 4},
      {"log(t)", 2, std::log(2.0), 0.5, -0.25},
      {"abs(t)", -2, 2, -1, 0},
      {"sqrt(t^2)", -2, 2, -1, 0},
      {"sqrt(t^2)", 0, 0, 1, 0},
      {"(t^4)^0.5", -2, 4, -4, 2},
      {"(t^2)^1.5", -2, 8, -12, 12},
      {"(t^2)^3", -1, 1, -6, 30},
      {"min(t, t^2)", 0.5, 0.25, 1, 2},
      {"max(t, t^2)", 0.5, 0.5, 1, 0},
      {"atan2(t, 1)", 1, pi / 4, 0.5, -0.5},
      {"atan2(sin(t), cos(t))", 2, 2, 1, 0},
      {"cos(pi*t)", 1, -1, 0, pi * pi},
      {"tanh(t)", 0, 0, 1, 0},
  };
  for (const Case& c : cases) {
    const Jet2<double> jet = Expression::parse(c.text).at(c.t);
    EXPECT_NEAR(jet.f, c.f, 1e-15 * (1 + std::abs(c.f))) << c.text;
    EXPECT_NEAR(jet.fd, c.fd, 4e-15 * (1 + std::abs(c.fd))) << c.text;
    EXPECT_NEAR(jet.fdd, c.fdd, 4e-15 * (1 + std::abs(c.fdd))) << c.text;
  }
}

TEST(Expression, knows_the_kinks_of_roots_of_even_powers) {
  for (const char* text : {"sqrt((t - 1)^2)", "((t - 1)^2)^0.5", "pow((t - 1)^2, 0.5)", "sqrt((t - 1)^6)"})
    EXPECT_EQ(Expression::parse(text).switch_count(), 1) << text;
  for (const char* text : {"sqrt((t - 1)^4)", "sqrt((t - 1)^3)", "((t - 1)^2)^2", "sqrt((t - 1)^2 + 1)", "(t^0.5)^2"})
    EXPECT_EQ(Expression::parse(text).switch_count(), 0) << text;
}

// Of roots and arcs that touch the end of their domain and turn back.
TEST(Expression, knows_the_kinks_of_waves_under_roots_and_arcs) {
  for (const char* text : {"acos(cos(3*t))", "asin(sin(t))", "acos(sin(t^2))", "asin(cos(t))", "sqrt(1 - cos(t))",
                           "sqrt(1 + cos(t))", "sqrt(2 - 2*cos(t))", "sqrt(3*(1 - sin(2*t)))", "sqrt((1 + sin(t))/2)",
                           "(1 - cos(t))^1.5", "sqrt(1 - sin(t)^2)", "sqrt(4 - 4*cos(t)^2)", "sqrt(-cos(t) + 1)",
                           "sqrt(-(cos(t) - 1))", "sqrt(cos(t)/2 + 0.5)"})
    EXPECT_EQ(Expression::parse(text).switch_count(), 1) << text;
  for (const char* text : {"acos(t)", "asin(sin(t)/2)", "acos(cos(t)*cos(t))", "sqrt(2 - cos(t))", "sqrt(cos(t) - 1)",
                           "sqrt(1 - cos(t)^3)", "sqrt(1 - t)", "sqrt(sin(t) + cos(t))", "(1 - cos(t))^2"})
    EXPECT_EQ(Expression::parse(text).switch_count(), 0) << text;
}

// Right at the kink, too, where the arcs' and the roots' own formulas would divide by rounding.
TEST(Expression, takes_waves_under_roots_and_arcs_to_rounding) {
  struct Case {
    const char* text;
    double t, f, fd, fdd;
  };
  const double at = 1e-9;
  for (const Case& c : {Case{"acos(cos(3*t))", at, 3 * at, 3, 0}, Case{"acos(cos(3*t))", -at, 3 * at, -3, 0},
                        Case{"sqrt(1 - cos(t))", at, at / std::sqrt(2.0), 1 / std::sqrt(2.0), 0},
                        Case{"sqrt(1 - cos(t))", -at, at / std::sqrt(2.0), -1 / std::sqrt(2.0), 0},
                        Case{"sqrt(8 - 8*cos(t)^2)", at, std::sqrt(8) * at, std::sqrt(8.0), 0}}) {
    const Jet2<double> f = Expression::parse(c.text).at(c.t);
    EXPECT_NEAR(f.f, c.f, 1e-24) << c.text;
    EXPECT_NEAR(f.fd, c.fd, 1e-15 * std::abs(c.fd)) << c.text;
    EXPECT_NEAR(f.fdd, c.fdd, 1e-8) << c.text;
  }
}

// Where there is no room for one more number on the stack, they stay what they are.
TEST(Expression, nests_waves_in_arcs_as_deep_as_all_else) {
  std::string text = "t", sums = "asin(sin(t))";
  for (int k = 0; k < 25; ++k) text = "acos(cos(" + text + "))";
  EXPECT_NEAR(Expression::parse(text).at(1.0).f, 1, 1e-12);
  for (int k = 0; k < 31; ++k) {
    EXPECT_NEAR(Expression::parse(sums).at(1.0).f, 1 + k, 1e-12) << k;
    sums = "(1 + " + sums + ")";
  }
  EXPECT_EQ(Expression::parse(sums).switch_count(), 0);
}

// Both sides of an identity are the same function, so their derivatives agree.
TEST(Expression, keeps_identities) {
  const std::pair<const char*, const char*> identities[] = {
      {"sin(3*t)^2 + cos(3*t)^2", "1"},
      {"tan(t)", "sin(t)/cos(t)"},
      {"asin(t/9)", "atan2(t/9, sqrt(1 - (t/9)^2))"},
      {"acos(t/9)", "pi/2 - asin(t/9)"},
      {"cosh(t)^2 - sinh(t)^2", "1"},
      {"tanh(t)", "sinh(t)/cosh(t)"},
      {"sinh(t)", "(exp(t) - exp(-t))/2"},
      {"exp(log(1 + t^2))", "1 + t^2"},
      {"(1 + t^2)^(t/2)", "exp(t/2*log(1 + t^2))"},
      {"atan(t)", "atan2(t, 1)"},
      {"abs(t - 5)", "max(t - 5, 5 - t)"},
      {"sqrt(1 + t^2)", "(1 + t^2)^0.5"},
      {"cos(pi/2 + (pi/4)*cos(2*t))", "-sin((pi/4)*cos(2*t))"},
      {"acos(cos(3*t))", "min(abs(3*t), 2*pi - abs(3*t))"},
      {"asin(sin(3*t))", "max(min(3*t, pi - 3*t), -pi - 3*t)"},
      {"acos(sin(2*t + 1))", "pi/2 - max(min(2*t + 1, pi - 2*t - 1), -pi - 2*t - 1)"},
      {"asin(cos(2*t + 1))", "pi/2 - min(abs(2*t + 1), 2*pi - abs(2*t + 1))"},
      {"sqrt(1 - cos(3*t))", "sqrt(2)*abs(sin(1.5*t))"},
      {"sqrt(3 + 3*cos(3*t))", "sqrt(6)*abs(cos(1.5*t))"},
      {"sqrt((1 - sin(2*t))/2)", "abs(sin(t - pi/4))"},
      {"sqrt((1 + sin(2*t))/2)", "abs(sin(t + pi/4))"},
      {"(2 - 2*cos(t))^1.5", "8*abs(sin(t/2))^3"},
      {"sqrt(1 - sin(2*t)^2)", "abs(cos(2*t))"},
      {"sqrt(5*(1 - cos(2*t)^2))", "sqrt(5)*abs(sin(2*t))"},
  };
  constexpr unsigned kSeed = 3;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> time(-1.4, 1.4);
  for (const auto& [left_text, right_text] : identities) {
    const Expression left = Expression::parse(left_text), right = Expression::parse(right_text);
    for (int k = 0; k < 50; ++k) {
      const double t = time(random);
      const Jet2<double> l = left.at(t), r = right.at(t);
      const std::string where = fmt::format("{} at t = {}, seed {}", left_text, t, kSeed);
      EXPECT_NEAR(l.f, r.f, 3e-14 * (1 + std::abs(r.f))) << where;
      EXPECT_NEAR(l.fd, r.fd, 3e-13 * (1 + std::abs(r.fd))) << where;
      EXPECT_NEAR(l.fdd, r.fdd, 3e-12 * (1 + std::abs(r.fdd))) << where;
    }
  }
}

// f(t + h) − f − h ḟ − h²/2 f̈ falls with h³, or faster: the slope of its logarithm shows a wrong derivative, which
// would make it 1 or 2. In long double, so that rounding stays away.
TEST(Expression, leaves_a_cubic_taylor_remainder) {
  std::vector<std::string> texts = {"(2 + sin(t))^(1.5 + cos(t))", "t*exp(-t)*cos(3*t)/(1 + t^2)",
                                    "2^t - t^3 + (1 - t)^-2"};
  for (const std::string_view name : Expression::function_names()) {
    const bool two = name == "atan2" || name == "pow" || name == "min" || name == "max";
    texts.push_back(two ? fmt::format("{}(2 + sin(2*t), 0.6 + 0.3*cos(t))", name)
                        : fmt::format("{}(0.5 + 0.3*sin(2*t))", name));
  }
  constexpr unsigned kSeed = 5;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> time(-0.7, 0.7);
  for (const std::string& text : texts) {
    const Expression expression = Expression::parse(text);
    for (int k = 0; k < 20; ++k) {
      const long double t = time(random);
      const Jet2<long double> jet = expression.at(t);
      const auto remainder = [&](long double h) {
        return std::abs(expression.at(t + h).f - jet.f - h * jet.fd - h * h / 2 * jet.fdd);
      };
      // The third derivative may vanish near t; then the remainder is smaller still, and the slope says nothing.
      const long double coarse = remainder(1e-2L), fine = remainder(1e-4L);
      EXPECT_LT(fine, 3e-5L * coarse + 1e-15L) << text << " at t = " << static_cast<double>(t) << ", seed " << kSeed
                                               << ", slope " << static_cast<double>(std::log10(coarse / fine) / 2);
    }
  }
}

TEST(Expression, evaluates_the_same_in_double_and_long_double) {
  const Expression f = Expression::parse("sin(pi/3 + t/7)*exp(-0.1*t)");
  for (const double t : {0.0, 0.3, 5.0}) {
    const Jet2<double> d = f.at(t);
    const Jet2<long double> l = f.at(static_cast<long double>(t));
    EXPECT_NEAR(d.f, static_cast<double>(l.f), 1e-15);
    EXPECT_NEAR(d.fd, static_cast<double>(l.fd), 1e-15);
    EXPECT_NEAR(d.fdd, static_cast<double>(l.fdd), 1e-15);
  }
}

TEST(Expression, says_what_is_wrong_and_where) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "expected a number, a name or '(' at character 1, found the end"},
      {"1 +", "expected a number, a name or '(' at character 4, found the end"},
      {"1 + * 2", "expected a number, a name or '(' at character 5, found '*'"},
      {"2pi", "expected an operator at character 2, found 'p'"},
      {"2 t", "expected an operator at character 3, found 't'"},
      {"(1 + t", "expected ')' at character 7, found the end"},
      {"1)", "expected an operator at character 2, found ')'"},
      {"sin t", "expected '(' at character 5, found 't'"},
      {"sin()", "expected a number, a name or '(' at character 5, found ')'"},
      {"sin(1, 2)", "expected ')' at character 6, found ','"},
      {"atan2(1)", "expected ',' at character 8, found ')'"},
      {"2*x",
       "unknown name 'x' at character 3; known are t, pi, e and the functions sin, cos, tan, asin, acos, atan, atan2, "
       "sinh, cosh, tanh, exp, log, sqrt, abs, pow, min, max, sign, step"},
      {"é", "expected a number, a name or '(' at character 1, found byte 0xC3"},
      {"1e999", "the number at character 1 is out of the range of a double"},
      {"t + 1/0", "the constant part that ends at character 7 is not finite"},
      {"sqrt(-1) + t", "the constant part that ends at character 8 is not finite"},
      {std::string(100000, '('), "nested too deeply at character 65"},
      {std::string(100000, '-') + "t", "nested too deeply at character 65"},
  };
  for (const auto& [text, message] : cases) {
    try {
      (void)Expression::parse(text);
      ADD_FAILURE() << text << " was taken for an expression";
    } catch (const ExpressionError& error) {
      EXPECT_EQ(error.what(), message) << text.substr(0, 40);
    }
  }
  EXPECT_THROW((void)Expression::parse_constant("2*t"), ExpressionError);
}

// The stack of an evaluation is bounded while parsing; long sums and products need next to none of it.
TEST(Expression, bounds_its_stack) {
  std::string sum = "t", nested = "t";
  for (int k = 0; k < 10000; ++k) sum += " + t*t";
  EXPECT_EQ(Expression::parse(sum).at(1.0).f, 10001);
  for (int k = 0; k < 31; ++k) nested = "t + (" + nested + ")";
  EXPECT_EQ(Expression::parse(nested).at(1.0).f, 32);
  EXPECT_THROW((void)Expression::parse("t + (" + nested + ")"), ExpressionError);
}

}  // namespace
}  // namespace poinsot
