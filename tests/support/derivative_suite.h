// Every derivative of one formulation against dual numbers and Taylor remainders; instantiated in a file per
// formulation, because kernels on dual numbers are slow to compile.
//
// The expected side is always the plain function (Φ, G v − ν, the residual of a step, the energy) evaluated on dual
// numbers along a direction; the tested side is what Problem computes by its formulas.
#pragma once

#include <gtest/gtest.h>

#include "formulations/mechanism.h"
#include "tests/scale.h"
#include "tests/support/dense_problem.h"
#include "tests/support/random_model.h"

namespace poinsot::test {

// Rounding only: sums of a few dozen products of numbers of order one.
inline constexpr double kRounding = 1e-12;

struct Point {
  double t;
  VectorX q, v, a, lambda;
};

template <class F>
class Derivatives : public ::testing::Test {
 protected:
  using D = Dual<double>;
  using DualVector = Eigen::Matrix<D, Eigen::Dynamic, 1>;
  static constexpr int kQ = 3 + F::stored, kV = 3 + F::m;

  static DualVector dual(const VectorX& value, const VectorX& direction) {
    DualVector x(value.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = D(value[k], direction[k]);
    return x;
  }
  static DualVector constant(const VectorX& value) { return dual(value, VectorX::Zero(value.size())); }
  static VectorX derivative(const DualVector& x) {
    return VectorX::NullaryExpr(x.size(), [&](Eigen::Index k) { return x[k].d; });
  }

  struct Duals {
    explicit Duals(const Model& model)
        : mechanism(std::make_shared<const Elements>(std::make_shared<const Model>(model), std::span<const int>())) {}

    // Stands at (t, from ⊞ dq, v); the arrays live here because a mechanism only refers to them.
    void stand(const D& t, const VectorX& from, const DualVector& dq, const DualVector& v_in) {
      const DualVector start = constant(from);
      q.resize(from.size());
      v = v_in;
      mechanism.retract(start.data(), dq.data(), q.data(), mechanism.nb());
      mechanism.set_position(t, q.data());
      mechanism.set_velocity(v.data());
    }
    VectorX position_rate() const {
      DualVector out(mechanism.nc());
      mechanism.constraint_residual(D(1.0), D(0.0), out.data());
      return derivative(out);
    }
    VectorX velocity_rate() {
      DualVector out(mechanism.nc());
      mechanism.velocity_residual(out.data());
      return derivative(out);
    }
    VectorX step_rate(const StepScale& scale, const DualVector& a, const DualVector& lambda) {
      DualVector out(mechanism.nv() + mechanism.nc());
      mechanism.residual(a.data(), lambda.data(), out.data(), &scale, out.data() + mechanism.nv());
      return derivative(out);
    }

    Mechanism<F, D> mechanism;
    DualVector q, v;
  };

  // Coordinates drawn as they are, so that rp leaves the unit sphere and reps sees every chart and its singularities.
  static VectorX random_q(Random& random, int bodies) {
    VectorX q(bodies * kQ);
    for (int b = 0; b < bodies; ++b) {
      double* x = q.data() + b * kQ + 3;
      q.segment<3>(b * kQ) = random.vector();
      F::from_rotation(random.rotation(), x);
      if constexpr (F::normalized) q.segment<F::stored>(b * kQ + 3) *= random.uniform(0.7, 1.4);
      if constexpr (requires { F::rechart; }) {
        if (random.integer(0, 1)) {
          for (int k = 0; k < 3; ++k) x[k] = 2 * random.normal();
          x[3] = random.integer(0, 2);
        }
      }
    }
    return q;
  }
  static Point random_point(Random& random, const Problem& problem) {
    return {random.uniform(-2, 2), random_q(random, problem.bodies()), random.vector(problem.nv()),
            random.vector(problem.nv()), random.vector(problem.nc())};
  }
  static void stand(Problem& problem, const Point& at) {
    problem.set_position(at.t, view(at.q));
    problem.set_velocity(view(at.v));
  }

  // G = ∂Φ/∂q, ν = −∂Φ/∂t, γ from d/dt (G v − ν) = G a − γ.
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
    if constexpr (F::lie_group) {
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
        for (int seed = 0; seed < scaled(10); ++seed) {
          SCOPED_TRACE(kRowNames[static_cast<int>(type)] + pair_name(i, j) + ", seed " + std::to_string(seed));
          Random random(static_cast<unsigned>(seed));
          Model model = random_bodies(random, 2);
          add_row(model, type, i, j, random);
          visit(model, random);
        }
      }
    }
  }
  template <class Visit>
  static void for_each_force(Visit&& visit) {
    for (int k = 0; k < kForceTypes; ++k) {
      const auto type = static_cast<ForceType>(k);
      for (const auto& [i, j] : kPairs) {
        if (j == kGround && !acts_between_two(type)) continue;
        for (int seed = 0; seed < scaled(10); ++seed) {
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
    for (int seed = 0; seed < scaled(20); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(static_cast<unsigned>(seed));
      const Model model = random_model(random, 4);
      visit(model, random);
    }
  }
};

}  // namespace poinsot::test
