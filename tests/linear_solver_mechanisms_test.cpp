// The linear solvers on the matrices they are for: of the mechanisms in models/, in every formulation.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/start/initial_state.h"
#include "linsolve/registry.h"
#include "tests/support/linear_solver_systems.h"

namespace poinsot::test {
namespace {

constexpr const char* kMechanisms[] = {"single_pendulum", "double_pendulum", "four_link", "slider_crank", "heavy_top"};

std::shared_ptr<const Model> model_of(const std::string& name) {
  return std::make_shared<const Model>(
      compile(read_scene(std::string(POINSOT_SOURCE_DIR) + "/models/" + name + ".json")));
}

// The matrix of a step of h at the initial state, with accelerations and multipliers of the size they have there.
SampleSystem matrix_of(const std::string& name, const FormulationEntry& formulation, MatrixKind kind, double h,
                       int turn = 0) {
  const auto model = model_of(name);
  const InitialState start = find_initial_state(model, Settings());
  const auto problem = formulation.make(model, {});
  std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
  problem->from_bodies(start.bodies, q, v);
  // away from the start by a few small moves: other values on the same pattern
  std::vector<double> move(v.size()), moved(q.size());
  for (std::size_t k = 0; k < move.size(); ++k) move[k] = 1e-2 * turn * std::sin(static_cast<double>(k + 1));
  problem->retract(q, move, moved);
  problem->set_position(0, moved);
  problem->set_velocity(v);

  SampleSystem system{name + " " + std::string(formulation.name), problem->pattern(kind), {}};
  std::vector<int> slots;
  int size = 0;
  for (const Block& block : system.pattern.blocks) {
    for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
  }
  system.values.resize(static_cast<std::size_t>(size));
  const std::vector<double> a(v.size(), 1.0), lambda(static_cast<std::size_t>(problem->nc()), 100.0),
      dq(v.size(), 1e-3);
  const bool in_a_step = kind == MatrixKind::simplified || kind == MatrixKind::exact;
  problem->assemble(kind, {1, h, h * h}, in_a_step ? dq : std::vector<double>(), a, lambda, slots, system.values);
  return system;
}

// Largest residual of a solve by rows, each relative to the sizes that meet in it.
double error_behind(const SampleSystem& system, std::span<const double> x, std::span<const double> b) {
  SampleSystem sizes = system;
  for (double& value : sizes.values) value = std::abs(value);
  std::vector<double> x_sizes(x.begin(), x.end());
  for (double& value : x_sizes) value = std::abs(value);
  const std::vector<long double> ax = system.times(x), bound = sizes.times(x_sizes);
  long double largest = 0, scale = 0;
  for (std::size_t k = 0; k < b.size(); ++k) {
    largest = std::max(largest, std::abs(ax[k] - b[k]));
    scale = std::max(scale, bound[k] + std::abs(b[k]));
  }
  return static_cast<double>(largest / scale);
}

// With a sentence may be refused: unsymmetric matrices, which are kinematics, the exact ones, rA's in a step; and those
// of the four link, whose bars have no inertia about their axes.
bool refused(const LinearStatus& status, std::string_view name, MatrixKind kind, const FormulationEntry& formulation) {
  if (status.failure != LinearFailure::refused) return false;
  EXPECT_FALSE(status.message.empty());
  EXPECT_TRUE(kind == MatrixKind::kinematic || kind == MatrixKind::exact || name == "four_link" ||
              (kind == MatrixKind::simplified && formulation.name == "rA"))
      << status.message;
  return true;
}

class OnMechanisms : public testing::TestWithParam<LinearSolverEntry> {};

INSTANTIATE_TEST_SUITE_P(Registry, OnMechanisms, testing::ValuesIn(linear_solvers()),
                         [](const auto& entry) { return std::string(entry.param.name); });

TEST_P(OnMechanisms, SolveStepsOfAnyLengthAndOtherValuesOnTheSamePattern) {
  for (const char* name : kMechanisms) {
    for (const FormulationEntry& formulation : formulations()) {
      for (const MatrixKind kind : {MatrixKind::consistent, MatrixKind::simplified, MatrixKind::exact}) {
        const auto solver = GetParam().make();
        bool analyzed = false;
        for (const double h : {1e-2, 1e-3, 1e-6}) {
          for (int turn = 0; turn < 3; ++turn) {
            const SampleSystem system = matrix_of(name, formulation, kind, h, turn);
            if (!analyzed) {
              const LinearStatus status = solver->analyze(system.pattern);
              if (refused(status, name, kind, formulation)) continue;
              ASSERT_TRUE(status.ok()) << system.name << ": " << status.message;
              analyzed = true;
            }
            write(system, *solver);
            const LinearStatus factored = solver->factor();
            if (refused(factored, name, kind, formulation)) continue;
            ASSERT_TRUE(factored.ok()) << system.name << ", h = " << h << ": " << factored.message;
            std::vector<double> b(static_cast<std::size_t>(system.pattern.n));
            for (std::size_t k = 0; k < b.size(); ++k) b[k] = std::cos(static_cast<double>(k));
            std::vector<double> x = b;
            ASSERT_TRUE(solver->solve(x).ok()) << system.name;
            EXPECT_LT(error_behind(system, x, b), 1e-13) << system.name << ", h = " << h;
          }
        }
      }
    }
  }
}

TEST_P(OnMechanisms, SolveKinematics) {
  for (const char* name : {"single_pendulum", "four_link", "slider_crank"}) {
    for (const FormulationEntry& formulation : formulations()) {
      const SampleSystem system = matrix_of(name, formulation, MatrixKind::kinematic, 1);
      const auto solver = GetParam().make();
      const LinearStatus status = solver->analyze(system.pattern);
      if (refused(status, name, MatrixKind::kinematic, formulation)) continue;
      ASSERT_TRUE(status.ok()) << system.name << ": " << status.message;
      write(system, *solver);
      ASSERT_TRUE(solver->factor().ok()) << system.name;
      std::vector<double> b(static_cast<std::size_t>(system.pattern.n), 1.0), x = b;
      ASSERT_TRUE(solver->solve(x).ok()) << system.name;
      EXPECT_LT(error_behind(system, x, b), 1e-13) << system.name;
    }
  }
}

TEST_P(OnMechanisms, SayThatMechanismsWithDependentRowsAreSingular) {
  for (const char* name : {"double_four_bar", "andrews"}) {
    for (const FormulationEntry& formulation : formulations()) {
      const SampleSystem system = matrix_of(name, formulation, MatrixKind::consistent, 1e-3);
      const auto solver = GetParam().make();
      LinearStatus status = solver->analyze(system.pattern);
      if (status.ok()) {
        write(system, *solver);
        status = solver->factor();
      }
      std::vector<double> x(static_cast<std::size_t>(system.pattern.n), 1.0);
      if (status.ok()) status = solver->solve(x);
      EXPECT_FALSE(status.ok()) << system.name;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
