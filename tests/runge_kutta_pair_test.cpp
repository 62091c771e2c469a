// The coefficients of the Runge–Kutta pairs satisfy the order conditions, one for every rooted tree, of the method, of
// its embedded solutions and of its dense output: nothing is taken from the literature on trust.
//
//   Σ_i b_i w_i(τ) = 1/γ(τ),   w(•) = 1, w([τ_1 … τ_m])_i = Π_k Σ_j a_ij w_j(τ_k),   γ([τ_1 … τ_m]) = |τ| Π_k γ(τ_k)
//
// (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", sec. II.2.) Dense output: s^|τ|/γ(τ).
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "integrators/methods/dop853.h"
#include "integrators/methods/dopri5.h"

namespace poinsot::test {
namespace {

using Vector = Eigen::VectorXd;

class Pair : public ::testing::TestWithParam<const RungeKuttaPair*> {
 protected:
  const RungeKuttaPair& pair() const { return *GetParam(); }
  Eigen::Index last() const { return static_cast<Eigen::Index>(pair().stages.size()); }
  Eigen::Index size() const { return last() + 1 + static_cast<Eigen::Index>(pair().dense_stages.size()); }

  Vector weights(Terms terms) const {
    Vector w = Vector::Zero(size());
    for (const Term& term : terms) w[term.stage] += term.weight;
    return w;
  }
  // With the row of k_{s+1}, which is b.
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size(), size());
    for (Eigen::Index i = 0; i < last(); ++i) A.row(i) = weights(pair().stages[static_cast<std::size_t>(i)].a);
    A.row(last()) = weights(pair().b);
    for (Eigen::Index i = last() + 1; i < size(); ++i) {
      A.row(i) = weights(pair().dense_stages[static_cast<std::size_t>(i - last() - 1)].a);
    }
    return A;
  }
  // Weights of y(t_n + s h) − y_n over h.
  Vector dense(double s) const {
    const Vector first = Vector::Unit(size(), 0), fsal = Vector::Unit(size(), last()), b = weights(pair().b);
    std::vector<Vector> r{b, first - b, 2 * b - first - fsal};
    for (Terms d : pair().dense) r.push_back(weights(d));
    Vector y = Vector::Zero(size());
    for (std::size_t i = r.size(); i-- > 0;) y = (i % 2 == 0 ? s : 1 - s) * (r[i] + y);
    return y;
  }

  struct Tree {
    int order;
    double gamma;
    Vector w;
  };
  // All rooted trees up to `highest`: 1, 1, 2, 4, 9, 20, 48, 115, 286 of order 1 to 9.
  std::vector<Tree> trees(int highest) const {
    const Eigen::MatrixXd A = matrix();
    std::vector<Tree> all{{1, 1, Vector::Ones(size())}};
    for (int order = 2; order <= highest; ++order) {
      const std::size_t known = all.size();
      // children with indices that do not grow: every multiset once
      const auto grow = [&](auto&& self, int left, std::size_t allowed, double gamma, const Vector& w) -> void {
        if (left == 0) {
          all.push_back({order, order * gamma, w});
          return;
        }
        for (std::size_t k = 0; k < allowed; ++k) {
          if (all[k].order > left) break;
          const Tree child = all[k];
          self(self, left - child.order, k + 1, gamma * child.gamma, w.cwiseProduct(A * child.w));
        }
      };
      grow(grow, order - 1, known, 1, Vector::Ones(size()));
    }
    return all;
  }
  // The largest violated condition of each order.
  std::vector<double> defects(const Vector& b, double s, int highest) const {
    std::vector<double> worst(static_cast<std::size_t>(highest) + 1, 0.0);
    for (const Tree& tree : trees(highest)) {
      double& defect = worst[static_cast<std::size_t>(tree.order)];
      defect = std::max(defect, std::abs(b.dot(tree.w) - std::pow(s, tree.order) / tree.gamma));
    }
    return worst;
  }
  // Order `order`, and no more.
  void expect_order(const Vector& b, int order, double s, double rounding) const {
    const std::vector<double> worst = defects(b, s, order + 1);
    for (int k = 1; k <= order; ++k) {
      EXPECT_LT(worst[static_cast<std::size_t>(k)], rounding) << "conditions of order " << k << ", s = " << s;
    }
    EXPECT_GT(worst.back(), 1e3 * rounding) << "s = " << s;
  }
};

INSTANTIATE_TEST_SUITE_P(All, Pair, ::testing::Values(&dopri5_pair(), &dop853_pair()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(Pair, HasAllTrees) {
  int count[9] = {};
  for (const Tree& tree : trees(8)) ++count[tree.order];
  const int known[9] = {0, 1, 1, 2, 4, 9, 20, 48, 115};
  for (int order = 1; order <= 8; ++order) EXPECT_EQ(count[order], known[order]) << order;
}

TEST_P(Pair, NodesAreTheRowSums) {
  const Vector sums = matrix().rowwise().sum();
  for (Eigen::Index i = 0; i < last(); ++i) {
    EXPECT_NEAR(sums[i], pair().stages[static_cast<std::size_t>(i)].c, 1e-14) << i;
  }
  for (Eigen::Index i = last() + 1; i < size(); ++i) {
    EXPECT_NEAR(sums[i], pair().dense_stages[static_cast<std::size_t>(i - last() - 1)].c, 1e-14) << i;
  }
  EXPECT_EQ(pair().stages.back().c, 1);
}

TEST_P(Pair, StagesUseEarlierOnesOnly) {
  const Eigen::MatrixXd A = matrix();
  for (Eigen::Index i = 0; i < size(); ++i) {
    for (Eigen::Index j = i; j < size(); ++j) EXPECT_EQ(A(i, j), 0) << i << ' ' << j;
  }
}

TEST_P(Pair, HasItsOrder) {
  expect_order(weights(pair().b), pair().order, 1, 1e-14);
}

TEST_P(Pair, EmbeddedSolutionsHaveTheirOrders) {
  const Vector b = weights(pair().b);
  expect_order(b - weights(pair().error), pair().order == 8 ? 5 : 4, 1, 1e-14);
  if (pair().order == 8) expect_order(b - weights(pair().third_order_error), 3, 1, 1e-14);
}

TEST_P(Pair, DenseOutputHasItsOrder) {
  for (const double s : {0.13, 0.3, 0.5, 0.72, 0.9}) expect_order(dense(s), pair().order == 8 ? 7 : 4, s, 1e-13);
  EXPECT_LT((dense(1) - weights(pair().b)).norm(), 1e-14);
  EXPECT_EQ(dense(0).norm(), 0);
}

}  // namespace
}  // namespace poinsot::test
