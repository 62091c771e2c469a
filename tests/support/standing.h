// A problem of any formulation at given states of its bodies, and what it says about them.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/dense_problem.h"
#include "tests/support/random_model.h"

namespace poinsot::test {

inline std::vector<BodyState> random_states(Random& random, int bodies) {
  std::vector<BodyState> states(static_cast<std::size_t>(bodies));
  for (BodyState& state : states) state = random.state();
  return states;
}

// A problem that stands at the states; its vectors live as long as it.
struct Standing {
  Standing(std::string_view formulation, const Model& model, std::span<const BodyState> states, double t)
      : problem(make_problem(formulation, model)), q(problem->nq()), v(problem->nv()) {
    problem->from_bodies(states, view(q), view(v));
    stand(t);
  }
  void stand(double t) {
    problem->set_position(t, view(q));
    problem->set_velocity(view(v));
  }
  // Accelerations and multipliers of the state.
  void solve() {
    const int nv = problem->nv(), nc = problem->nc();
    a = VectorX::Zero(nv), lambda = VectorX::Zero(nc);
    VectorX right(nv + nc), out(nv), gamma(nc);
    problem->equations_of_motion(view(a), view(lambda), view(out));
    problem->gamma(view(gamma));
    right << -out, gamma;
    const VectorX x = assemble(*problem, MatrixKind::consistent, {}, VectorX(), a, lambda).fullPivLu().solve(right);
    a = x.head(nv), lambda = x.tail(nc);
  }
  std::vector<BodyState> states() const {
    std::vector<BodyState> out(static_cast<std::size_t>(problem->bodies()));
    problem->to_bodies(view(a), out);
    return out;
  }

  std::unique_ptr<Problem> problem;
  VectorX q, v, a, lambda;
};

inline void expect_same(const BodyState& x, const BodyState& y, double tolerance) {
  EXPECT_LT((x.r - y.r).norm(), tolerance);
  EXPECT_LT((x.A - y.A).norm(), tolerance);
  EXPECT_LT((x.rd - y.rd).norm(), tolerance * (1 + y.rd.norm()));
  EXPECT_LT((x.w - y.w).norm(), tolerance * (1 + y.w.norm()));
  EXPECT_LT((x.rdd - y.rdd).norm(), tolerance * (1 + y.rdd.norm()));
  EXPECT_LT((x.wd - y.wd).norm(), tolerance * (1 + y.wd.norm()));
}

// One row of each kind between the ground and a free body or two free bodies, and every force. Constraints are
// violated, velocities too: the linear system does not mind.
inline Model solvable_model(Random& random) {
  Model model = random_bodies(random, 3);
  for (RowType type : kRowTypes) {
    const auto& [i, j] = kPairs[random.integer(0, 3)];
    add_row(model, type, i, j, random);
  }
  add_row(model, RowType::D, 1, 2, random);
  for (int type = 0; type < kForceTypes; ++type) {
    add_force(model, static_cast<ForceType>(type), random.integer(0, 1), 2, random);
  }
  return model;
}

}  // namespace poinsot::test
