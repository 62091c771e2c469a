// Eigen vectors as the spans a Problem takes, and the norm of those.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>

namespace poinsot {

inline std::span<double> span(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
inline std::span<const double> span(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
inline std::span<double> span(Eigen::VectorXd& x, Eigen::Index first, Eigen::Index count) {
  return {x.data() + first, static_cast<std::size_t>(count)};
}

// The maximum norm; infinite where a component is not finite.
inline double largest(std::span<const double> x) {
  double m = 0;
  for (double e : x) m = std::isfinite(e) ? std::max(m, std::abs(e)) : HUGE_VAL;
  return m;
}

}  // namespace poinsot
