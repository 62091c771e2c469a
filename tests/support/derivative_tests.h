// The tests of derivative_suite.h, to be instantiated for a formulation.
#pragma once

#include "tests/support/derivative_suite.h"
#include "tests/support/power_of_loads.h"

namespace poinsot::test {

// How the instances of a suite over formulations are called.
struct FormulationNames {
  template <class F>
  static std::string GetName(int) {
    return std::string(F::name);
  }
};

TYPED_TEST_SUITE_P(Derivatives);

TYPED_TEST_P(Derivatives, OfSingleRows) {
  this->for_each_row([](const Model& model, Random& random) { TestFixture::check_rows(model, random); });
}

TYPED_TEST_P(Derivatives, OfStepsWithASingleRow) {
  this->for_each_row([](const Model& model, Random& random) { TestFixture::check_steps(model, random); });
}

TYPED_TEST_P(Derivatives, OfStepsWithTwoRowsOnOnePair) {
  for (RowType first : kRowTypes) {
    for (RowType second : kRowTypes) {
      for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 0)}) {
        SCOPED_TRACE(kRowNames[static_cast<int>(first)] + std::string("(0,1) and ") +
                     kRowNames[static_cast<int>(second)] + pair_name(i, j));
        Random random(1);
        Model model = random_bodies(random, 2);
        add_row(model, first, 0, 1, random);
        add_row(model, second, i, j, random);
        TestFixture::check_rows(model, random);
        TestFixture::check_steps(model, random);
      }
    }
  }
}

TYPED_TEST_P(Derivatives, OfStepsWithASingleForce) {
  this->for_each_force([](const Model& model, Random& random) { TestFixture::check_steps(model, random); });
}

TYPED_TEST_P(Derivatives, OfMechanismsWithEverything) {
  this->for_each_model([](const Model& model, Random& random) {
    TestFixture::check_rows(model, random);
    TestFixture::check_steps(model, random);
  });
}

// Without dual numbers, one case per kernel: slope 2 of the Taylor remainder.
TYPED_TEST_P(Derivatives, LeaveRemaindersOfSecondOrder) {
  for (RowType type : kRowTypes) {
    SCOPED_TRACE(kRowNames[static_cast<int>(type)]);
    Random random(2);
    Model model = random_bodies(random, 2);
    add_row(model, type, 0, 1, random);
    TestFixture::check_remainders(model, random);
  }
  for (int type = 0; type < kForceTypes; ++type) {
    SCOPED_TRACE(kForceNames[type]);
    Random random(3);
    Model model = random_bodies(random, 2);
    add_force(model, static_cast<ForceType>(type), 0, 1, random);
    TestFixture::check_remainders(model, random);
  }
  this->for_each_model([](const Model& model, Random& random) { TestFixture::check_remainders(model, random); });
}

// While the alternate stands in, Φ, ν and γ are its own.
TYPED_TEST_P(Derivatives, OfAlternateRows) {
  for (double t : {0.1, 1.0, 3.0}) {  // |cos t| > 0.9, < 0.9, > 0.9
    SCOPED_TRACE("t = " + std::to_string(t));
    Random random(4);
    Model model = random_bodies(random, 2);
    add_row(model, RowType::DP1, 0, 1, random);
    Row& row = model.rows.front();
    row.f = Expression::parse("cos(t)");
    row.alternate = std::make_shared<const Constraint::Alternate>(
        Constraint::Alternate{random.unit(), random.unit(), Expression::parse("0.3+sin(t)")});
    const auto problem = make_problem(TypeParam::name, model);
    Point at = TestFixture::random_point(random, *problem);
    at.t = t;
    TestFixture::check_rows_at(model, *problem, at, random);

    const BodyState still;
    const bool swapped = std::abs(std::cos(t)) > 0.9;
    Vector3 a_i = row.a_i, a_j = row.a_j;
    double f = std::cos(t);
    if (swapped) a_i = row.alternate->a_i, a_j = row.alternate->a_j, f = 0.3 + std::sin(t);
    VectorX q(problem->nq()), v(problem->nv()), Phi(problem->nc());
    problem->from_bodies(std::vector(2, still), view(q), view(v));
    problem->set_position(t, view(q));
    problem->position_residual(view(Phi));
    EXPECT_NEAR(Phi[0], a_i.dot(a_j) - f, 1e-14);
  }
}

