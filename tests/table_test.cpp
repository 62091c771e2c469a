// Tables: natural cubic splines, held to the properties that define them.
#include "core/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace poinsot {
namespace {

Jet2<double> at(const Spline& table, double x) {
  return table.at(Jet2<double>{x, 1, 0});
}

struct Points {
  std::vector<double> x, y;
};

Points random_points(unsigned seed, std::size_t n) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> step(0.1, 2), value(-1, 1);
  Points p;
  for (std::size_t k = 0; k < n; ++k) {
    p.x.push_back(k == 0 ? -3 : p.x.back() + step(random));
    p.y.push_back(value(random));
  }
  return p;
}

TEST(Table, goes_through_its_points_with_two_continuous_derivatives) {
  for (const std::size_t n : {2u, 3u, 4u, 40u}) {
    const Points p = random_points(7, n);
    const Spline table("f", p.x, p.y);
    for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(at(table, p.x[k]).f, p.y[k], 1e-14) << n << " " << k;
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const Jet2<double> left = at(table, std::nextafter(p.x[k], -9)), right = at(table, p.x[k]);
      EXPECT_NEAR(left.f, right.f, 1e-13);
      EXPECT_NEAR(left.fd, right.fd, 1e-12);
      EXPECT_NEAR(left.fdd, right.fdd, 1e-11);
    }
    EXPECT_NEAR(at(table, p.x.front()).fdd, 0, 1e-11);
    EXPECT_NEAR(at(table, p.x.back()).fdd, 0, 1e-11);
  }
}

TEST(Table, is_the_line_through_points_on_a_line) {
  const Spline table("line", {0, 0.5, 2, 7}, {1, 2, 5, 15});
  for (const double x : {0.0, 0.3, 1.1, 6.9, 7.0}) {
    EXPECT_NEAR(at(table, x).f, 1 + 2 * x, 4e-15 * (1 + 2 * x));
    EXPECT_NEAR(at(table, x).fd, 2, 1e-14);
    EXPECT_NEAR(at(table, x).fdd, 0, 1e-14);
  }
}

// Away from the ends, where the natural condition f'' = 0 costs accuracy, the error falls with the fourth power.
TEST(Table, approximates_to_fourth_order) {
  const auto error = [](int n) {
    std::vector<double> x, y;
    for (int k = 0; k <= n; ++k) x.push_back(10.0 * k / n), y.push_back(std::sin(x.back() + 0.3));
    const Spline table("sin", x, y);
    double largest = 0;
    for (double at_x = 4; at_x < 6; at_x += 0.013)
      largest = std::max(largest, std::abs(at(table, at_x).f - std::sin(at_x + 0.3)));
    return largest;
  };
  const double slope = std::log2(error(100) / error(200));
  EXPECT_GT(slope, 3.8);
  EXPECT_LT(slope, 4.2);
}

TEST(Table, has_derivatives_of_its_argument_by_the_chain_rule) {
  const Points p = random_points(9, 12);
  const Spline table("f", p.x, p.y);
  constexpr long double h = 1e-4L;
  const auto along = [&](long double t) {  // x(t) = t² - 1
    return table.at(Jet2<long double>{t * t - 1, 2 * t, 2}).f;
  };
  for (const long double t : {0.31L, 0.8L, 1.3L}) {
    const Jet2<long double> jet = table.at(Jet2<long double>{t * t - 1, 2 * t, 2});
    EXPECT_NEAR(static_cast<double>(jet.fd), static_cast<double>((along(t + h) - along(t - h)) / (2 * h)), 1e-6);
    EXPECT_NEAR(static_cast<double>(jet.fdd),
                static_cast<double>((along(t + h) - 2 * along(t) + along(t - h)) / (h * h)), 1e-3);
  }
}

TEST(Table, has_no_value_beyond_its_points) {
  const Spline table("f", {0, 1, 2}, {0, 1, 0});
  EXPECT_TRUE(std::isnan(at(table, 2.001).f));
  EXPECT_TRUE(std::isnan(at(table, -1e-9).f));
  EXPECT_TRUE(std::isnan(at(table, std::numeric_limits<double>::quiet_NaN()).f));
  EXPECT_TRUE(std::isnan(at(table, HUGE_VAL).f));
  EXPECT_NEAR(at(table, std::nextafter(2.0, 3.0)).f, 0, 1e-15);  // the rounding of a run's last time
}

}  // namespace
}  // namespace poinsot
