// Which matrix is factored, by which linear solver, and that the record of a run says so.
#include "linsolve/linear_system.h"

#include <gtest/gtest.h>

#include "bench/study/scene_check.h"
#include "core/index.h"
#include "core/scene_generator.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/simulate.h"
#include "linsolve/block/order.h"
#include "linsolve/block/schedule.h"
#include "linsolve/registry.h"
#include "tests/support/carried.h"
#include "tests/support/linear_solver_systems.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// As many independent constraints as velocities, none of them on velocities alone.
bool has_square_jacobian(const study::SceneCheck& scene) {
  return scene.rank.degrees_of_freedom() == 0 &&
         std::ranges::none_of(scene.model->rows, [](const Row& row) { return row.type == RowType::pfaffian; });
}

Settings a_few_steps(std::string_view formulation, std::string_view linear_solver) {
  Settings settings;
  settings.formulation = formulation;
  settings.integrator = "implicit_euler";
  settings.linear_solver = linear_solver;
  settings.step = 1e-4;
  settings.end = 1e-3;
  settings.tolerance = 1e-2;
  settings.max_iterations = 50;
  return settings;
}

class Models : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, Models, testing::ValuesIn(model_names()), [](const auto& name) { return name.param; });

// What the record names is who counted the factorizations; what it should be follows from the model and the choice.
TEST_P(Models, TheRecordNamesWhoFactoredWhichSystem) {
  const Scene scene = scene_of(GetParam());
  // Entries of velocity rows in the exact matrix have no mirrors.
  const bool square = has_square_jacobian(study::check_scene(scene)),
             saddle_point =
                 std::ranges::none_of(scene.constraints, [](auto&c) { return c.type == ConstraintType::pfaffian; });
  for (const LinearSolverEntry& entry : linear_solvers()) {
    for (const char* choice : {"auto", "whole"}) {
      Settings settings = a_few_steps("rA", entry.name);
      settings.linear_system = choice;
      const Outcome outcome = simulate(scene, settings, {});
      ASSERT_TRUE(outcome.status.ok()) << entry.name << ": " << outcome.status.message;
      ASSERT_EQ(outcome.statistics.linear.size(), 1) << entry.name;
      const LinearWork& work = outcome.statistics.linear.front();
      const bool reduced = square && entry.takes_jacobian && std::string_view(choice) == "auto";
      EXPECT_EQ(work.system, reduced ? "G" : "whole") << entry.name << ' ' << choice;
      const char* pick = !reduced && saddle_point ? "block" : reduced && scene.bodies.size() == 1 ? "dense" : "klu";
      EXPECT_EQ(work.solver, entry.name == "auto" ? pick : entry.name) << choice;
      EXPECT_EQ(work.handed_over_by, "") << entry.name << ' ' << choice;
      EXPECT_GE(work.factorizations + work.refactorizations, outcome.statistics.factorizations) << entry.name;
      EXPECT_EQ(work.solves, (reduced ? 2 : 1) * outcome.statistics.solves) << entry.name << ' ' << choice;
      EXPECT_GT(work.reciprocal_condition, 1e-12) << entry.name;
      EXPECT_LE(work.reciprocal_condition, 1) << entry.name;
    }
  }
}

TEST_P(Models, NothingIsHandedOverWhereTheMechanismIsRegular) {
  const Scene scene = scene_of(GetParam());
  if (!study::check_scene(scene).rank.dependent.empty()) return;  // over-constrained: kept rows come close to others
  for (const FormulationEntry& formulation : formulations()) {
    for (const char* jacobian : {"exact", "simplified", "kept"}) {
      Settings settings = a_few_steps(formulation.name, "block");
      settings.jacobian = jacobian;
      const Outcome outcome = simulate(scene, settings, {});
      EXPECT_TRUE(outcome.status.ok()) << formulation.name << ' ' << jacobian << ": " << outcome.status.message;
      for (const LinearWork& work : outcome.statistics.linear)
        EXPECT_EQ(work.solver, "block") << formulation.name << ' ' << jacobian << ", handed over by "
                                        << work.handed_over_by;
    }
  }
}

// The matrix of kinematics is no saddle point.
TEST(LinearSystem, AHandOverIsCountedAndNamed) {
  Settings settings = a_few_steps("rA", "block");
  settings.analysis = Analysis::kinematics;
  const Outcome outcome = simulate(scene_of("four_link_joints"), settings, {});
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
  ASSERT_EQ(outcome.statistics.linear.size(), 1);
  const LinearWork& work = outcome.statistics.linear.front();
  EXPECT_EQ(work.solver, "klu");
  EXPECT_EQ(work.handed_over_by, "block");
  EXPECT_EQ(work.system, "whole");
  EXPECT_GE(work.factorizations + work.refactorizations, outcome.statistics.factorizations);
  EXPECT_EQ(work.solves, outcome.statistics.solves);
}

// [K Gᵀ; G 0] of two velocities and two constraints; the block above G may be another than Gᵀ.
SampleSystem square(double above) {
  SampleSystem s;
  s.name = "square";
  s.pattern.n = 4;
  s.pattern.node = {0, 0, 1, 1};
  s.add({0, 0, 2, 2}, std::vector<double>{4, 1, 2, 5});
  s.add({2, 0, 2, 2}, std::vector<double>{1, 2, 3, -1});
  s.add({0, 2, 2, 2}, std::vector<double>{1, 3 + above, 2, -1});
  return s;
}

void write(const SampleSystem& system, LinearSystem& linear) {
  std::ranges::fill(linear.values(), 0.0);
  std::size_t v = 0, c = 0;
  for (const Block& b : system.pattern.blocks)
    for (int j = 0; j < b.cols; ++j, ++c)
      for (int i = 0; i < b.rows; ++i) linear.values()[index(linear.slots()[c] + i)] += system.values[v++];
}