// Gᵀλ alone: what λ adds to the exact matrix. A symmetric matrix in rp and reps.
TYPED_TEST_P(Derivatives, OfReactions) {
  this->for_each_row([](const Model& model, Random& random) {
    const auto problem = make_problem(TypeParam::name, model);
    const Point at = TestFixture::random_point(random, *problem);
    TestFixture::stand(*problem, at);
    const StepScale scale{0, 1, 1};
    const VectorX none = VectorX::Zero(problem->nv()), no_lambda = VectorX::Zero(problem->nc());
    const MatrixX with = assemble(*problem, MatrixKind::exact, scale, VectorX(), at.a, at.lambda);
    const MatrixX without = assemble(*problem, MatrixKind::exact, scale, VectorX(), at.a, no_lambda);
    const int nv = problem->nv();
    const MatrixX reaction = (with - without).topLeftCorner(nv, nv);
    EXPECT_EQ((with - without).bottomRows(problem->nc()).norm(), 0);
    if (TypeParam::space != CoordinateSpace::lie_group && model.rows[0].type != RowType::pfaffian) {
      EXPECT_LT((reaction - reaction.transpose()).norm(), kRounding * (1 + reaction.norm()));
    }

    typename TestFixture::Duals duals(model);
    const VectorX direction = random.vector(nv);
    duals.stand(at.t, at.q, TestFixture::dual(none, direction), TestFixture::constant(at.v));
    const auto a = TestFixture::constant(at.a);
    const VectorX expected = duals.step_rate(scale, a, TestFixture::constant(at.lambda)).head(nv) -
                             duals.step_rate(scale, a, TestFixture::constant(no_lambda)).head(nv);
    EXPECT_LT(difference(reaction * direction, expected, 1), kRounding);
  });
}

// [M Gᵀ; G 0] is what the equations of motion and the acceleration constraints depend linearly on, without T.
TYPED_TEST_P(Derivatives, OfTheConsistentSystem) {
  this->for_each_model([](const Model& model, Random& random) {
    const auto problem = make_problem(TypeParam::name, model);
    const Point at = TestFixture::random_point(random, *problem);
    TestFixture::stand(*problem, at);
    const int nv = problem->nv(), nc = problem->nc();
    const MatrixX matrix = assemble(*problem, MatrixKind::consistent, {}, VectorX(), at.a, at.lambda);
    VectorX start(nv), end(nv);
    const VectorX none = VectorX::Zero(nv), no_lambda = VectorX::Zero(nc);
    problem->equations_of_motion(view(none), view(no_lambda), view(start));
    problem->equations_of_motion(view(at.a), view(at.lambda), view(end));
    EXPECT_LT(
        difference(matrix.topLeftCorner(nv, nv) * at.a + matrix.topRightCorner(nv, nc) * at.lambda, end - start, 1),
        kRounding);
    EXPECT_LT((matrix - matrix.transpose()).norm(), kRounding * matrix.norm());
    EXPECT_EQ((matrix.bottomLeftCorner(nc, nv) - gradient(*problem)).norm(), 0);
    EXPECT_EQ(matrix.bottomRightCorner(nc, nc).norm(), 0);
    VectorX forces(nv);
    problem->constraint_forces(view(at.lambda), view(forces));
    EXPECT_LT(difference(forces, matrix.topRightCorner(nv, nc) * at.lambda, 1), kRounding);
    VectorX momentum(nv);
    problem->momentum(view(at.a), view(momentum));
    EXPECT_LT(difference(momentum, matrix.topLeftCorner(nv, nv) * at.a, 1), kRounding);
  });
}

// The kernels on long double are the same ones.
TYPED_TEST_P(Derivatives, OnLongDoubleAreTheSame) {
  this->for_each_model([](const Model& model, Random& random) {
    using L = long double;
    using LongVector = Eigen::Matrix<L, Eigen::Dynamic, 1>;
    const auto problem = make_problem(TypeParam::name, model);
    const Point at = TestFixture::random_point(random, *problem);
    TestFixture::stand(*problem, at);
    const StepScale scale{1, 0.5, 0.25};
    const int nv = problem->nv(), nc = problem->nc();
    VectorX plain_residual(nv + nc), plain_gamma(nc);
    problem->step_residual(scale, view(at.a), view(at.lambda), view(plain_residual));
    problem->gamma(view(plain_gamma));

    Mechanism<TypeParam, L> mechanism(
        std::make_shared<const Elements>(std::make_shared<const Model>(model), std::span<const int>()));
    const LongVector q = at.q.cast<L>(), v = at.v.cast<L>(), a = at.a.cast<L>(), lambda = at.lambda.cast<L>();
    mechanism.set_position(at.t, q.data());
    mechanism.set_velocity(v.data());
    LongVector residual(nv + nc), gamma(nc);
    mechanism.residual(a.data(), lambda.data(), residual.data(), &scale, residual.data() + nv);
    mechanism.gamma(gamma.data());
    EXPECT_LT(difference(plain_residual, residual.cast<double>(), 1), kRounding);
    EXPECT_LT(difference(plain_gamma, gamma.cast<double>(), 1), kRounding);
  });
}

