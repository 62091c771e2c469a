// What polynomials in a law may hide: the terms beside them, which add up to the rest.
#include <gtest/gtest.h>

#include <cmath>

#include "core/expression.h"

namespace poinsot::test {
namespace {

std::vector<Expression> terms_of(const char* law) {
  return Expression::parse_law(law).hidden_terms();
}

// Differences of the whole over x, v and t, but for those of the polynomial that is left out.
TEST(ExpressionTerms, AddUpToTheWholeButForAPolynomial) {
  struct Case {
    const char* law;
    double (*polynomial)(double x, double v, double t);
  };
  const Case cases[] = {
      {"100*x - 95*exp(-((x + 0.3)/0.01)^2)", [](double x, double, double) { return 100 * x; }},
      {"3 + 2*x^3 - (x - v)*4 + tanh(v/0.1)", [](double x, double v, double) { return 2 * x * x * x - 4 * (x - v); }},
      {"-(x + exp(x) - (sin(v) - t))", [](double x, double, double t) { return -x - t; }},
      {"x*(1 + exp(-x^2)) - 7", [](double x, double, double) { return x; }},
      {"x + sin(x) + sin(2*x) + sin(3*x)", [](double x, double, double) { return x; }}};
  for (const auto& [law, polynomial] : cases) {
    const Expression whole = Expression::parse_law(law);
    const std::vector<Expression> terms = whole.hidden_terms();
    ASSERT_FALSE(terms.empty()) << law;
    const Arguments<double> a{0.3, 0.2, -0.7}, b{1.1, -0.4, 0.5};
    const double left_out = polynomial(a.x, a.v, a.t) - polynomial(b.x, b.v, b.t);
    const double change = whole.law(a).F - whole.law(b).F - left_out;
    EXPECT_NEAR(terms[0].law(a).F - terms[0].law(b).F, change, 1e-12) << law;
    double each = 0;
    for (std::size_t k = 1; k < terms.size(); ++k) each += terms[k].law(a).F - terms[k].law(b).F;
    if (terms.size() > 1) {
      EXPECT_NEAR(each, change, 1e-12) << law;
    }
    for (const Expression& term : terms) EXPECT_EQ(term.text(), law);
  }
}

TEST(ExpressionTerms, AreThoseThatAreNoPolynomials) {
  const std::pair<const char*, std::size_t> cases[] = {{"100*x - 3*x^3 + 2*v + t", 0},
                                                       {"100*x - 95*exp(-x^2)", 1},
                                                       {"100*x - 95*exp(-((x - (-0.3))/0.01)^2)", 1},
                                                       {"-exp(x - (-0.3))", 0},
                                                       {"x + x^3 + exp(x) - tanh(v) + 5", 3},
                                                       {"x*(1 + exp(-x^2))", 1},
                                                       {"exp(x + v)", 0},
                                                       {"sin(x) + cos(x)", 3},
                                                       {"(x + exp(x))*(v + sin(v))", 1 + 3}};
  for (const auto& [law, terms] : cases) EXPECT_EQ(terms_of(law).size(), terms) << law;
}

// What would be too many terms multiplied out stays a product, with nothing beside it.
TEST(ExpressionTerms, OfTooManyAreNone) {
  const auto terms = terms_of("(x + exp(x) + sin(x) + cos(x) + tan(x))*(v + exp(v) + sin(v) + cos(v) + tan(v))");
  EXPECT_TRUE(terms.empty());
}

TEST(ExpressionTerms, DependOnWhatTheyAreOf) {
  const auto terms = terms_of("100*x + exp(-(v/0.1)^2)");
  ASSERT_EQ(terms.size(), 1u);
  EXPECT_TRUE(terms[0].depends_on_rate());
  EXPECT_FALSE(terms[0].depends_on_elongation());
}

}  // namespace
}  // namespace poinsot::test
