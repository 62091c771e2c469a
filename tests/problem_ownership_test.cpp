// A problem refers to no vector of its caller's: whatever happens to q and v after they were set, it answers the same.
// Nor do its matrices hang on what their values were before.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/index.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr MatrixKind kMatrixKinds[] = {MatrixKind::kinematic, MatrixKind::rates, MatrixKind::consistent,
                                       MatrixKind::simplified, MatrixKind::exact};

// Everything a problem can be asked where it stands.
std::vector<double> answers(Problem& problem) {
  const auto n = static_cast<std::size_t>(problem.nv()), c = static_cast<std::size_t>(problem.nc());
  std::vector<double> all;
  const auto add = [&](std::size_t size, auto ask) {
    std::vector<double> out(size);
    ask(out);
    all.insert(all.end(), out.begin(), out.end());
  };
  const std::vector<double> ones(std::max(n, c), 1.0);
  const std::span<const double> a(ones.data(), n), lambda(ones.data(), c);
  add(c, [&](auto& out) { problem.position_residual(out); });
  add(c, [&](auto& out) { problem.velocity_residual(out); });
  add(c, [&](auto& out) { problem.nu(out); });
  add(c, [&](auto& out) { problem.gamma(out); });
  add(n, [&](auto& out) { problem.momentum(a, out); });
  add(n, [&](auto& out) { problem.constraint_forces(lambda, out); });
  add(n, [&](auto& out) { problem.equations_of_motion(a, lambda, out); });
  add(n + c, [&](auto& out) { problem.step_residual({1, 0.5, 0.25}, a, lambda, out); });
  for (const MatrixKind kind : kMatrixKinds) {
    std::vector<int> slots;
    int size = 0;
    for (const Block& block : problem.pattern(kind).blocks) {
      for (int k = 0; k < block.cols; ++k, size += block.rows) slots.push_back(size);
    }
    add(static_cast<std::size_t>(size), [&](auto& out) {
      problem.assemble(kind, {1, 0.5, 0.25}, {}, a, lambda, slots, out);
    });
  }
  std::vector<BodyState> states(static_cast<std::size_t>(problem.bodies()));
  problem.to_bodies(a, states);
  for (const BodyState& state : states) {
    for (const Vector3& x : {state.r, state.rd, state.rdd, state.w, state.wd})
      all.insert(all.end(), x.begin(), x.end());
  }
  all.push_back(problem.energy());
  for (std::size_t g = 0; g < problem.model().groups.size(); ++g) {
    Vector3 force, moment;
    problem.reaction(static_cast<int>(g), lambda, force, moment);
    all.insert(all.end(), force.begin(), force.end());
    all.insert(all.end(), moment.begin(), moment.end());
  }
  return all;
}

// Of a formulation at t = 0.1 s, moving, off the constraints.
class MovingProblem {
 public:
  MovingProblem(std::shared_ptr<const Model> model, const FormulationEntry& formulation)
      : problem(formulation.make(model, {})), q(index(problem->nq())), v(index(problem->nv())) {
    std::vector<BodyState> states;
    for (const Body& body : model->bodies) {
      BodyState& state = states.emplace_back();
      state.r = body.position, state.A = body.orientation;
      state.rd = Vector3(0.1, -0.2, 0.3), state.w = Vector3(-0.5, 0.7, 0.2);
    }
    problem->from_bodies(states, q, v);
    problem->set_position(0.1, q);
    problem->set_velocity(v);
  }
  const std::unique_ptr<Problem> problem;
  std::vector<double> q, v;
};

TEST(ProblemOwnership, answers_do_not_depend_on_the_vectors_of_the_caller) {
  for (const char* name : {"knife_edge", "double_four_bar", "steel_pendulum", "andrews", "four_link"}) {
    const auto model = std::make_shared<const Model>(compile(scene_of(name)));
    for (const FormulationEntry& formulation : formulations()) {
      MovingProblem moving(model, formulation);
      const std::vector<double> before = answers(*moving.problem);
      std::ranges::fill(moving.q, std::numeric_limits<double>::quiet_NaN());
      std::ranges::fill(moving.v, std::numeric_limits<double>::quiet_NaN());
      EXPECT_EQ(answers(*moving.problem), before) << name << ' ' << formulation.name;
      for (const double x : before) ASSERT_TRUE(std::isfinite(x)) << name << ' ' << formulation.name;
    }
  }
}

TEST(ProblemOwnership, matrices_are_written_over_what_was_there) {
  for (const char* name :
       {"knife_edge", "double_four_bar", "steel_pendulum", "andrews", "four_link", "stewart_platform"}) {
    const auto model = std::make_shared<const Model>(compile(scene_of(name)));
    for (const FormulationEntry& formulation : formulations()) {
      MovingProblem moving(model, formulation);
      Problem& problem = *moving.problem;
      const std::vector<double> ones(index(problem.nv() + problem.nc()), 1.0);
      const std::span<const double> a = std::span(ones).first(index(problem.nv()));
      const std::span<const double> lambda = std::span(ones).first(index(problem.nc()));
      for (const MatrixKind kind : kMatrixKinds) {
        const Pattern pattern = problem.pattern(kind);
        std::vector<int> slots;
        std::vector<double> once(index(pattern.n) * index(pattern.n), 0.0), again = once;
        for (const Block& block : pattern.blocks)
          for (int c = 0; c < block.cols; ++c) {
            slots.push_back((block.col + c) * pattern.n + block.row);
            std::fill_n(again.begin() + slots.back(), block.rows, std::numeric_limits<double>::quiet_NaN());
          }
        for (std::vector<double>* values : {&once, &again})
          problem.assemble(kind, {1, 0.5, 0.25}, {}, a, lambda, slots, *values);
        EXPECT_EQ(again, once) << name << ' ' << formulation.name << ' ' << static_cast<int>(kind);
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
