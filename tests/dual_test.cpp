// Dual numbers: each operation's derivative against the textbook's, also inside Eigen and one inside another.
#include "core/dual.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

namespace poinsot {
namespace {

using D = Dual<double>;

// f on x + ε against its derivative at x.
template <class Function>
void expect_derivative(Function&& f, double x, double expected, const char* what) {
  const D y = f(D(x, 1.0));
  EXPECT_DOUBLE_EQ(y.v, f(D(x)).v) << what << " at " << x;
  EXPECT_EQ(f(D(x)).d, 0) << what << " at " << x;
  EXPECT_NEAR(y.d, expected, 1e-14 * (1 + std::abs(expected))) << what << " at " << x;
}

TEST(Dual, Functions) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-3, 3);
  for (int k = 0; k < 100; ++k) {
    const double x = number(random), y = number(random), s = x * x + 0.1;
    expect_derivative([&](D a) { return a + D(y); }, x, 1, "x + y");
    expect_derivative([&](D a) { return D(y) - a; }, x, -1, "y - x");
    expect_derivative([&](D a) { return a * D(y); }, x, y, "x y");
    expect_derivative([&](D a) { return a * a * a; }, x, 3 * x * x, "x^3");
    expect_derivative([&](D a) { return D(y) / a; }, s, -y / (s * s), "y/x");
    expect_derivative([&](D a) { return a / D(s); }, x, 1 / s, "x/y");
    expect_derivative([](D a) { return -a; }, x, -1, "-x");
    expect_derivative([](D a) { return sqrt(a); }, s, 0.5 / std::sqrt(s), "sqrt");
    expect_derivative([](D a) { return sin(a); }, x, std::cos(x), "sin");
    expect_derivative([](D a) { return cos(a); }, x, -std::sin(x), "cos");
    expect_derivative([](D a) { return abs(a); }, x, x < 0 ? -1 : 1, "abs");
    expect_derivative([&](D a) { return atan2(a, D(y)); }, x, y / (x * x + y * y), "atan2, first");
    expect_derivative([&](D a) { return atan2(D(y), a); }, x, -y / (x * x + y * y), "atan2, second");
    expect_derivative([&](D a) { return a += a * a, a -= D(1), a *= D(2), a /= D(s); }, x, (2 + 4 * x) / s, "+= ...");
  }
}

TEST(Dual, ComparesByValue) {
  EXPECT_TRUE(D(1, 5) < D(2, -5));
  EXPECT_TRUE(D(1, 5) <= D(1, -5));
  EXPECT_TRUE(D(1, 5) == D(1, -5));
  EXPECT_FALSE(D(1, 5) != D(1, -5));
  EXPECT_TRUE(D(2, 0) > D(1, 9));
  EXPECT_TRUE(D(2, 0) >= D(2, 9));
  EXPECT_EQ(plain(D(2, 9)), 2.0);
  EXPECT_EQ(plain(2.0L), 2.0);
}

TEST(Dual, SecondDerivativesByNesting) {
  using DD = Dual<D>;
  const double x = 0.7;
  const DD y = sin(DD(D(x, 1), D(1, 0)) * DD(D(x, 1), D(1, 0)));  // sin x²
  EXPECT_NEAR(y.d.d, 2 * std::cos(x * x) - 4 * x * x * std::sin(x * x), 1e-14);
}

TEST(Dual, InsideEigen) {
  std::srand(1);
  const Eigen::Matrix3d A = Eigen::Matrix3d::Random(), dA = Eigen::Matrix3d::Random();
  const Eigen::Vector3d x = Eigen::Vector3d::Random(), dx = Eigen::Vector3d::Random();
  Eigen::Matrix<D, 3, 3> a;
  Eigen::Matrix<D, 3, 1> b;
  for (int i = 0; i < 3; ++i) {
    b[i] = D(x[i], dx[i]);
    for (int j = 0; j < 3; ++j) a(i, j) = D(A(i, j), dA(i, j));
  }
  const Eigen::Matrix<D, 3, 1> y = a * b;
  const D norm = b.norm();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(y[i].v, (A * x)[i], 1e-15);
    EXPECT_NEAR(y[i].d, (dA * x + A * dx)[i], 1e-15);
  }
  EXPECT_NEAR(norm.d, x.dot(dx) / x.norm(), 1e-15);
}

}  // namespace
}  // namespace poinsot
