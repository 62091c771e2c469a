// Every linear solver of the registry beside klu, which chooses its pivots by numbers: along a motion, on the matrices
// and with solutions of the sizes that are met there, it leaves residuals of the same order.
#include <optional>

#include "core/scene_generator.h"
#include "tests/support/linear_solver_suite.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr int kStates = 20;
constexpr int kSolves = 4;        // with each matrix
constexpr double kLength = 1e-3;  // of a step, s

// The largest residual over a motion may be this much of klu's. A residual is rounding times the growth of numbers in
// an elimination; block keeps its pivots while they stay within a decade, and twice what that may cost is allowed.
constexpr double kLargest = 20;
// Or this, about klu's own largest: from motion to motion that is between 5e-17 and 7e-15, by chance of rounding.
constexpr double kAsGood = 1e-14;

// Where pivots change by decades on the way.
struct Motion {
  std::string name;
  Scene scene;
  double end;
};
std::vector<Motion> motions() {
  return {{"double_pendulum_joints", scene_of("double_pendulum_joints"), 3},
          {"four_link", scene_of("four_link"), 1},
          {"slider_crank", scene_of("slider_crank"), 3},
          {"andrews", scene_of("andrews"), 0.05},
          {"chain", find_scene_generator("chain")->make(12), 1},
          {"ladder", find_scene_generator("ladder")->make(8), 1}};
}

// A system of the motion: its matrix, and its accelerations and multipliers, a solution of the size that is met.
struct Met {
  SampleSystem system;
  std::vector<double> solution;
};

std::vector<Met> met(const Motion& motion, std::string_view formulation, MatrixKind kind) {
  Settings settings = controlled("dop853", formulation, 1e-6, motion.end, motion.end / kStates);
  settings.linear_solver = "klu";
  std::vector<Met> all;
  const Outcome outcome = simulate(motion.scene, settings, [&](const Sample& at) {
    const auto problem = at.problem.clone();
    problem->set_position(at.t, at.q);
    problem->set_velocity(at.v);
    Met m{{fmt::format("{} {} at t = {:.3g}", motion.name, formulation, at.t), problem->pattern(kind), {}},
          {at.a.begin(), at.a.end()}};
    m.solution.insert(m.solution.end(), at.lambda.begin(), at.lambda.end());
    std::vector<int> slots;
    int size = 0;
    for (const Block& block : m.system.pattern.blocks)
      for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
    m.system.values.resize(static_cast<std::size_t>(size));
    std::vector<double> dq;
    if (kind == MatrixKind::exact)
      for (const double v : at.v) dq.push_back(kLength * v);
    problem->assemble(kind, {1, kLength, kLength * kLength}, dq, at.a, at.lambda, slots, m.system.values);
    all.push_back(std::move(m));
  });
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
  return all;
}

// A right side whose solution is near that of the system, component by component.
std::vector<double> right_side(const Met& m, std::mt19937_64& random) {
  std::vector<double> x = random_vector(m.system.pattern.n, random);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = m.solution[i] * (1 + 0.1 * x[i]);
  const std::vector<long double> b = m.system.times(x);
  return {b.begin(), b.end()};
}

// The largest residual of a solver that goes along; nothing from one that refuses the matrix.
std::optional<double> largest_residual(LinearSolver& solver, const std::vector<Met>& motion) {
  const unsigned seed = 1;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  const auto refuses = [&](const LinearStatus& status) {
    EXPECT_TRUE(status.ok() || status.failure == LinearFailure::refused) << status.message;
    return !status.ok();
  };
  if (refuses(solver.analyze(motion.front().system.pattern))) return {};
  long double largest = 0;
  for (const Met& m : motion) {
    write(m.system, solver);
    if (refuses(solver.factor())) return {};
    const Scaled scaled(m.system);
    for (int k = 0; k < kSolves; ++k) {
      const std::vector<double> b = right_side(m, random);
      std::vector<double> x = b;
      const LinearStatus status = solver.solve(x);
      EXPECT_TRUE(status.ok()) << m.system.name << ": " << status.message;
      largest = std::max(largest, backward_error(m.system, scaled, x, b));
    }
  }
  return static_cast<double>(largest);
}

TEST_P(LinearSolvers, LeaveResidualsLikeThoseOfKlu) {
  int compared = 0;
  for (const Motion& motion : motions())
    for (const FormulationEntry& formulation : formulations())
      for (const MatrixKind kind : {MatrixKind::exact, MatrixKind::consistent}) {
        const std::vector<Met> systems = met(motion, formulation.name, kind);
        ASSERT_EQ(systems.size(), kStates + 1);
        const auto found = largest_residual(*make(), systems);
        if (!found) continue;
        ++compared;
        const auto of_klu = largest_residual(*linear_solvers().require("klu").make(), systems);
        ASSERT_TRUE(of_klu);
        EXPECT_LE(*found, std::max(kLargest * *of_klu, kAsGood))
            << motion.name << ' ' << formulation.name << (kind == MatrixKind::exact ? " exact" : " consistent")
            << ": klu " << *of_klu;
      }
  EXPECT_GT(compared, 0);
}

}  // namespace
}  // namespace poinsot::test