// The simplified matrix is the exact one where there are no reactions and, in rp and reps, nothing that moves.
TYPED_TEST_P(Derivatives, SimplifiedMatrixLacksOnlyWhatItSays) {
  this->for_each_model([](const Model& model, Random& random) {
    const auto problem = make_problem(TypeParam::name, model);
    Point at = TestFixture::random_point(random, *problem);
    const VectorX dq = TestFixture::random_step(random, *problem, 1.5);
    const auto compare = [&] {
      TestFixture::stand(*problem, at);
      const StepScale scale{1, 0.3, 0.09};
      return (assemble(*problem, MatrixKind::exact, scale, dq, at.a, at.lambda) -
              assemble(*problem, MatrixKind::simplified, scale, dq, at.a, at.lambda))
          .norm();
    };
    EXPECT_GT(compare(), 0.1);
    at.lambda.setZero();
    if (!TypeParam::simplified_keeps_rate_term) at.v.setZero(), at.a.setZero();
    EXPECT_LT(compare(), 1e-12);
  });
}

// Ȧ = A ω̃̄ and ω̄̇ as to_bodies gives them, along the motion.
TYPED_TEST_P(Derivatives, OfBodyStates) {
  this->for_each_model([](const Model& model, Random& random) {
    const auto problem = make_problem(TypeParam::name, model);
    const Point at = TestFixture::random_point(random, *problem);
    TestFixture::stand(*problem, at);
    std::vector<BodyState> states(model.bodies.size());
    problem->to_bodies(view(at.a), states);
    typename TestFixture::Duals duals(model);
    const VectorX none = VectorX::Zero(problem->nv());
    duals.stand(at.t, at.q, TestFixture::dual(none, at.v), TestFixture::dual(at.v, at.a));
    for (std::size_t b = 0; b < states.size(); ++b) {
      const auto& w = duals.mechanism.c.rate[b].w;
      const Vector3 wd(w[0].d, w[1].d, w[2].d);
      EXPECT_LT(difference(states[b].wd, wd, 1), kRounding);
      if constexpr (!TypeParam::normalized) {  // off the unit sphere A stretches
        const Matrix3 A_dot = duals.mechanism.c.at[b].A.unaryExpr([](const Dual<double>& x) { return x.d; });
        const Matrix3 expected = states[b].A * tilde<double>(states[b].w);
        EXPECT_LT((A_dot - expected).norm(), kRounding * (1 + expected.norm()));
      }
    }
  });
}

// dE/dt = v·(M a − Q) + power of the loads that have no potential: forces and energy agree in sign and size.
TYPED_TEST_P(Derivatives, OfTheEnergyAreThePowerOfTheForces) {
  this->for_each_model([](const Model& model, Random& random) {
    const auto problem = make_problem(TypeParam::name, model);
    const double t = random.uniform(-2, 2);
    std::vector<BodyState> states(model.bodies.size());
    for (BodyState& state : states) state = random.state();
    VectorX q(problem->nq()), v(problem->nv()), out(problem->nv());
    problem->from_bodies(states, view(q), view(v));
    problem->set_position(t, view(q));
    problem->set_velocity(view(v));
    const VectorX a = random.vector(problem->nv()), no_lambda = VectorX::Zero(problem->nc());
    problem->equations_of_motion(view(a), view(no_lambda), view(out));

    double power = power_of_loads(model, states, t);
    typename TestFixture::Duals duals(model);
    duals.stand(Dual<double>(t, 1.0), q, TestFixture::dual(VectorX::Zero(problem->nv()), v), TestFixture::dual(v, a));
    const auto& torsions = duals.mechanism.c.elements->torsions;
    for (const TorsionSpringElement& torsion : torsions) {
      const Dual<double> angle = Torsion<TypeParam, Dual<double>>::angle(duals.mechanism.c, torsion, 0);
      power -= torsion.damping * angle.d * angle.d;
      if (torsion.law) power += power_beside_potential(*torsion.law, {t, angle.v - torsion.angle, angle.d});
    }
    const double expected = v.dot(out) + power;
    EXPECT_NEAR(duals.mechanism.energy().d, expected, 1e-11 * (1 + std::abs(expected)));
    EXPECT_NEAR(duals.mechanism.energy().v, problem->energy(), 1e-12 * (1 + std::abs(problem->energy())));
  });
}

REGISTER_TYPED_TEST_SUITE_P(Derivatives, OfSingleRows, OfStepsWithASingleRow, OfStepsWithTwoRowsOnOnePair,
                            OfStepsWithASingleForce, OfMechanismsWithEverything, LeaveRemaindersOfSecondOrder,
                            OfAlternateRows, OfReactions, OnLongDoubleAreTheSame, OfTheConsistentSystem,
                            SimplifiedMatrixLacksOnlyWhatItSays, OfBodyStates, OfTheEnergyAreThePowerOfTheForces);

}  // namespace poinsot::test
