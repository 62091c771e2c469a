// The formulations at what is discrete in them: singular attitudes, changes of chart, turns of torsion springs.
#include "core/so3.h"
#include "tests/scale.h"
#include "tests/support/standing.h"

namespace poinsot::test {
namespace {

// Whether accept() rewrote the state, which has no rows.
bool accepted(Problem& problem, std::span<double> q, std::span<double> v, std::span<double> a) {
  bool rewritten = false;
  std::vector<double> lambda(static_cast<std::size_t>(problem.nc()), 0.0);
  EXPECT_TRUE(problem.accept(0, q, v, a, lambda, rewritten).ok());
  return rewritten;
}

// The attitudes at which ZXZ angles of the scene's own frame fail: a heavy top that stands upright or hangs.
TEST(Formulations, StartWhereTheZxzAnglesAreSingular) {
  Random random(5);
  const Model model = random_bodies(random, 3);
  std::vector<BodyState> states(3);
  states[1].A = Vector3(1, -1, -1).asDiagonal();
  states[2].A = exp_so3<double>(Vector3(0, 0, 1.2)) * exp_so3<double>(Vector3(1e-9, 0, 0));
  for (BodyState& state : states) state.w = Vector3(1, 2, 30);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    Standing at(entry.name, model, states, 0);
    at.solve();
    const std::vector<BodyState> found = at.states();
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_LT((found[b].A - states[b].A).norm(), 1e-14);
      EXPECT_LT((found[b].w - states[b].w).norm(), 1e-13);
    }
  }
}

// A rotation held for a time leads into the singularity of a chart; accept() changes the coordinates and nothing else.
TEST(Formulations, AcceptingAStepKeepsWhatItMeans) {
  int changes = 0;
  for (int seed = 0; seed < scaled(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    const Model model = random_bodies(random, 2);
    const std::vector<BodyState> states = random_states(random, 2);
    for (const FormulationEntry& entry : formulations()) {
      SCOPED_TRACE(entry.name);
      Standing at(entry.name, model, states, 0);
      const VectorX dq = random.uniform(0.1, 1) * at.v;
      VectorX q(at.q.size());
      at.problem->retract(view(at.q), view(dq), view(q));
      at.q = q;
      at.a = random.vector(at.problem->nv());
      at.stand(0);
      const std::vector<BodyState> before = at.states();
      const bool changed = accepted(*at.problem, view(at.q), view(at.v), view(at.a));
      changes += changed;
      if (changed) at.stand(0);
      const std::vector<BodyState> after = at.states();
      for (std::size_t b = 0; b < after.size(); ++b) expect_same(after[b], before[b], 1e-11);
      EXPECT_FALSE(accepted(*at.problem, view(at.q), view(at.v), view(at.a))) << "a second time";
    }
  }
  EXPECT_GT(changes, 0);
}

// A torsion spring counts on over half turns, within a step and from step to step; clones start from where it stands.
TEST(Formulations, TorsionSpringsCountTurns) {
  Model model;
  Body body;
  body.mass = 1;
  body.inertia = Matrix3::Identity();
  model.bodies.push_back(body);
  TorsionElement torsion;
  torsion.spring.j = 0;
  torsion.spring.stiffness = 2;
  torsion.a_i = torsion.c_j = Vector3::UnitX();
  torsion.b_i = Vector3::UnitY();
  model.torsions.push_back(torsion);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    BodyState state;
    Standing at(entry.name, model, std::vector(1, state), 0);
    for (double angle = 0; angle < 20; angle += 2.5) {
      SCOPED_TRACE(angle);
      state.A = exp_so3<double>(Vector3(0, 0, angle));
      at.problem->from_bodies(std::vector(1, state), view(at.q), view(at.v));
      at.stand(0);
      EXPECT_NEAR(at.problem->energy(), angle * angle, 1e-12 * (1 + angle * angle));
      VectorX a = VectorX::Zero(at.problem->nv());
      accepted(*at.problem, view(at.q), view(at.v), view(a));
      at.stand(0);
      EXPECT_NEAR(at.problem->energy(), angle * angle, 1e-12 * (1 + angle * angle));
      const auto clone = at.problem->clone();
      clone->set_position(0, view(at.q));
      clone->set_velocity(view(at.v));
      EXPECT_EQ(clone->energy(), at.problem->energy());
      at.solve();
      EXPECT_NEAR(at.states()[0].wd.z(), -2 * angle, 1e-11);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
