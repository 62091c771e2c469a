// What the derivative tests of a formulation share: random points, and the mechanism on dual numbers.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "formulations/mechanism.h"
#include "tests/support/dense_problem.h"
#include "tests/support/random_model.h"

namespace poinsot::test {

struct Point {
  double t;
  VectorX q, v, a, lambda;
};

template <class F>
class DualFixture : public ::testing::Test {
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
      if constexpr (F::space == CoordinateSpace::charts) {
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
};

}  // namespace poinsot::test
