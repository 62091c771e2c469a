// A problem refers to no vector of its caller's: whatever happens to q and v after they were set, it answers the same.
#include <gtest/gtest.h>

#include <limits>

#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

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
  for (const MatrixKind kind :
       {MatrixKind::kinematic, MatrixKind::rates, MatrixKind::consistent, MatrixKind::simplified, MatrixKind::exact}) {
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

TEST(ProblemOwnership, answers_do_not_depend_on_the_vectors_of_the_caller) {
  for (const char* name : {"knife_edge", "double_four_bar", "steel_pendulum", "andrews", "four_link"}) {
    const auto model = std::make_shared<const Model>(compile(scene_of(name)));
    for (const FormulationEntry& formulation : formulations()) {
      const std::unique_ptr<Problem> problem = formulation.make(model, {});
      std::vector<BodyState> states;
      for (const Body& body : model->bodies) {
        BodyState& state = states.emplace_back();
        state.r = body.position, state.A = body.orientation;
        state.rd = Vector3(0.1, -0.2, 0.3), state.w = Vector3(-0.5, 0.7, 0.2);
      }
      std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
      problem->from_bodies(states, q, v);
      problem->set_position(0.1, q);
      problem->set_velocity(v);
      const std::vector<double> before = answers(*problem);
      std::ranges::fill(q, std::numeric_limits<double>::quiet_NaN());
      std::ranges::fill(v, std::numeric_limits<double>::quiet_NaN());
      EXPECT_EQ(answers(*problem), before) << name << ' ' << formulation.name;
      for (const double x : before) ASSERT_TRUE(std::isfinite(x)) << name << ' ' << formulation.name;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
