// The formulations against one another, and against Newton's and Euler's equations written out.
#include <gtest/gtest.h>

#include "core/so3.h"
#include "tests/scale.h"
#include "tests/support/dense_problem.h"
#include "tests/support/random_model.h"

namespace poinsot::test {
namespace {

std::vector<BodyState> random_states(Random& random, int bodies) {
  std::vector<BodyState> states(static_cast<std::size_t>(bodies));
  for (BodyState& state : states) state = random.state();
  return states;
}

// A problem that stands at the states; its vectors live as long as it.
struct Standing {
  Standing(std::string_view formulation, const Model& model, std::span<const BodyState> states, double t)
      : problem(make_problem(formulation, model)), q(problem->nq()), v(problem->nv()) {
    EXPECT_TRUE(problem->from_bodies(states, view(q), view(v)).ok());
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

void expect_same(const BodyState& x, const BodyState& y, double tolerance) {
  EXPECT_LT((x.r - y.r).norm(), tolerance);
  EXPECT_LT((x.A - y.A).norm(), tolerance);
  EXPECT_LT((x.rd - y.rd).norm(), tolerance * (1 + y.rd.norm()));
  EXPECT_LT((x.w - y.w).norm(), tolerance * (1 + y.w.norm()));
  EXPECT_LT((x.rdd - y.rdd).norm(), tolerance * (1 + y.rdd.norm()));
  EXPECT_LT((x.wd - y.wd).norm(), tolerance * (1 + y.wd.norm()));
}

// What a row asks, written out: Φ, and Ψ v − f of a velocity row.
double asked(const Row& row, std::span<const BodyState> states, double t) {
  const auto state = [&](int body) { return body == kGround ? BodyState() : states[static_cast<std::size_t>(body)]; };
  const BodyState i = state(row.i), j = state(row.j);
  const double value = row.f.at(t).f, f = row.squared ? value * value : value;
  const Vector3 d = j.r + j.A * row.s_j - i.r - i.A * row.s_i;
  const Vector3 d_dot = j.rd + j.A * j.w.cross(row.s_j) - i.rd - i.A * i.w.cross(row.s_i);
  switch (row.type) {
    case RowType::DP1:
      return (i.A * row.a_i).dot(j.A * row.a_j) - f;
    case RowType::DP2:
      return (i.A * row.a_i).dot(d) - f;
    case RowType::D:
      return d.squaredNorm() - f;
    case RowType::CD:
      return row.c.dot(d) - f;
    case RowType::angle:
      return (i.A * (std::cos(f) * row.b_i - std::sin(f) * row.a_i)).dot(j.A * row.a_j);
    case RowType::pfaffian:
      return (j.A * row.a_j).dot(d_dot) - f;
  }
  return 0;
}

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

// The three rows of a point act on a position by the identity: its zeros are not stored, but those of rows along any
// direction are numbers like all others.
TEST(Formulations, APointOnAPointStoresNoZeros) {
  Random random(1);
  Model point = random_bodies(random, 2), rows = random_bodies(random, 2);
  add_coincidence(point, 0, 1, random);
  for (int k = 0; k < 3; ++k) add_row(rows, RowType::CD, 0, 1, random);
  for (const FormulationEntry& entry : formulations()) {
    const auto entries = [&](const Model& model) {
      int sum = 0;
      for (const Block& b : make_problem(entry.name, model)->pattern(MatrixKind::kinematic).blocks) {
        sum += b.rows * b.cols;
      }
      return sum;
    };
    EXPECT_EQ(entries(rows) - entries(point), 2 * (9 - 3)) << entry.name;
  }
}

// One row of each kind between the ground and a free body or two free bodies, and every force. Constraints are
// violated, velocities too: the linear system does not mind.
Model solvable_model(Random& random) {
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
      const bool changed = at.problem->accept(0, view(at.q), view(at.v), view(at.a));
      changes += changed;
      if (changed) at.stand(0);
      const std::vector<BodyState> after = at.states();
      for (std::size_t b = 0; b < after.size(); ++b) expect_same(after[b], before[b], 1e-11);
      EXPECT_FALSE(at.problem->accept(0, view(at.q), view(at.v), view(at.a))) << "a second time";
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
      ASSERT_TRUE(at.problem->from_bodies(std::vector(1, state), view(at.q), view(at.v)).ok());
      at.stand(0);
      EXPECT_NEAR(at.problem->energy(), angle * angle, 1e-12 * (1 + angle * angle));
      VectorX a = VectorX::Zero(at.problem->nv());
      at.problem->accept(0, view(at.q), view(at.v), view(a));
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

// Blocks lie within the matrix, and each body's and row's unknowns belong to one node.
TEST(Formulations, PatternsFitTheMatrix) {
  Random random(6);
  const Model model = random_model(random, 4);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    const auto problem = make_problem(entry.name, model);
    for (MatrixKind kind : {MatrixKind::kinematic, MatrixKind::rates, MatrixKind::consistent, MatrixKind::simplified,
                            MatrixKind::exact}) {
      const Pattern pattern = problem->pattern(kind);
      const bool rows_only = kind == MatrixKind::kinematic || kind == MatrixKind::rates;
      EXPECT_EQ(pattern.node.size(), static_cast<std::size_t>(pattern.n));
      EXPECT_EQ(pattern.n, rows_only ? std::max(problem->nv(), problem->nc()) : problem->nv() + problem->nc());
      for (const Block& block : pattern.blocks) {
        EXPECT_TRUE(block.row >= 0 && block.col >= 0 && block.rows > 0 && block.cols > 0);
        EXPECT_TRUE(block.row + block.rows <= pattern.n && block.col + block.cols <= pattern.n);
      }
    }
  }
}

// Rows left out move the others up; everything else is that of the model without them.
TEST(Formulations, DroppedRowsTakeNoPart) {
  Random random(7);
  const Model model = solvable_model(random);
  const std::vector<BodyState> states = random_states(random, 3);
  const std::vector<int> dropped{1, 4};
  Model without = model;
  without.rows.erase(without.rows.begin() + 4);
  without.rows.erase(without.rows.begin() + 1);
  for (const FormulationEntry& entry : formulations()) {
    SCOPED_TRACE(entry.name);
    Standing some(entry.name, model, states, 0.2), all(entry.name, without, states, 0.2);
    some.problem = entry.make(std::make_shared<const Model>(model), dropped);
    some.stand(0.2);
    EXPECT_EQ(some.problem->model_rows(), (std::vector<int>{0, 2, 3, 5, 6}));
    some.solve(), all.solve();
    EXPECT_EQ((some.a - all.a).norm(), 0);
    EXPECT_EQ((some.lambda - all.lambda).norm(), 0);
    Vector3 force, moment;
    some.problem->reaction(1, view(some.lambda), force, moment);
    EXPECT_EQ(force.norm() + moment.norm(), 0);
  }
}

}  // namespace
}  // namespace poinsot::test
