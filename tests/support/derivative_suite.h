// Every derivative of one formulation against dual numbers and Taylor remainders.
//
// The expected side is always the plain function (Φ, G v − ν, the residual of a step, the energy) evaluated on dual
// numbers along a direction; the tested side is what Problem computes by its formulas.
#pragma once

#include <gtest/gtest.h>

#include "tests/scale.h"
#include "tests/support/dual_fixture.h"

namespace poinsot::test {

// Rounding only: sums of a few dozen products of numbers of order one.
inline constexpr double kRounding = 1e-12;

template <class F>
class Derivatives : public DualFixture<F> {
 protected:
  using Base = DualFixture<F>;
  using Base::constant, Base::dual, Base::kV, Base::random_point, Base::stand;
  using typename Base::D;
  using typename Base::Duals;

  // G = ∂Φ/∂q, ∂(G v − ν)/∂q, ν = −∂Φ/∂t, γ from d/dt (G v − ν) = G a − γ.
  static void check_rows(const Model& model, Random& random) {
    const auto problem = make_problem(F::name, model);
    Point at = random_point(random, *problem);
    check_rows_at(model, *problem, at, random);
  }
  static void check_rows_at(const Model& model, Problem& problem, const Point& at, Random& random) {
    Duals duals(model);
    stand(problem, at);
    const MatrixX G = gradient(problem);
    const VectorX none = VectorX::Zero(problem.nv());
    const auto holonomic = [&](VectorX x) {  // velocity rows have no Φ
      for (std::size_t k = 0; k < model.rows.size(); ++k) {
        if (model.rows[k].type == RowType::pfaffian) x[static_cast<Eigen::Index>(k)] = 0;
      }
      return x;
    };

    const VectorX direction = random.vector(problem.nv());
    duals.stand(at.t, at.q, dual(none, direction), constant(at.v));
    EXPECT_LT(difference(holonomic(G * direction), duals.position_rate(), 1), kRounding) << "gradient";
    const MatrixX rates = assemble(problem, MatrixKind::rates, {}, VectorX(), VectorX(), VectorX());
    EXPECT_LT(difference(rates.topLeftCorner(problem.nc(), problem.nv()) * direction, duals.velocity_rate(), 1),
              kRounding)
        << "variation of the velocity constraints";
    duals.stand(at.t, at.q, constant(none), dual(at.v, direction));
    EXPECT_LT(difference(G * direction, duals.velocity_rate(), 1), kRounding) << "coefficients of the velocity";

    VectorX velocity(problem.nc()), nu(problem.nc()), gamma(problem.nc());
    problem.velocity_residual(view(velocity));
    problem.nu(view(nu));
    problem.gamma(view(gamma));
    EXPECT_LT(difference(G * at.v - nu, velocity, 1), kRounding) << "velocity residual";
    duals.stand(D(at.t, 1.0), at.q, dual(none, at.v), dual(at.v, at.a));
    EXPECT_LT(difference(holonomic(velocity), duals.position_rate(), 1), kRounding) << "nu";
    EXPECT_LT(difference(G * at.a - gamma, duals.velocity_rate(), 1), kRounding) << "gamma";
  }

  // A step that has led by dq to (q, v): z = δq/position of a variation δa is T(dq) δa.
  static VectorX raised(const VectorX& dq, VectorX z) {
    if constexpr (F::space == CoordinateSpace::lie_group) {
      for (Eigen::Index b = 0; b < z.size() / kV; ++b) {
        const Vector3 theta = dq.segment<3>(b * kV + 3), x = z.segment<3>(b * kV + 3);
        z.segment<3>(b * kV + 3) = right_jacobian<double>(theta) * x;
      }
    }
    return z;
  }
  static VectorX random_step(Random& random, const Problem& problem, double turn) {
    VectorX dq = random.vector(problem.nv());
    for (int b = 0; b < problem.bodies(); ++b) dq.segment(b * kV + 3, F::m).normalize();
    return turn * dq;
  }

  // The exact matrix times (T δa, δλ) is the derivative of the residual of a step.
  static void check_step(const Model& model, Random& random, const StepScale& scale, double turn) {
    const auto problem = make_problem(F::name, model);
    Duals duals(model);
    Point at = random_point(random, *problem);
    const VectorX from = at.q, dq = random_step(random, *problem, turn);
    problem->retract(view(from), view(dq), view(at.q));
    stand(*problem, at);
    const VectorX da = random.vector(problem->nv()), dlambda = random.vector(problem->nc());
    VectorX z(problem->nv() + problem->nc());
    z << raised(dq, da), dlambda;
    const VectorX formula = assemble(*problem, MatrixKind::exact, scale, dq, at.a, at.lambda) * z;

    duals.stand(at.t, from, dual(dq, scale.position * da), dual(at.v, scale.velocity * da));
    const VectorX expected = duals.step_rate(scale, dual(at.a, scale.acceleration * da), dual(at.lambda, dlambda));
    EXPECT_LT(difference(formula.head(problem->nv()), expected.head(problem->nv()), 1), kRounding)
        << "equations of motion, turn " << turn;
    EXPECT_LT(difference(formula.tail(problem->nc()), expected.tail(problem->nc()), 1), kRounding)
        << "constraints, turn " << turn;

    VectorX lowered = raised(dq, da);
    problem->lower(view(dq), view(lowered));
    EXPECT_LT(difference(lowered, da, 1), 1e-11) << "lower, turn " << turn;
  }
  // Implicit Euler at several steps, and scales as another method would have them. turn: |h ω̄|.
  static void check_steps(const Model& model, Random& random) {
    for (double h : {1.0, 0.1, 1e-3}) check_step(model, random, {1, h, h * h}, random.uniform(0.5, 3));
    check_step(model, random, {0.7, 0.3, 0.2}, 1e-9);
    check_step(model, random, {0, 1, 1}, 2);
  }

