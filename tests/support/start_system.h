// The linear system of a scene's first accelerations.
#pragma once

#include <string_view>
#include <vector>

#include "tests/support/linear_solver_systems.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

// [M Gᵀ; G 0] where a motion begins, and its solution there.
struct StartSystem {
  StartSystem(const Scene& scene, std::string_view formulation) : matrix{scene.name, {}, {}} {
    (void)simulate(scene, controlled("dop853", formulation, 1e-6, 0.01, 0.01), [&](const Sample& at) {
      if (at.t > 0) return;
      const auto problem = at.problem.clone();
      problem->set_position(at.t, at.q);
      problem->set_velocity(at.v);
      matrix.pattern = problem->pattern(MatrixKind::consistent);
      std::vector<int> slots;
      int size = 0;
      for (const Block& block : matrix.pattern.blocks)
        for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
      matrix.values.resize(static_cast<std::size_t>(size));
      problem->assemble(MatrixKind::consistent, {1, 1e-3, 1e-6}, {}, at.a, at.lambda, slots, matrix.values);
      accelerations = at.a.size();
      solution.assign(at.a.begin(), at.a.end());
      solution.insert(solution.end(), at.lambda.begin(), at.lambda.end());
    });
  }
  SampleSystem matrix;
  std::vector<double> solution;
  std::size_t accelerations = 0;  // so many unknowns, the first
};

}  // namespace poinsot::test
