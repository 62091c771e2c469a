// Eigen vectors as the spans a Problem takes.
#pragma once

#include <Eigen/Core>
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

}  // namespace poinsot
