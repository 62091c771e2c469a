// Rotations against long double closed forms and against dual numbers: random, tiny, on both sides of the limit between
// series and closed form, near and at a half turn, and beyond.
#include "core/so3.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/scene.h"
#include "tests/scale.h"

namespace poinsot {
namespace {

using std::numbers::pi;
using Vector4 = Vec4<double>;

class So3 : public ::testing::Test {
 protected:
  std::mt19937_64 random{1};

  Vector3 vector() {
    std::normal_distribution<double> normal;
    return {normal(random), normal(random), normal(random)};
  }
  // θ = 1/2 is where the series end.
  std::vector<Vector3> rotation_vectors() {
    std::vector<Vector3> all{Vector3::Zero()};
    for (double angle : {1e-300, 1e-160, 1e-16, 1e-8, 1e-4, 0.1, 0.5 - 1e-9, 0.5 + 1e-9, 1.0, 2.0, 3.0, pi - 1e-8, pi,
                         pi + 1e-8, 5.0, 6.2}) {
      for (int axis = 0; axis < 3; ++axis) all.push_back(angle * Vector3::Unit(axis));
      for (int k = 0; k < scaled(10); ++k) all.push_back(angle * vector().normalized());
    }
    return all;
  }
};

// Coefficients of exp, T and T⁻¹ in long double; their closed forms lose 5 digits of 19 at 1e-2, below that a few terms
// of the series do.
struct Coefficients {
  long double a = 1, b = 0.5L, c = 1.0L / 6, d = 1.0L / 12;

