// The size of a residual, and which solutions the block solver looks at.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "formulations/registry.h"
#include "linsolve/residual.h"
#include "tests/support/carried.h"
#include "tests/support/linear_solver_suite.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"
#include "tests/support/start_system.h"

namespace poinsot::test {
namespace {

TEST(Residual, IsRelativeToWhatIsSolved) {
  std::mt19937_64 random(1);
  const SampleSystem s = saddle_point(chain(5, 5), BodyKind::six, random);
  CscLayout layout;
  ASSERT_TRUE(layout.build(s.pattern).ok());
  std::vector<double> values(static_cast<std::size_t>(layout.nonzeros()));
  std::size_t v = 0, slot = 0;
  for (const Block& block : s.pattern.blocks)
    for (int c = 0; c < block.cols; ++c, ++slot)
      for (int r = 0; r < block.rows; ++r) values[static_cast<std::size_t>(layout.slots[slot] + r)] += s.values[v++];
  Residual residual;
  residual.resize(layout);
  const std::vector<double> ones(static_cast<std::size_t>(s.pattern.n), 1);
  residual.measure_by(ones, ones);

  const std::vector<double> x = random_vector(s.pattern.n, random);
  const std::vector<long double> exact = s.times(x);
  std::vector<double> b(exact.begin(), exact.end());
  EXPECT_LT(residual.size(layout, values, b, x), 1e-15);
  b[3] += 1e-6;
  const double found = residual.size(layout, values, b, x);
  EXPECT_GT(found, 1e-8);
  EXPECT_LT(found, 1e-6);
  EXPECT_NEAR(residual.vector()[3], 1e-6, 1e-14);
  for (const double scale : {1e-12, 1e12}) {
    std::vector<double> scaled_b = b, scaled_x = x;
    for (double& y : scaled_b) y *= scale;
    for (double& y : scaled_x) y *= scale;
    EXPECT_NEAR(residual.size(layout, values, scaled_b, scaled_x) / found, 1, 1e-6) << scale;
  }
}

// A row of very many entries, as a hub has: their sum cannot be rounded to its largest term.
TEST(Residual, OfManyTermsIsRelativeToThemAll) {
  constexpr int kTerms = 30'000;
  CscLayout layout;
  ASSERT_TRUE(layout.build({kTerms, {{0, 0, 1, kTerms}, {1, 1, 1, 1}}, std::vector<int>(kTerms, 0)}).ok());
  std::mt19937_64 random(1);
  const std::vector<double> values(static_cast<std::size_t>(layout.nonzeros()), 1),
      ones(static_cast<std::size_t>(kTerms), 1), x = random_vector(kTerms, random);
  Residual residual;
  residual.resize(layout);
  residual.measure_by(ones, ones);
  std::vector<double> b(ones.size(), 0.0);
  b[0] = static_cast<double>(std::accumulate(x.begin(), x.end(), 0.0L));
  b[1] = x[1];
  EXPECT_LT(residual.size(layout, values, b, x), 1e-15);
  b[0] += 1e-7;
  EXPECT_GT(residual.size(layout, values, b, x), 1e-12);
  b[0] -= 1e-7, b[1] += 1e-12;
  EXPECT_GT(residual.size(layout, values, b, x), 1e-14);
}

// Nor to all unknowns, where its own are larger: rods of a hub whose arms are long.
TEST(Residual, OfManyTermsIsRelativeToTheirSum) {
  constexpr int kTerms = 3'000;
  constexpr double kArm = 1e5;
  CscLayout layout;
  ASSERT_TRUE(layout.build({kTerms, {{0, 0, 1, kTerms}, {1, 1, 1, 1}}, std::vector<int>(kTerms, 0)}).ok());
  std::mt19937_64 random(1);
  const std::vector<double> values(static_cast<std::size_t>(layout.nonzeros()), kArm),
      ones(static_cast<std::size_t>(kTerms), 1), x = random_vector(kTerms, random);
  Residual residual;
  residual.resize(layout);
  residual.measure_by(ones, ones);
  std::vector<double> b(ones.size(), 0.0);
  b[0] = kArm * static_cast<double>(std::accumulate(x.begin(), x.end(), 0.0L));
  b[1] = kArm * x[1];
  const double rounding = 1e-14 * kArm * kTerms;
  b[0] += rounding;
  EXPECT_LT(residual.size(layout, values, b, x), 3e-14);
  b[0] += 100 * rounding;
  EXPECT_GT(residual.size(layout, values, b, x), 1e-12);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LinearSolvers);

// Some random right sides leave more than rounding here, those of the motion do not: these are given out unseen but for
// one in seven, until one that is looked at is not good.
TEST(BlockSolver, LooksAgainWhereAMotionIsNoLongerCalm) {
  const StartSystem start(scene_of("double_pendulum_joints"), "rp");
  const SampleSystem& s = start.matrix;
  const std::vector<double>& calm = start.solution;
  const auto solver = linear_solvers().require("block").make();
  ASSERT_TRUE(prepare(*solver, s).ok());
  // How many of so many solutions were refined.
  const auto refined = [&](const std::vector<double>& x, int solves) {
    const std::int64_t before = solver->statistics().refinements;
    const std::vector<long double> exact = s.times(x);
    for (int k = 0; k < solves; ++k) {
      std::vector<double> b(exact.begin(), exact.end());
      EXPECT_TRUE(solver->solve(b).ok());
    }
    return solver->statistics().refinements - before;
  };
  std::mt19937_64 random(1);
  std::vector<double> bad = random_vector(s.pattern.n, random);
  for (int tries = 0; refined(bad, 1) == 0; ++tries) {
    ASSERT_LT(tries, 1000);
    bad = random_vector(s.pattern.n, random);
  }
  EXPECT_EQ(refined(bad, 10), 10);
  EXPECT_EQ(refined(calm, 100), 0);
  const std::int64_t again = refined(bad, 14);
  EXPECT_GE(again, 14 - 6);  // six at most were given out unseen
  EXPECT_LT(again, 14);
}

// One pivot of the ladder is what cancellation leaves, a ten-millionth, and solutions are good all the same. Once many
// were, not all are looked at any more: of a matrix that is another than was factored some are refined.
TEST(BlockSolver, LooksAtSomeSolutionsWhereAPivotIsSmallAndAllAreGood) {
  const StartSystem start(Carried::ladder(100, true), "rA");
  const SampleSystem& s = start.matrix;
  const auto solver = linear_solvers().require("block").make();
  ASSERT_TRUE(prepare(*solver, s).ok());
  const std::vector<long double> exact = s.times(start.solution);
  const auto refined = [&](int solves) {
    const std::int64_t before = solver->statistics().refinements;
    for (int k = 0; k < solves; ++k) {
      std::vector<double> b(exact.begin(), exact.end());
      EXPECT_TRUE(solver->solve(b).ok());
    }
    return solver->statistics().refinements - before;
  };
  EXPECT_EQ(refined(10), 0);
  for (double& entry : solver->values()) entry *= 1 + 5e-14;
  const std::int64_t of = refined(14);
  EXPECT_GE(of, 14 - 6);  // six at most were given out unseen
  EXPECT_LT(of, 14);
}

// In turned frames the inertia of slender bodies is nearly singular in a direction that no row or column shows. Once
// that is seen rows that act on such a body are eliminated with it, and nothing is left to be refined.
TEST(BlockSolver, SoonLeavesLittleOfSlenderBodiesInTurnedFrames) {
  for (const char* formulation : {"rA", "reps"})
    for (const bool carried : {false, true})
      for (const bool redundant : {false, true}) {
        SCOPED_TRACE(fmt::format("{}{}{}", formulation, carried ? " carried" : "", redundant ? " redundant" : ""));
        Scene scene = loop({4, Frames::random, carried, redundant});
        for (std::size_t k = carried ? 1 : 0; k < scene.bodies.size(); ++k) {
          const Matrix3 R = frame(Frames::random, static_cast<int>(k));
          scene.bodies[k].inertia = R * Vector3(2e-4, 0.1, 0.1).asDiagonal() * R.transpose();
        }
        const StartSystem start(scene, formulation);
        const SampleSystem& s = start.matrix;
        const auto solver = linear_solvers().require("block").make();
        ASSERT_TRUE(prepare(*solver, s).ok());
        const Scaled scaled(s);
        std::mt19937_64 random(1);
        std::int64_t of_first = 0;
        for (const bool first : {true, false}) {
          for (int k = 0; k < 50; ++k) {
            const std::vector<long double> exact = s.times(random_vector(s.pattern.n, random));
            const std::vector<double> b(exact.begin(), exact.end());
            std::vector<double> x = b;
            EXPECT_TRUE(solver->solve(x).ok());
            EXPECT_LT(backward_error(s, scaled, x, b), 1e-14);
          }
          if (first) of_first = solver->statistics().refinements;
          ASSERT_TRUE(solver->factor().ok());
        }
        // A loop on the ground is taken from both ends, which leaves little from the first.
        EXPECT_EQ(of_first, carried ? 50 : 0);
        EXPECT_EQ(solver->statistics().refinements, of_first);
      }
}

// Solutions near that of the start, factorized anew each time.
struct Course {
  std::int64_t refinements = 0, later = 0;  // of the first half, of the second
  double error = 0;                         // of accelerations in the second half, against the largest of them
};
Course solve_often(const Scene& scene, std::string_view formulation) {
  constexpr int kSolves = 400;
  const StartSystem start(scene, formulation);
  const SampleSystem& s = start.matrix;
  const auto solver = linear_solvers().require("block").make();
  EXPECT_TRUE(prepare(*solver, s).ok());
  std::mt19937_64 random(1);
  Course course;
  for (int k = 0; k < kSolves; ++k) {
    std::vector<double> x = random_vector(s.pattern.n, random);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = start.solution[i] * (1 + 0.1 * x[i]);
    const std::vector<long double> exact = s.times(x);
    std::vector<double> found(exact.begin(), exact.end());
    EXPECT_TRUE(solver->solve(found).ok());
    EXPECT_TRUE(solver->factor().ok());
    if (k < kSolves / 2) {
      course.refinements = solver->statistics().refinements;
      continue;
    }
    double error = 0, size = 0;
    for (std::size_t i = 0; i < start.accelerations; ++i)
      error = std::max(error, std::abs(found[i] - x[i])), size = std::max(size, std::abs(x[i]));
    course.error = std::max(course.error, error / size);
  }
  course.later = solver->statistics().refinements - course.refinements;
  return course;
}

void scale_mass(Body& body, double by) {
  body.mass *= by;
  body.inertia *= by;
}

// Two parallel shafts 6 mm apart, of 0.2 kg, and a disk between them that slides on both; every joint twice.
Scene doubled_oldham_coupling() {
  Scene scene;
  scene.gravity = {1, 2, -9};
  const Vector3 apart(0.006, 0, 0), x(std::cos(0.3), std::sin(0.3), 0), y(-x.y(), x.x(), 0), z = Vector3::UnitZ();
  const double along = apart.dot(x);
  const auto body = [&](const char* name, const Vector3& at, int seed) {
    Body& b = scene.bodies.emplace_back();
    b.name = name, b.mass = 0.2, b.position = at, b.orientation = frame(Frames::random, seed);
    b.inertia = b.orientation.transpose() * Vector3(7e-6, 7e-6, 6e-6).asDiagonal() * b.orientation;
    b.angular_velocity = b.orientation.transpose() * (100 * z);
    return static_cast<int>(scene.bodies.size()) - 1;
  };
  const int shaft = body("shaft", {0, 0, 0.005}, 2), disk = body("disk", along * x, 3),
            other = body("other shaft", apart - Vector3(0, 0, 0.005), 4);
  scene.bodies[1].velocity = 100 * (apart.dot(y) * x + along * y);
  const auto joint = [&](JointType type, int i, int j, const Vector3& point, const Vector3& axis) {
    for (const char* name : {"one", "two"}) {
      Joint& of = scene.joints.emplace_back();
      of.name = fmt::format("{} {}", name, scene.joints.size());
      of.type = type, of.i = i, of.j = j, of.point = point, of.axis = axis;
    }
  };
  joint(JointType::revolute, kGround, shaft, Vector3::Zero(), z);
  joint(JointType::translational, shaft, disk, Vector3::Zero(), x);
  joint(JointType::translational, disk, other, along * x, y);
  joint(JointType::revolute, kGround, other, apart, z);
  return scene;
}

// M is small beside G there: pivots that are chosen by the size of entries leave more than is good, and nothing else
// helps. Soon they are chosen by masses, and what is left even so is good enough.
TEST(BlockSolver, SoonLeavesLittleOfSmallMechanisms) {
  Settings settings = dynamics("rA", 3e-4, 0.15);
  settings.integrator = "rattle", settings.linear_solver = "block";
  const Outcome run = simulate(doubled_oldham_coupling(), settings, [](const Sample&) {});
  ASSERT_TRUE(run.status.ok()) << run.status.message;
  std::int64_t refinements = 0, solves = 0;
  for (const LinearWork& work : run.statistics.linear) refinements += work.refinements, solves += work.solves;
  EXPECT_GT(solves, 1500);
  EXPECT_GT(refinements, 64);
  EXPECT_LT(refinements, 200);
}

// Where one body alone is light the others tell how it moves, to the last digit.
TEST(BlockSolver, RefinesSolutionsOfALightBodyAmongOthers) {
  Scene scene = scene_of("double_wishbone");
  scale_mass(scene.bodies[1], 1e-6);
  for (const FormulationEntry& formulation : formulations()) {
    SCOPED_TRACE(formulation.name);
    const Course course = solve_often(scene, formulation.name);
    EXPECT_EQ(course.refinements, course.later);
    EXPECT_GT(course.later, 0);
    EXPECT_LT(course.error, 1e-14);
  }
}

}  // namespace
}  // namespace poinsot::test
