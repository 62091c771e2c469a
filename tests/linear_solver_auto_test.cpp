// What auto picks, on the matrices of real mechanisms, and that it says so.
#include <gtest/gtest.h>

#include "core/scene_generator.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/simulate.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

std::string_view pick(const Scene& scene, const FormulationEntry& formulation, MatrixKind kind) {
  const auto problem = formulation.make(std::make_shared<const Model>(compile(scene)), {});
  const auto solver = linear_solvers().require("auto").make();
  EXPECT_EQ(solver->picked(), "");
  EXPECT_TRUE(solver->analyze(problem->pattern(kind)).ok());
  return solver->picked();
}

Scene model(const std::string& name) {
  return read_scene(std::string(POINSOT_SOURCE_DIR) + "/models/" + name + ".json");
}

TEST(Auto, LeavesSaddlePointsToBlock) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const MatrixKind kind : {MatrixKind::consistent, MatrixKind::simplified, MatrixKind::exact}) {
      for (const char* name : {"single_pendulum", "double_pendulum", "four_link", "slider_crank", "heavy_top"})
        EXPECT_EQ(pick(model(name), formulation, kind), "block") << name << ' ' << formulation.name;
      for (const SceneGenerator& generator : scene_generators())
        EXPECT_EQ(pick(generator.make(20), formulation, kind), "block") << generator.name << ' ' << formulation.name;
    }
  }
}

TEST(Auto, LeavesKinematicsToKluAndOfOneBodyToDense) {
  for (const FormulationEntry& formulation : formulations()) {
    EXPECT_EQ(pick(model("single_pendulum"), formulation, MatrixKind::kinematic), "dense") << formulation.name;
    for (const char* name : {"four_link", "slider_crank"})
      EXPECT_EQ(pick(model(name), formulation, MatrixKind::kinematic), "klu") << name << ' ' << formulation.name;
  }
}

TEST(Auto, CountsWhatItsPickDoes) {
  const Pattern pattern{2, {{0, 0, 2, 2}}, {0, 0}};
  const auto solver = linear_solvers().require("auto").make();
  EXPECT_TRUE(solver->slots().empty());
  EXPECT_TRUE(solver->values().empty());
  ASSERT_TRUE(solver->analyze(pattern).ok());
  const std::vector<double> identity{1, 0, 0, 1};
  std::ranges::copy(identity, solver->values().begin());
  ASSERT_TRUE(solver->factor().ok());
  std::vector<double> x{3, 4};
  ASSERT_TRUE(solver->solve(x).ok());
  EXPECT_EQ(x, (std::vector<double>{3, 4}));
  EXPECT_EQ(solver->statistics().analyses, 1);
  EXPECT_EQ(solver->statistics().factorizations, 1);
  EXPECT_EQ(solver->statistics().solves, 1);
  EXPECT_EQ(solver->statistics().nonzeros, 4);
}

TEST(Auto, ARunNamesTheSolverThatDidTheWork) {
  Settings settings;
  settings.integrator = "implicit_euler";
  settings.end = 0.01;
  const auto solved_by = [&](const char* name, const char* linear_solver) {
    settings.linear_solver = linear_solver;
    return simulate(model(name), settings, {}).statistics.linear.at(0).solver;
  };
  EXPECT_EQ(solved_by("double_pendulum", "auto"), "block");
  EXPECT_EQ(solved_by("four_link", "auto"), "klu");
  EXPECT_EQ(solved_by("single_pendulum", "auto"), "dense");
  EXPECT_EQ(solved_by("double_pendulum", "dense"), "dense");
  settings.analysis = Analysis::kinematics;
  EXPECT_EQ(solved_by("four_link", "auto"), "klu");
}

}  // namespace
}  // namespace poinsot