  explicit Coefficients(long double theta) {
    const long double x = theta * theta;
    if (theta < 1e-2L) {
      a = 1 - x / 6 + x * x / 120 - x * x * x / 5040;
      b = 0.5L - x / 24 + x * x / 720 - x * x * x / 40320;
      c = 1.0L / 6 - x / 120 + x * x / 5040;
      d = 1.0L / 12 + x / 720 + x * x / 30240;
      return;
    }
    a = std::sin(theta) / theta;
    b = (1 - std::cos(theta)) / x;
    c = (theta - std::sin(theta)) / (x * theta);
    d = (1 - theta / 2 * std::cos(theta / 2) / std::sin(theta / 2)) / x;
  }
};

Matrix3 polynomial(const Vector3& theta, long double first, long double second) {
  using V = Vec3<long double>;
  using M = Mat3<long double>;
  const V t = theta.cast<long double>();
  const M s = tilde<long double>(t);
  return (M::Identity() + first * s + second * s * s).cast<double>();
}

TEST_F(So3, TildeIsTheCrossProduct) {
  const Vector3 a = vector(), b = vector();
  // Differences of two products, which may be rounded on their own or fused: either is off by at most ε of their sizes.
  const Vector3 products = tilde<double>(a).cwiseAbs() * b.cwiseAbs();
  const Vector3 difference = tilde<double>(a) * b - a.cross(b);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(std::abs(difference[k]), 2 * std::numeric_limits<double>::epsilon() * products[k]) << k;
  }
}

TEST_F(So3, ExponentialAndJacobiansAreTheClosedForms) {
  for (const Vector3& theta : rotation_vectors()) {
    SCOPED_TRACE("theta = " + std::to_string(theta.norm()));
    const Coefficients k(theta.cast<long double>().norm());
    EXPECT_LT((exp_so3<double>(theta) - polynomial(theta, k.a, k.b)).norm(), 4e-15);
    EXPECT_LT((right_jacobian<double>(theta) - polynomial(theta, -k.b, k.c)).norm(), 4e-15);
    // d grows without bound towards a full turn, and rounding with it.
    EXPECT_LT((right_jacobian_inverse<double>(theta) - polynomial(theta, 0.5L, k.d)).norm(),
              4e-15 * (1 + static_cast<double>(k.d) * theta.squaredNorm()) * (theta.norm() > 6 ? 100 : 1));
  }
}

TEST_F(So3, ExponentialIsARotation) {
  for (const Vector3& theta : rotation_vectors()) {
    const Matrix3 A = exp_so3<double>(theta);
    EXPECT_LT((A * A.transpose() - Matrix3::Identity()).norm(), 4e-15);
    EXPECT_NEAR(A.determinant(), 1, 4e-15);
    EXPECT_LE((A * theta - theta).norm(), 4e-15 * theta.norm());
  }
}

TEST_F(So3, RightJacobianIsTheDerivativeOfTheExponential) {
  using D = Dual<double>;
  for (const Vector3& theta : rotation_vectors()) {
    const Vector3 delta = vector();
    Vec3<D> moved;
    for (int k = 0; k < 3; ++k) moved[k] = D(theta[k], delta[k]);
    const Mat3<D> A = exp_so3<D>(moved);
    const Matrix3 derivative = A.unaryExpr([](const D& x) { return x.d; });
    const Vector3 turned = right_jacobian<double>(theta) * delta;
    const Matrix3 expected = exp_so3<double>(theta) * tilde<double>(turned);
    EXPECT_LT((derivative - expected).norm(), 1e-14 * delta.norm()) << "theta = " << theta.norm();
  }
}

TEST_F(So3, RightJacobianTimesItsInverse) {
  for (const Vector3& theta : rotation_vectors()) {
    const Matrix3 inverse = right_jacobian_inverse<double>(theta);
    EXPECT_LT((right_jacobian<double>(theta) * inverse - Matrix3::Identity()).norm(), 1e-14 * inverse.norm())
        << "theta = " << theta.norm();
    const Vector3 z = vector();
    EXPECT_LT((right_jacobian_inverse_times<double>(theta, z) - inverse * z).norm(), 1e-14 * inverse.norm() * z.norm())
        << "theta = " << theta.norm();
  }
}

// A derivative of the Jacobian itself, across the limit of the series, is continuous.
TEST_F(So3, JacobianIsSmoothAcrossTheSeriesLimit) {
  using D = Dual<double>;
  const Vector3 axis = vector().normalized(), delta = vector();
  const auto derivative = [&](double angle, bool inverse) -> Matrix3 {
    Vec3<D> theta;
    for (int k = 0; k < 3; ++k) theta[k] = D(angle * axis[k], delta[k]);
    const Mat3<D> T = inverse ? right_jacobian_inverse<D>(theta) : right_jacobian<D>(theta);
    return T.unaryExpr([](const D& x) { return x.d; });
  };
  for (bool inverse : {false, true}) {
    EXPECT_LT((derivative(0.5 - 1e-13, inverse) - derivative(0.5 + 1e-13, inverse)).norm(), 1e-12);
  }
}

TEST_F(So3, ParametersAndMatrix) {
  for (const Vector3& theta : rotation_vectors()) {
    SCOPED_TRACE("theta = " + std::to_string(theta.norm()));
    const Matrix3 A = exp_so3<double>(theta);
    const Vector4 p = parameters_from_rotation<double>(A);
    EXPECT_NEAR(p.norm(), 1, 4e-16);
    EXPECT_GE(p[0], 0);
    EXPECT_LT((rotation_from_parameters<double>(p) - A).norm(), 4e-15);
    EXPECT_LT((rotation_from_parameters<double>(1.3 * p) - 1.69 * A).norm(), 1e-14) << "homogeneous";

    // Not the matrix only but the parameters, up to their sign where e0 = 0.
    const double angle = theta.norm();
    Vector4 expected(std::cos(angle / 2), 0, 0, 0);
    if (angle > 0) expected.tail<3>() = std::sin(angle / 2) * theta / angle;
    EXPECT_LT(std::min((p - expected).norm(), (p + expected).norm()), 4e-15);
  }
}

TEST_F(So3, ParametersOfExactHalfTurns) {
  for (int axis = 0; axis < 3; ++axis) {
    Matrix3 A = -Matrix3::Identity();
    A(axis, axis) = 1;
    const Vector4 p = parameters_from_rotation<double>(A);
    EXPECT_EQ(p[0], 0);
    EXPECT_EQ(std::abs(p[1 + axis]), 1);
    EXPECT_EQ(p.squaredNorm(), 1);
  }
  for (int k = 0; k < scaled(100); ++k) {
    const Vector3 u = vector().normalized();
    const Matrix3 A = 2 * u * u.transpose() - Matrix3::Identity();
    const Vector4 p = parameters_from_rotation<double>(A);
    EXPECT_LT((rotation_from_parameters<double>(p) - A).norm(), 4e-15);
  }
}

// ω = 2 E ṗ, ω̄ = 2 G ṗ and Ȧ = ω̃ A = A ω̃̄ for ṗ tangent to the unit sphere.
TEST_F(So3, ParameterRates) {
  using D = Dual<double>;
  for (const Vector3& theta : rotation_vectors()) {
    const Matrix3 A = exp_so3<double>(theta);
    const Vector4 p = parameters_from_rotation<double>(A);
    Vector4 pd;
    pd << vector(), 0.3;
    pd -= p.dot(pd) * p;
    Vec4<D> moved;
    for (int k = 0; k < 4; ++k) moved[k] = D(p[k], pd[k]);
    const Matrix3 A_dot = rotation_from_parameters<D>(moved).unaryExpr([](const D& x) { return x.d; });
    const Vector3 global = 2 * E_matrix<double>(p) * pd, body = 2 * G_matrix<double>(p) * pd;
    EXPECT_LT((A_dot - tilde<double>(global) * A).norm(), 1e-13);
    EXPECT_LT((A_dot - A * tilde<double>(body)).norm(), 1e-13);
    EXPECT_LT((E_matrix<double>(p) * G_matrix<double>(p).transpose() - A).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace poinsot