void expect_linear_solves(LinearSystem& linear, const SampleSystem& system) {
  write(system, linear);
  ASSERT_TRUE(linear.factor().ok());
  EXPECT_TRUE(linear.factored());
  const std::vector<double> b{1, -2, 3, 5};
  std::vector<double> x = b;
  ASSERT_TRUE(linear.solve(x).ok());
  const std::vector<long double> ax = system.times(x);
  for (std::size_t k = 0; k < b.size(); ++k) EXPECT_NEAR(static_cast<double>(ax[k]), b[k], 1e-13);
}

TEST(LinearSystem, ValuesThatAreNotSymmetricTakeTheWholeMatrix) {
  for (const LinearSolverEntry& entry : linear_solvers()) {
    if (!entry.takes_jacobian) continue;
    LinearSystems systems({std::string(entry.name), "auto"});
    LinearSystem& linear = systems.add();
    ASSERT_TRUE(linear.analyze(square(0).pattern).ok());
    EXPECT_FALSE(linear.factored());
    expect_linear_solves(linear, square(0));
    ASSERT_EQ(systems.work().size(), 1);
    EXPECT_EQ(systems.work()[0].system, "G");
    expect_linear_solves(linear, square(0.5));
    expect_linear_solves(linear, square(0));
    ASSERT_EQ(systems.work().size(), 2);
    EXPECT_EQ(systems.work()[0].system, "G");
    EXPECT_EQ(systems.work()[1].system, "whole");
  }
}

// As where a redundant row takes the place of another of its joint: pivots serve on, old factors do not.
TEST(LinearSystem, AnalyzedForTheSamePlacesKeepsItsPivots) {
  SampleSystem other = square(0);
  for (const std::size_t k : {1u, 2u}) std::ranges::copy(std::vector<double>{1.1, 2, 3, -1.2}, other.block(k).begin());
  std::swap(other.block(2)[1], other.block(2)[2]);  // stays the transpose
  for (const LinearSolverEntry& entry : linear_solvers()) {
    for (const std::string_view system : {"auto", "whole"}) {
      SCOPED_TRACE(fmt::format("{} {}", entry.name, system));
      LinearSystems systems({std::string(entry.name), std::string(system)});
      LinearSystem& linear = systems.add();
      ASSERT_TRUE(linear.analyze(square(0).pattern).ok());
      expect_linear_solves(linear, square(0));
      ASSERT_TRUE(linear.analyze(other.pattern).ok());
      EXPECT_FALSE(linear.factored());
      expect_linear_solves(linear, other);
      ASSERT_EQ(systems.work().size(), 1);
      EXPECT_EQ(systems.work()[0].factorizations + systems.work()[0].refactorizations, 2);
      EXPECT_EQ(linear.statistics().analyses, 1);
      systems.let_go();
      ASSERT_TRUE(linear.analyze(other.pattern).ok());
      expect_linear_solves(linear, other);
    }
  }
}

TEST(LinearSystem, ASingularJacobianNamesAnUnknownOfTheWhole) {
  SampleSystem system = square(0);
  system.block(1)[0] = system.block(2)[0] = -6;  // G = [-6 3; 2 -1]
  LinearSystems systems({"klu", "auto"});
  LinearSystem& linear = systems.add();
  ASSERT_TRUE(linear.analyze(system.pattern).ok());
  write(system, linear);
  const LinearStatus status = linear.factor();
  EXPECT_EQ(status.failure, LinearFailure::singular);
  EXPECT_TRUE(status.unknown == 0 || status.unknown == 1) << status.unknown;
  EXPECT_FALSE(linear.factored());
}

TEST(LinearSystem, UnknownNamesAreRefused) {
  EXPECT_THROW(LinearSystems({"klux", "auto"}).add(), InputError);
  EXPECT_THROW(LinearSystems({"klu", "half"}).add(), InputError);
}

// What waits of a ladder is that of a few of its rungs, however many there are.
TEST(BlockSchedule, OfALadderKeepsAStackThatDoesNotGrow) {
  const auto stack = [](int bodies) {
    const Scene scene = find_scene_generator("ladder")->make(bodies);
    const auto problem = formulations().require("rA").make(std::make_shared<const Model>(compile(scene)), {});
    const Pattern pattern = problem->pattern(MatrixKind::exact);
    CscLayout layout;
    EXPECT_TRUE(layout.build(pattern).ok());
    const std::vector<int> fused(index(1 + *std::ranges::max_element(pattern.node)), -1);
    block::Graph graph;
    graph.build(layout, pattern.node, fused);
    block::Schedule schedule;
    EXPECT_TRUE(schedule.build(layout, graph, block::elimination_order(graph), block::Fronts::cheap));
    return schedule.stack_size;
  };
  EXPECT_LE(stack(600), 2 * stack(60));
}

// Groups of constraints before one of their bodies: later in a ladder on a body, whose factors had 25171 entries when
// they went as soon as that looked as cheap; at once in a single loop, whose factors have 726 when they wait.
TEST(BlockOrder, GroupsWaitForTheirBodiesWhereThatIsCheaper) {
  const auto entries = [](const Scene& scene) {
    const auto problem = formulations().require("rA").make(std::make_shared<const Model>(compile(scene)), {});
    LinearSystem system({"block", "whole"});
    EXPECT_TRUE(system.analyze(problem->pattern(MatrixKind::simplified)).ok());
    return system.statistics().factor_nonzeros;
  };
  EXPECT_LT(entries(Carried::ladder(30, false)), 24'000);
  EXPECT_LT(entries(Carried::four_bars(1, false)), 720);
}

}  // namespace
}  // namespace poinsot::test
