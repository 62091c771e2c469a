// The stabilized index-2 system: its matrix against differences of its residual, and that the motion satisfies it.
#include "integrators/stepping/stabilized_index2.h"

#include <gtest/gtest.h>

#include "tests/scale.h"
#include "tests/support/dense_problem.h"
#include "tests/support/random_model.h"

namespace poinsot::test {
namespace {

// At a random state with Euler parameters off the unit sphere, and μ = 0.
struct Standing {
  Standing(Random& random, Problem& of) : form(of), y(random.vector(form.size())), y_dot(random.vector(form.size())) {
    y.tail(of.nc()).setZero();
  }
  VectorX residual(double t, const VectorX& at, const VectorX& rate) {
    VectorX F(form.size());
    form.residual(t, view(at), view(rate), view(F));
    return F;
  }
  MatrixX matrix(double t, double alpha) {
    const Pattern pattern = form.pattern();
    MatrixX m = MatrixX::Zero(pattern.n, pattern.n);
    std::vector<int> slots;
    for (const Block& block : pattern.blocks) slots.push_back(block.col * pattern.n + block.row);
    form.assemble(t, alpha, view(y), view(y_dot), slots, {m.data(), static_cast<std::size_t>(m.size())});
    return m;
  }

  StabilizedIndex2 form;
  VectorX y, y_dot;
};

TEST(StabilizedIndex2, MatrixIsTheDerivativeOfTheResidual) {
  for (int seed = 0; seed < scaled(40); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    const auto problem = make_problem("rp", random_model(random, 3));
    Standing at(random, *problem);
    const double t = random.uniform(-2, 2), alpha = random.uniform(1, 20);
    const VectorX direction = random.vector(at.form.size());
    const VectorX expected = at.matrix(t, alpha) * direction;
    // The remainder of central differences is of second order.
    const auto remainder = [&](double epsilon) {
      const VectorX d = epsilon * direction;
      const VectorX difference =
          at.residual(t, at.y + d, at.y_dot + alpha * d) - at.residual(t, at.y - d, at.y_dot - alpha * d);
      return (difference / (2 * epsilon) - expected).norm() / expected.norm();
    };
    EXPECT_LT(remainder(1e-4), 1e-5);
    EXPECT_GT(std::log2(remainder(4e-3) / remainder(2e-3)), 1.9);
  }
}

// Each unknown is looked for in a solver's message under a name it has in the problem.
TEST(StabilizedIndex2, UnknownsAreThoseOfTheProblem) {
  Random random(1);
  const auto problem = make_problem("rp", random_model(random, 3));
  const StabilizedIndex2 form(*problem);
  const std::vector<int> of = form.unknowns();
  ASSERT_EQ(static_cast<int>(of.size()), form.size());
  for (int k : of) EXPECT_TRUE(k >= 0 && k < problem->nv() + problem->nc());
}

}  // namespace
}  // namespace poinsot::test
