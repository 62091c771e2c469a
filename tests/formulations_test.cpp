// The formulations against one another, and against Newton's and Euler's equations written out.
#include "integrators/start/violation.h"
#include "tests/scale.h"
#include "tests/support/row_definitions.h"
#include "tests/support/standing.h"

namespace poinsot::test {
namespace {

TEST(Formulations, RowsAreWhatTheSceneSays) {
  for (int seed = 0; seed < scaled(50); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    const Model model = random_model(random, 3);
    const std::vector<BodyState> states = random_states(random, 3);
    const double t = random.uniform(-1, 1);
    for (const FormulationEntry& entry : formulations()) {
      Standing at(entry.name, model, states, t);
      VectorX Phi(at.problem->nc()), step(at.problem->nv() + at.problem->nc());
      at.problem->position_residual(view(Phi));
      const VectorX a = VectorX::Zero(at.problem->nv()), lambda = VectorX::Zero(at.problem->nc());
      at.problem->step_residual({1, 0.1, 0.01}, view(a), view(lambda), view(step));
      for (std::size_t k = 0; k < model.rows.size(); ++k) {
        const bool velocity = model.rows[k].type == RowType::pfaffian;
        const double expected = asked(model.rows[k], states, t), scale = 1e-13 * (1 + std::abs(expected));
        const auto row = static_cast<Eigen::Index>(k);
        EXPECT_NEAR(Phi[row], velocity ? 0 : expected, scale) << entry.name << ", " << model.groups[k].name;
        EXPECT_NEAR(step[at.problem->nv() + row], expected / (velocity ? 0.1 : 0.01), 100 * scale)
            << entry.name << ", " << model.groups[k].name;
      }
    }
  }
}

TEST(Formulations, AgreeInAccelerationsReactionsAndEnergy) {
  for (int seed = 0; seed < scaled(50); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    const Model model = solvable_model(random);
    const std::vector<BodyState> states = random_states(random, 3);
    const double t = random.uniform(-1, 1);
    Standing rA("rA", model, states, t);
    rA.solve();
    for (const FormulationEntry& entry : formulations()) {
      SCOPED_TRACE(entry.name);
      Standing other(entry.name, model, states, t);
      EXPECT_EQ(other.problem->formulation(), entry.name);
      EXPECT_NEAR(other.problem->energy(), rA.problem->energy(), 1e-12 * (1 + std::abs(rA.problem->energy())));
      other.solve();
      const std::vector<BodyState> expected = rA.states(), found = other.states();
      for (std::size_t b = 0; b < found.size(); ++b) expect_same(found[b], expected[b], 1e-10);
      const Eigen::Index rows = static_cast<Eigen::Index>(model.rows.size());
      EXPECT_LT(difference(other.lambda.head(rows), rA.lambda.head(rows), 1), 1e-10);
      for (int group = 0; group < static_cast<int>(model.groups.size()); ++group) {
        Vector3 force, moment, other_force, other_moment;
        rA.problem->reaction(group, view(rA.lambda), force, moment);
        other.problem->reaction(group, view(other.lambda), other_force, other_moment);
        const double scale = 1 + force.norm() + moment.norm();
        EXPECT_LT((other_force - force).norm() + (other_moment - moment).norm(), 1e-10 * scale)
            << model.groups[static_cast<std::size_t>(group)].name;
      }
    }
  }
}

// m r̈ = m g + Σ f, J̄ω̄̇ + ω̃̄ J̄ω̄ = Aᵀ Σ (n + s × f) with the reactions (f, n) at the points s of the groups.
TEST(Formulations, ReactionsAreWhatNewtonAndEulerAsk) {
  for (int seed = 0; seed < scaled(50); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    Model model = random_bodies(random, 2);
    for (RowType type : kRowTypes) add_row(model, type, kGround, random.integer(0, 1), random);
    const std::vector<BodyState> states = random_states(random, 2);
    for (const FormulationEntry& entry : formulations()) {
      SCOPED_TRACE(entry.name);
      Standing at(entry.name, model, states, 0.3);
      at.solve();
      const std::vector<BodyState> found = at.states();
      for (std::size_t b = 0; b < found.size(); ++b) {
        const BodyState& s = found[b];
        Vector3 force = model.bodies[b].mass * model.gravity, moment = Vector3::Zero();
        double scale = 1;
        for (std::size_t g = 0; g < model.groups.size(); ++g) {
          if (model.groups[g].j != static_cast<int>(b)) continue;
          Vector3 f, n;
          at.problem->reaction(static_cast<int>(g), view(at.lambda), f, n);
          force += f;
          moment += n + (s.A * model.groups[g].point_j).cross(f);
          scale += f.norm() + n.norm();
        }
        const Matrix3& J = model.bodies[b].inertia;
        EXPECT_LT((model.bodies[b].mass * s.rdd - force).norm(), 1e-10 * scale);
        EXPECT_LT((J * s.wd + s.w.cross(J * s.w) - s.A.transpose() * moment).norm(), 1e-10 * scale);
      }
    }
  }
}

// Three constraints that hold a point along one axis each are evaluated as one, but each has its own reaction.
TEST(Formulations, ReactionsOfAPointHeldByThreeConstraints) {
  Scene scene;
  scene.gravity = {1, -2, 3};
  Body& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = 2;
  body.inertia = Vector3(0.1, 0.2, 0.25).asDiagonal();
  for (int k = 0; k < 3; ++k) {
    Constraint& held = scene.constraints.emplace_back();
    held.type = ConstraintType::CD;
    held.i = kGround, held.j = 0;
    held.c = Vector3::Unit(k);
  }
  const Model model = compile(scene);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    std::vector<BodyState> states = given_state(model);
    states[0].A = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
    Standing at(entry.name, model, states, 0);
    at.solve();
    for (int k = 0; k < 3; ++k) {
      Vector3 force, moment;
      at.problem->reaction(k, view(at.lambda), force, moment);
      EXPECT_LT((force + body.mass * scene.gravity[k] * Vector3::Unit(k)).norm(), 1e-14) << k;
      EXPECT_LT(moment.norm(), 1e-14) << k;
    }
  }
}

// Spatial free rotation too: accelerations of bodies without anything are Euler's.
TEST(Formulations, KeepStates) {
  for (int seed = 0; seed < scaled(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<unsigned>(seed));
    const Model model = random_bodies(random, 2);
    std::vector<BodyState> states = random_states(random, 2);
    for (std::size_t b = 0; b < states.size(); ++b) {
      const Matrix3& J = model.bodies[b].inertia;
      const Vector3 gyroscopic = states[b].w.cross(J * states[b].w);
      states[b].rdd = model.gravity;
      states[b].wd = -J.ldlt().solve(gyroscopic);
    }
    for (const FormulationEntry& entry : formulations()) {
      SCOPED_TRACE(entry.name);
      Standing at(entry.name, model, states, 0);
      at.solve();
      const std::vector<BodyState> found = at.states();
      for (std::size_t b = 0; b < found.size(); ++b) expect_same(found[b], states[b], 1e-11);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
