// Expressions as sums: their terms add up to them but for a constant, and are no more than they have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/expression.h"

namespace poinsot::test {
namespace {

std::vector<Expression> terms_of(const char* law) {
  return Expression::parse_law(law).terms();
}

double sum_of(const std::vector<Expression>& terms, const Arguments<double>& at) {
  double sum = 0;
  for (const Expression& term : terms) sum += term.law(at).F;
  return sum;
}

TEST(ExpressionTerms, AddUpToTheWholeButForAConstant) {
  constexpr const char* kLaws[] = {"100*x - 95*exp(-((x + 0.3)/0.01)^2)",
                                   "3 + 2*x^3 - (x - v)*4 + tanh(v/0.1)",
                                   "-(x + exp(x) - (sin(v) - t))",
                                   "(x + exp(x))*(2 - cos(v))/(1 + x^2) - 7",
                                   "x*v",
                                   "sin(x) + sin(2*x) + sin(3*x)"};
  for (const char* law : kLaws) {
    const Expression whole = Expression::parse_law(law);
    const std::vector<Expression> terms = whole.terms();
    const Arguments<double> here{0.3, 0.2, -0.7}, there{1.1, -0.4, 0.5};
    EXPECT_NEAR(sum_of(terms, here) - sum_of(terms, there), whole.law(here).F - whole.law(there).F, 1e-12) << law;
    for (const Expression& term : terms) EXPECT_EQ(term.text(), law);
  }
}

TEST(ExpressionTerms, ArePolynomialsAsOneAndTheOthers) {
  const std::pair<const char*, std::size_t> cases[] = {
      {"100*x - 3*x^3 + 2*v + t", 1}, {"100*x - 95*exp(-x^2)", 2}, {"x + x^3 + exp(x) - tanh(v) + 5", 3},
      {"x*(1 + exp(-x^2))", 2},       {"exp(x + v)", 1},           {"(x + exp(x))*(v + sin(v))", 4}};
  for (const auto& [law, terms] : cases) EXPECT_EQ(terms_of(law).size(), terms) << law;
}

// What would be too many terms multiplied out stays a product.
TEST(ExpressionTerms, OfTooManyAreTheWhole) {
  const auto terms = terms_of("(x + exp(x) + sin(x) + cos(x) + tan(x))*(v + exp(v) + sin(v) + cos(v) + tan(v))");
  EXPECT_EQ(terms.size(), 1u);
}

TEST(ExpressionTerms, DependOnWhatTheyAreOf) {
  const auto terms = terms_of("100*x + exp(-(v/0.1)^2)");
  ASSERT_EQ(terms.size(), 2u);
  const auto by_rate = std::ranges::find_if(terms, &Expression::depends_on_rate);
  ASSERT_NE(by_rate, terms.end());
  EXPECT_FALSE(by_rate->depends_on_elongation());
}

}  // namespace
}  // namespace poinsot::test