  // |f(ε) − f(0) − ε f'| over three decades of ε: the slope of its logarithm fitted by least squares.
  template <class Function>
  static double remainder_slope(Function&& f, const VectorX& slope_at_zero) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    int n = 0;
    const VectorX start = f(0.0);
    for (double epsilon = 1.0 / 64; epsilon > 1e-5; epsilon /= 2, ++n) {
      const double x = std::log(epsilon), y = std::log((f(epsilon) - start - epsilon * slope_at_zero).norm());
      sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
  }

  // First derivatives without dual numbers: velocities along the motion, and the residual of a step.
  static void check_remainders(const Model& model, Random& random) {
    const auto problem = make_problem(F::name, model);
    const Point at = random_point(random, *problem);
    stand(*problem, at);
    const MatrixX G = gradient(*problem);
    VectorX gamma(problem->nc());
    problem->gamma(view(gamma));
    const auto stand_along = [&](Point& there, double epsilon, const VectorX& dq, const VectorX& dv) {
      problem->retract(view(at.q), view(VectorX(epsilon * dq)), view(there.q));
      there.v = at.v + epsilon * dv;
      stand(*problem, there);
    };
    if (problem->nc() > (F::normalized ? problem->bodies() : 0)) {
      EXPECT_GT(remainder_slope(
                    [&](double epsilon) {
                      Point there = at;
                      there.t += epsilon;
                      stand_along(there, epsilon, at.v, at.a);
                      VectorX out(problem->nc());
                      problem->velocity_residual(view(out));
                      return out;
                    },
                    G * at.a - gamma),
                1.9)
          << "G v − nu along the motion";
    }

    const StepScale scale{1, 0.5, 0.25};
    const VectorX da = random.vector(problem->nv()), dlambda = random.vector(problem->nc());
    VectorX z(problem->nv() + problem->nc());
    z << da, dlambda;
    stand(*problem, at);
    const MatrixX matrix = assemble(*problem, MatrixKind::exact, scale, VectorX(), at.a, at.lambda);
    EXPECT_GT(remainder_slope(
                  [&](double epsilon) {
                    Point there = at;
                    stand_along(there, epsilon, scale.position * da, scale.velocity * da);
                    there.a += epsilon * scale.acceleration * da;
                    there.lambda += epsilon * dlambda;
                    VectorX out(problem->nv() + problem->nc());
                    problem->step_residual(scale, view(there.a), view(there.lambda), view(out));
                    return out;
                  },
                  matrix * z),
              1.9)
        << "residual of a step";
  }

  // A model of two bodies with one row or one force, everything else random: visit(model, random).
  template <class Visit>
  static void for_each_row(Visit&& visit) {
    for (RowType type : kRowTypes) {
      for (const auto& [i, j] : kPairs) {
        for (int seed = 0; seed < scaled(40); ++seed) {
          SCOPED_TRACE(kRowNames[static_cast<int>(type)] + pair_name(i, j) + ", seed " + std::to_string(seed));
          Random random(static_cast<unsigned>(seed));
          Model model = random_bodies(random, 2);
          add_row(model, type, i, j, random);
          visit(model, random);
        }
      }
    }
    for (const auto& [i, j] : kPairs) {
      for (int seed = 0; seed < scaled(40); ++seed) {
        SCOPED_TRACE("coincidence" + pair_name(i, j) + ", seed " + std::to_string(seed));
        Random random(static_cast<unsigned>(seed));
        Model model = random_bodies(random, 2);
        add_coincidence(model, i, j, random);
        visit(model, random);
      }
    }
  }
  template <class Visit>
  static void for_each_force(Visit&& visit) {
    for (int k = 0; k < kForceTypes; ++k) {
      const auto type = static_cast<ForceType>(k);
      for (const auto& [i, j] : kPairs) {
        if (j == kGround && !acts_between_two(type)) continue;
        for (int seed = 0; seed < scaled(40); ++seed) {
          SCOPED_TRACE(kForceNames[k] + pair_name(i, j) + ", seed " + std::to_string(seed));
          Random random(static_cast<unsigned>(seed));
          Model model = random_bodies(random, 2);
          add_force(model, type, i, j, random);
          visit(model, random);
        }
      }
    }
  }
  template <class Visit>
  static void for_each_model(Visit&& visit) {
    for (int seed = 0; seed < scaled(40); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(static_cast<unsigned>(seed));
      const Model model = random_model(random, 4);
      visit(model, random);
    }
  }
};

}  // namespace poinsot::test
