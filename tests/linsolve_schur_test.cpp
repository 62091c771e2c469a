// What the Schur complement solver refuses, and in which words; that runs with it tell the user.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene_generator.h"
#include "core/scene_reader.h"
#include "integrators/simulate.h"
#include "linsolve/registry.h"
#include "linsolve/sparse_ldlt.h"

namespace poinsot {
namespace {

using testing::HasSubstr;

Outcome run(const Scene& scene, const char* formulation, const char* jacobian, const char* integrator,
            Analysis analysis = Analysis::dynamics) {
  Settings settings;
  settings.analysis = analysis;
  settings.linear_solver = "schur";
  settings.formulation = formulation;
  settings.jacobian = jacobian;
  settings.integrator = integrator;
  settings.end = 0.01;
  return simulate(scene, settings, {});
}

Scene model(const std::string& name) {
  return read_scene(std::string(POINSOT_SOURCE_DIR) + "/models/" + name + ".json");
}

TEST(Schur, RunsWhereTheMatrixIsSymmetric) {
  for (const char* name : {"chain", "tree", "ladder", "four_bars"}) {
    const Scene scene = find_scene_generator(name)->make(12);
    for (const char* formulation : {"rp", "reps"}) {
      const Outcome outcome = run(scene, formulation, "simplified", "implicit_euler");
      EXPECT_TRUE(outcome.status.ok()) << name << ' ' << formulation << ": " << outcome.status.message;
    }
    const Outcome outcome = run(scene, "rA", "exact", "half_implicit");
    EXPECT_TRUE(outcome.status.ok()) << name << ": " << outcome.status.message;
  }
}

TEST(Schur, SaysWhyItRefuses) {
  const Scene chain = find_scene_generator("chain")->make(4);
  const Status coupled = run(chain, "rA", "exact", "implicit_euler").status;
  EXPECT_EQ(coupled.failure, Failure::refused);
  EXPECT_EQ(coupled.message,
            "linear solver schur needs a block of its own for each body, and here bodies are coupled; block takes this "
            "matrix");
  EXPECT_THAT(run(model("heavy_top"), "rA", "simplified", "implicit_euler").status.message,
              HasSubstr("schur needs a symmetric matrix, and this one is not; block takes it"));
  EXPECT_THAT(run(model("four_link"), "rp", "simplified", "implicit_euler").status.message,
              HasSubstr("schur needs inertia in every direction (block does not), and there is none near body"));
  EXPECT_THAT(run(model("slider_crank"), "rA", "exact", "", Analysis::kinematics).status.message,
              HasSubstr("schur needs multipliers, which a matrix of kinematics does not have; klu takes it"));
}

// Two cliques that share unknown 1; LDLᵀ of their sum, and the unknown a dependent row leaves without a pivot.
TEST(SparseLdlt, SolvesASumOfCliques) {
  SparseLdlt ldlt;
  const std::vector<int> start{0, 2, 4}, member{0, 1, 1, 2};
  ASSERT_TRUE(ldlt.analyze(3, start, member));
  const auto write = [&](std::initializer_list<double> entries) {
    std::ranges::fill(ldlt.values(), 0.0);
    std::size_t k = 0;
    for (const double x : entries) ldlt.values()[static_cast<std::size_t>(ldlt.places()[k++])] += x;
    ldlt.factor();
  };
  write({2, 1, 3, 1, -1, 4});  // [2 1 0; 1 4 −1; 0 −1 4]
  EXPECT_EQ(ldlt.cancelled(1e-14), -1);
  std::vector<double> x{4, 6, 10};
  ldlt.solve(x);
  EXPECT_NEAR(x[0], 1, 1e-15);
  EXPECT_NEAR(x[1], 2, 1e-15);
  EXPECT_NEAR(x[2], 3, 1e-15);
  write({4, 2, 1, 0, 0, 1});  // rows 0 and 1 are dependent
  EXPECT_THAT(ldlt.cancelled(1e-14), testing::AnyOf(0, 1));
}

}  // namespace
}  // namespace poinsot
