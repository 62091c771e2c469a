// How independent rows are, by the entries of the inverse that the factors' structure has room for, beside the whole
// inverse.
#include "integrators/stepping/unit_rows.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/body_sizes.h"
#include "core/scene_generator.h"
#include "formulations/registry.h"
#include "integrators/start/violation.h"
#include "tests/support/dense_problem.h"
#include "tests/support/large_scenes.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

Scene generated_scene(std::string_view kind, int bodies) {
  return find_scene_generator(kind)->make(bodies);
}

struct Placed {
  std::unique_ptr<Problem> problem;
  std::vector<double> q;
};

Placed placed(const Scene& scene, std::string_view formulation) {
  const auto model = std::make_shared<const Model>(compile(scene));
  const std::vector<BodyState> states = given_state(*model);
  Placed made{formulations().find(formulation)->make(model, {}), {}};
  made.q.resize(index(made.problem->nq()));
  std::vector<double> v(index(made.problem->nv()));
  made.problem->from_bodies(states, made.q, v);
  return made;
}

// G Gᵀ of rows of unit length.
Eigen::MatrixXd whole_square(Problem& problem) {
  MatrixX G = gradient(problem);
  const std::vector<double> sizes = body_sizes(problem.model());
  const Eigen::Index per_body = problem.nv() / problem.bodies();
  for (Eigen::Index j = 0; j < G.cols(); ++j)
    if (j % per_body >= 3) G.col(j) /= sizes[static_cast<std::size_t>(j / per_body)];
  G.rowwise().normalize();
  return G * G.transpose();
}

TEST(UnitRows, SharesAreThoseOfTheWholeInverse) {
  std::vector<Scene> scenes{generated_scene("ladder", 30), generated_scene("tree", 40), posts(1, 0.7, 0, false),
                            posts(12, 2, 0, false),        folding_crank(0.5),          folding_crank(1e-3)};
  for (const Scene& scene : scenes)
    for (const std::string& formulation : formulation_names()) {
      const Placed at = placed(scene, formulation);
      ASSERT_TRUE(UnitRows::has(*at.problem));
      const UnitRows rows(*at.problem, 0, at.q);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> square(whole_square(*at.problem));
      ASSERT_GT(square.eigenvalues()[0], 1e-8);
      const Eigen::MatrixXd inverse = square.operatorInverseSqrt() * square.operatorInverseSqrt();
      for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
        EXPECT_NEAR(rows.shares()[k] * std::sqrt(inverse(k, k)), 1, 1e-6);
        EXPECT_LT((rows.dependence(k) - inverse.col(k)).norm(), 1e-6 * inverse.col(k).norm());
      }
    }
}

TEST(UnitRows, ADependentRowHasNone) {
  Scene scene = generated_scene("chain", 5);
  scene.joints.push_back(scene.joints[2]);
  scene.joints.back().name = "again";
  const Placed at = placed(scene, "rA");
  const Eigen::VectorXd shares = UnitRows(*at.problem, 0, at.q).shares();
  for (Eigen::Index k = 0; k < shares.size(); ++k) {
    const Row& row = at.problem->model().rows[static_cast<std::size_t>(k)];
    const bool twice = row.group == 2 || row.group == 5;
    EXPECT_EQ(shares[k] < 1e-6, twice) << k;
  }
}

TEST(UnitRows, AreNotThoseOfAHubWithThousandsOfJoints) {
  EXPECT_TRUE(UnitRows::has(*placed(hub(Hub::four_bars, 100), "rA").problem));
  EXPECT_FALSE(UnitRows::has(*placed(hub(Hub::four_bars, 1000), "rA").problem));
}

}  // namespace
}  // namespace poinsot::test
